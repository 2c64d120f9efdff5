#include "libvdbsynth/measure/functionals.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace vdbsynth {
namespace {

// Eighths of Euler characteristic that a corner of the lattice brings in, by which of the eight voxels
// around it are solid. Voxel v lies at (v >> 2 & 1, v >> 1 & 1, v & 1).
std::array<int, 256> eulerTable() {
    std::array<int, 256> table{};
    for (int solid = 1; solid < 256; ++solid) {
        int eighths = 8;  // the corner itself
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                bool edge = false;  // the edge along `axis` to that side touches four voxels
                for (int v = 0; v < 8; ++v) edge = edge || ((v >> axis & 1) == side && (solid >> v & 1));
                eighths -= edge ? 4 : 0;
            }
        for (int normal = 0; normal < 3; ++normal)
            for (int quadrant = 0; quadrant < 4; ++quadrant) {
                const int low = normal == 0 ? 1 : 0, high = normal == 2 ? 1 : 2;
                bool face = false;
                for (int v = 0; v < 8; ++v)
                    face = face || ((v >> low & 1) == (quadrant & 1) && (v >> high & 1) == (quadrant >> 1) &&
                                    (solid >> v & 1));
                eighths += face ? 2 : 0;
            }
        for (int v = 0; v < 8; ++v) eighths -= solid >> v & 1;
        table[std::size_t(solid)] = eighths;
    }
    return table;
}

bool uniform(const std::uint64_t* const rows[4], std::size_t word, std::uint64_t value) {
    for (int r = 0; r < 4; ++r)
        if (rows[r][word] != value) return false;
    return true;
}

// Sum over the corners between voxel z - 1 and z of four neighbouring rows, for z in [first, last].
std::int64_t sumRow(const std::array<int, 256>& table, const std::uint64_t* const rows[4], int sizeZ,
                    int first, int last) {
    const auto solidAt = [&](int z) {
        int bits = 0;
        if (z < 0 || z >= sizeZ) return bits;
        for (int r = 0; r < 4; ++r) bits |= int(rows[r][z >> 6] >> (z & 63) & 1) << (2 * r);
        return bits;
    };
    std::int64_t sum = 0;
    int before = solidAt(first - 1);
    for (int z = first; z <= last; ++z) {
        // A whole word of one kind after the same kind adds nothing: the table is 0 for all and for none.
        if ((z & 63) == 0 && z + 64 <= std::min(sizeZ, last + 1)) {
            const std::size_t word = std::size_t(z) >> 6;
            if ((before == 0 && uniform(rows, word, 0)) || (before == 85 && uniform(rows, word, ~0ull))) {
                z += 63;
                continue;
            }
        }
        const int here = solidAt(z);
        sum += table[std::size_t(before | here << 1)];
        before = here;
    }
    return sum;
}

Vec3d corner(const Mesh& mesh, std::uint32_t vertex) {
    return cast<double>(mesh.points[vertex]);
}

std::array<double, 3> bounds(const IndexBox& box, bool high) {
    const Index3& c = high ? box.max : box.min;
    const double half = high ? 0.5 : -0.5;
    return {c.x + half, c.y + half, c.z + half};
}

bool holds(const IndexBox& box, const Vec3d& p) {
    const std::array<double, 3> low = bounds(box, false), high = bounds(box, true);
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < low[std::size_t(axis)] || p[axis] >= high[std::size_t(axis)]) return false;
    return true;
}

struct Side {
    std::uint32_t low, high, face;
};

// The sides of all faces, those of one edge side by side.
std::vector<Side> sidesByEdge(const std::vector<Triangle>& faces, std::size_t vertices,
                              const RunContext& ctx) {
    std::vector<std::uint32_t> first(vertices + 1, 0);
    const auto visit = [&](const auto& use) {
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t from = faces[f][k], to = faces[f][(k + 1) % 3];
                use(Side{std::min(from, to), std::max(from, to), std::uint32_t(f)});
            }
    };
    visit([&](const Side& side) { ++first[side.low + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    std::vector<Side> sides(faces.size() * 3);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    visit([&](const Side& side) { sides[next[side.low]++] = side; });
    parallelFor(ctx, vertices, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            std::sort(sides.begin() + first[v], sides.begin() + first[v + 1],
                      [](const Side& a, const Side& b) {
                          return std::tie(a.high, a.face) < std::tie(b.high, b.face);
                      });
    });
    return sides;
}

// The angle by which the normal turns from face a to face b at their edge, positive where convex.
double turn(const Mesh& mesh, const std::vector<Triangle>& faces, const Side& a, const Side& b) {
    const auto normal = [&](const Triangle& t) {
        return cross(corner(mesh, t[1]) - corner(mesh, t[0]), corner(mesh, t[2]) - corner(mesh, t[0]));
    };
    const Vec3d na = normal(faces[a.face]), nb = normal(faces[b.face]);
    if (dot(na, na) == 0 || dot(nb, nb) == 0) return 0;
    const double angle = arcTangent(length(cross(na, nb)), dot(na, nb));
    // Convex where the far corner of b lies behind a.
    const Triangle& t = faces[b.face];
    std::uint32_t far = t[0];
    for (std::uint32_t v : t)
        if (v != a.low && v != a.high) far = v;
    return dot(na, corner(mesh, far) - corner(mesh, a.low)) <= 0 ? angle : -angle;
}

}  // namespace

double eulerVolume(const Index3& size, Beyond beyond) {
    const double by = beyond == Beyond::Void ? 1 : -1;
    return (size.x + by) * (size.y + by) * (size.z + by);
}

double eulerCharacteristic(const Occupancy& solid, Beyond beyond) {
    static const std::array<int, 256> table = eulerTable();
    const Index3& size = solid.size();
    const int first = beyond == Beyond::Void ? 0 : 1, more = beyond == Beyond::Void ? 1 : 0;
    const std::vector<std::uint64_t> nothing(solid.rowWords(), 0);
    const auto rowAt = [&](int x, int y) {
        return x < 0 || y < 0 || x >= size.x || y >= size.y ? nothing.data() : solid.row(x, y);
    };
    std::int64_t eighths = 0;
    for (int x = first; x < size.x + more; ++x)
        for (int y = first; y < size.y + more; ++y) {
            const std::uint64_t* rows[4] = {rowAt(x - 1, y - 1), rowAt(x - 1, y), rowAt(x, y - 1),
                                            rowAt(x, y)};
            eighths += sumRow(table, rows, size.z, first, size.z - 1 + more);
        }
    return double(eighths) / 8;
}

SurfaceElements surfaceElements(const Mesh& mesh, const RunContext& ctx) {
    SurfaceElements elements;
    const std::vector<Triangle> faces = triangulated(mesh);
    elements.areas.resize(faces.size());
    parallelFor(ctx, faces.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const Triangle& t = faces[f];
            const Vec3d a = corner(mesh, t[0]), b = corner(mesh, t[1]), c = corner(mesh, t[2]);
            elements.areas[f] = {cast<float>((a + b + c) * (1.0 / 3)),
                                 float(length(cross(b - a, c - a)) / 2)};
        }
    });
    const std::vector<Side> sides = sidesByEdge(faces, mesh.points.size(), ctx);
    // A pair of sides stands where its first one does; the rest stays empty and goes.
    std::vector<SurfaceElements::Element> all(sides.size(), {{}, 0});
    parallelFor(ctx, sides.size(), 4096, [&](std::size_t begin, std::size_t end) {
        const auto together = [&](std::size_t i, std::size_t k) {
            return k < sides.size() && sides[i].low == sides[k].low && sides[i].high == sides[k].high;
        };
        for (std::size_t i = begin; i < end; ++i) {
            if ((i > 0 && together(i, i - 1)) || !together(i, i + 1) || together(i, i + 2)) continue;
            const Vec3d a = corner(mesh, sides[i].low), b = corner(mesh, sides[i].high);
            const double share = length(b - a) * turn(mesh, faces, sides[i], sides[i + 1]) / 2;
            all[i] = {cast<float>((a + b) * 0.5), float(share)};
        }
    });
    elements.curvatures.reserve(sides.size() / 2);
    for (const SurfaceElements::Element& element : all)
        if (element.value != 0) elements.curvatures.push_back(element);
    return elements;
}

SurfaceFunctionals surfaceFunctionals(const SurfaceElements& elements, const IndexBox& box) {
    SurfaceFunctionals result;
    for (const SurfaceElements::Element& e : elements.areas)
        if (holds(box, cast<double>(e.middle))) result.area += double(e.value);
    for (const SurfaceElements::Element& e : elements.curvatures)
        if (holds(box, cast<double>(e.middle))) result.meanCurvature += double(e.value);
    return result;
}

}  // namespace vdbsynth
