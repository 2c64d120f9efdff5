#include "libvdbsynth/measure/functionals.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace vdbsynth {
namespace {

// Eighths of Euler characteristic contributed by a corner of the lattice, indexed by which of the eight
// voxels around it are solid. Voxel v is at (v >> 2 & 1, v >> 1 & 1, v & 1).
std::array<int, 256> eulerTable() {
    std::array<int, 256> table{};
    for (int solid = 1; solid < 256; ++solid) {
        int eighths = 8;  // the corner itself
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                bool edge = false;  // the edge along `axis` on that side touches four voxels
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
        // A word of one phase after the same phase adds nothing: the table is 0 for all and for none.
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

// The sides of all faces by their lower vertex.
struct Sides {
    std::vector<std::uint32_t> first;  // [vertices + 1]
    std::vector<Side> all;
};

Sides sidesByEdge(const std::vector<Triangle>& faces, std::size_t vertices) {
    Sides sides;
    sides.first.assign(vertices + 1, 0);
    const auto visit = [&](const auto& use) {
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t from = faces[f][k], to = faces[f][(k + 1) % 3];
                use(Side{std::min(from, to), std::max(from, to), std::uint32_t(f)});
            }
    };
    visit([&](const Side& side) { ++sides.first[side.low + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) sides.first[v + 1] += sides.first[v];
    sides.all.resize(faces.size() * 3);
    std::vector<std::uint32_t> next(sides.first.begin(), sides.first.end() - 1);
    visit([&](const Side& side) { sides.all[next[side.low]++] = side; });
    return sides;
}

// The angle between the normals of faces a and b at their edge, positive if convex.
double normalAngle(const Mesh& mesh, const std::vector<Triangle>& faces, const Side& a, const Side& b) {
    const auto normal = [&](const Triangle& t) {
        return cross(corner(mesh, t[1]) - corner(mesh, t[0]), corner(mesh, t[2]) - corner(mesh, t[0]));
    };
    const Vec3d na = normal(faces[a.face]), nb = normal(faces[b.face]);
    if (dot(na, na) == 0 || dot(nb, nb) == 0) return 0;
    const double angle = arcTangent(length(cross(na, nb)), dot(na, nb));
    // Convex if the far corner of b is behind a.
    const Triangle& t = faces[b.face];
    std::uint32_t far = t[0];
    for (std::uint32_t v : t)
        if (v != a.low && v != a.high) far = v;
    return dot(na, corner(mesh, far) - corner(mesh, a.low)) <= 0 ? angle : -angle;
}

using Element = SurfaceElements::Element;
using ByCell = SurfaceElements::ByCell;

// Contribution of the edges from one vertex; edges with other than two faces give none.
void addCurvatures(const Mesh& mesh, const std::vector<Triangle>& faces, Side* begin, Side* end,
                   std::vector<Element>& elements) {
    std::sort(begin, end, [](const Side& a, const Side& b) {
        return std::tie(a.high, a.face) < std::tie(b.high, b.face);
    });
    for (const Side* side = begin; side < end;) {
        const Side* next = side;
        while (next < end && next->high == side->high) ++next;
        if (next - side == 2) {
            const Vec3d a = corner(mesh, side->low), b = corner(mesh, side->high);
            const float share = float(length(b - a) * normalAngle(mesh, faces, side[0], side[1]) / 2);
            if (share != 0) elements.push_back({cast<float>((a + b) * 0.5), share});
        }
        side = next;
    }
}

// The cell of the voxel whose half-voxel surroundings contain p, as in holds().
Index3 cellOf(const Vec3f& p) {
    Index3 cell;
    for (int axis = 0; axis < 3; ++axis) cell[axis] = int(std::floor((double(p[axis]) + 0.5) / kElementCell));
    return cell;
}

std::size_t cellNumber(const IndexBox& cells, const Index3& cell) {
    return latticeIndex(cell - cells.min, cells.size());
}

// Elements in the order found, one list for each fixed share of the work.
using Lists = std::vector<std::vector<Element>>;
constexpr std::size_t kShare = 8192;  // faces or vertices

std::size_t shares(std::size_t count) {
    return (count + kShare - 1) / kShare;
}

IndexBox cellsOf(const Lists& lists) {
    IndexBox cells;
    for (const std::vector<Element>& list : lists)
        for (const Element& e : list) {
            const Index3 cell = cellOf(e.middle);
            if (cells.empty()) cells = {cell, cell};
            for (int axis = 0; axis < 3; ++axis) {
                cells.min[axis] = std::min(cells.min[axis], cell[axis]);
                cells.max[axis] = std::max(cells.max[axis], cell[axis]);
            }
        }
    return cells;
}

// Within a cell elements keep the order of the lists.
ByCell byCell(const Lists& lists) {
    ByCell result;
    result.cells = cellsOf(lists);
    if (result.cells.empty()) return result;
    result.first.assign(std::size_t(result.cells.volume()) + 1, 0);
    for (const std::vector<Element>& list : lists)
        for (const Element& e : list) ++result.first[cellNumber(result.cells, cellOf(e.middle)) + 1];
    for (std::size_t c = 1; c < result.first.size(); ++c) result.first[c] += result.first[c - 1];
    result.elements.resize(result.first.back());
    std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
    for (const std::vector<Element>& list : lists)
        for (const Element& e : list) result.elements[next[cellNumber(result.cells, cellOf(e.middle))]++] = e;
    return result;
}

double sumWithin(const ByCell& sorted, const IndexBox& box) {
    if (box.empty() || sorted.cells.empty()) return 0;
    const auto corner = [](const Index3& p) { return cellOf({float(p.x), float(p.y), float(p.z)}); };
    const IndexBox cells = IndexBox{corner(box.min), corner(box.max)}.intersection(sorted.cells);
    double sum = 0;
    for (int x = cells.min.x; x <= cells.max.x; ++x)
        for (int y = cells.min.y; y <= cells.max.y; ++y) {
            if (cells.min.z > cells.max.z) continue;
            const std::size_t begin = sorted.first[cellNumber(sorted.cells, {x, y, cells.min.z})],
                              end = sorted.first[cellNumber(sorted.cells, {x, y, cells.max.z}) + 1];
            for (std::size_t i = begin; i < end; ++i)
                if (holds(box, cast<double>(sorted.elements[i].middle)))
                    sum += double(sorted.elements[i].value);
        }
    return sum;
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
    const std::vector<Triangle> faces = triangulated(mesh);
    const std::size_t vertices = mesh.points.size();
    Lists areas(shares(faces.size())), curvatures(shares(vertices));
    parallelFor(ctx, areas.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t share = begin; share < end; ++share)
            for (std::size_t f = share * kShare; f < std::min(faces.size(), (share + 1) * kShare); ++f) {
                const Triangle& t = faces[f];
                const Vec3d a = corner(mesh, t[0]), b = corner(mesh, t[1]), c = corner(mesh, t[2]);
                const float area = float(length(cross(b - a, c - a)) / 2);
                if (area > 0) areas[share].push_back({cast<float>((a + b + c) * (1.0 / 3)), area});
            }
    });
    Sides sides = sidesByEdge(faces, vertices);
    parallelFor(ctx, curvatures.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t share = begin; share < end; ++share)
            for (std::size_t v = share * kShare; v < std::min(vertices, (share + 1) * kShare); ++v)
                addCurvatures(mesh, faces, sides.all.data() + sides.first[v],
                              sides.all.data() + sides.first[v + 1], curvatures[share]);
    });
    SurfaceElements elements;
    const Lists* const lists[2] = {&areas, &curvatures};
    ByCell* const sorted[2] = {&elements.areas, &elements.curvatures};
    parallelFor(ctx, 2, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) *sorted[i] = byCell(*lists[i]);
    });
    return elements;
}

SurfaceFunctionals surfaceFunctionals(const SurfaceElements& elements, const IndexBox& box) {
    return {sumWithin(elements.areas, box), sumWithin(elements.curvatures, box)};
}

}  // namespace vdbsynth
