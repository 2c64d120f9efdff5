#include "libvdbsynth/patch/patch_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace vdbsynth {
namespace {

constexpr float kUnder = 0.5f;  // of a gradient's height
constexpr double kMostNodes = 2147483648.0;

// The nodes that no point is near are inside only under a node that is, down to another one or to the bottom:
// a solid has a top. So a tube that ends open is not drawn out upward.
void fillColumn(float* column, int nz, const std::vector<bool>& known) {
    const auto inside = [&](int k) { return column[k * kFieldValues] < 0; };
    // Of a node under a top: the surface is above it. Feet beyond a surface's open edge are beside it.
    const auto under = [&](int k) { return inside(k) && column[k * kFieldValues + 3] > kUnder; };
    int above = nz;  // the nearest known node upward, nz: none
    for (int k = nz - 1; k >= 0; --k) {
        if (known[std::size_t(k)]) {
            above = k;
            continue;
        }
        int below = k - 1;
        while (below >= 0 && !known[std::size_t(below)]) --below;
        const bool solid = above < nz && (below < 0 ? under(above) : inside(above) && inside(below));
        for (; k > below; --k) column[k * kFieldValues] = solid ? -kFieldReach : kFieldReach;
        ++k;
    }
}

// Nodes within reach of a point, and half a step: those worth a projection. Cubes of nodes about the points'
// own, so a few are farther.
std::vector<std::uint8_t> nearNodes(const std::vector<Vec3f>& points, const PatchLattice& l,
                                    const Vec3d& origin, float reach) {
    std::vector<std::uint8_t> near(l.nodes(), 0);
    const int rings = int(std::ceil(double(reach)));
    const auto low = [&](double x) { return std::max(0, int(std::floor(x / l.step)) - rings); };
    const auto high = [&](double x, int count) {
        return std::min(count - 1, int(std::floor(x / l.step)) + rings);
    };
    // Marked once for each node that holds points.
    std::vector<std::uint8_t> done(l.nodes(), 0);
    for (const Vec3f& point : points) {
        const Vec3d at = cast<double>(point) - origin;
        const int i0 = low(at.x), i1 = high(at.x, l.nx), j0 = low(at.y), j1 = high(at.y, l.ny),
                  k0 = low(at.z), k1 = high(at.z, l.nz);
        if (i0 > i1 || j0 > j1 || k0 > k1) continue;
        const int i = int(std::floor(at.x / l.step)), j = int(std::floor(at.y / l.step)),
                  k = int(std::floor(at.z / l.step));
        if (i >= 0 && j >= 0 && k >= 0 && i < l.nx && j < l.ny && k < l.nz) {
            std::uint8_t& own = done[l.column(i, j) * std::size_t(l.nz) + std::size_t(k)];
            if (own) continue;
            own = 1;
        }
        for (int x = i0; x <= i1; ++x)
            for (int y = j0; y <= j1; ++y) {
                std::uint8_t* column = near.data() + l.column(x, y) * std::size_t(l.nz);
                std::fill(column + k0, column + k1 + 1, std::uint8_t(1));
            }
    }
    return near;
}

void measureColumn(const PointSetSurface& surface, const Vec3d& lowest, double step, int nz, float reach,
                   const std::uint8_t* near, float* column) {
    std::vector<bool> known(std::size_t(nz), false);
    for (int k = 0; k < nz; ++k) {
        if (!near[k]) continue;
        const Vec3d place = lowest + Vec3d{0, 0, k * step};
        const auto foot = surface.project(place);
        if (!foot) continue;
        const Vec3d away = place - foot->point;
        const double distance = length(away) / step;
        if (distance > 2.0 * double(reach)) continue;
        const bool inside = dot(away, foot->normal) < 0;
        const Vec3d gradient = distance > 1e-6 ? away * ((inside ? -1 : 1) / length(away)) : foot->normal;
        const float values[kFieldValues] = {std::min(float(distance), kFieldReach) * (inside ? -1.f : 1.f),
                                            float(gradient.x), float(gradient.y), float(gradient.z)};
        std::copy(values, values + kFieldValues, column + k * kFieldValues);
        known[std::size_t(k)] = true;
    }
    fillColumn(column, nz, known);
}

}  // namespace

PatchLattice latticeOf(const Vec3d& size, double step) {
    if (!(step > 0)) throw Error(ErrorCode::InvalidOption, "the field's step must be above 0");
    double nodes = 1;
    int sides[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double side = std::max(1.0, std::ceil(size[axis] / step - 1e-6));
        nodes *= side;
        if (!(nodes < kMostNodes))
            throw Error(ErrorCode::Memory,
                        "a field over the sheet has over 2^31 places; a larger step or a "
                        "smaller sheet has fewer");
        sides[axis] = int(side);
    }
    return {step, sides[0], sides[1], sides[2]};
}

PatchField patchField(const PointSetSurface& surface, const std::vector<Vec3f>& points,
                      const PatchLattice& lattice, const Vec3d& origin, float reach, const RunContext& ctx) {
    PatchField field{lattice, std::vector<float>(lattice.nodes() * kFieldValues, 0.f)};
    const std::vector<std::uint8_t> near = nearNodes(points, lattice, origin, reach);
    Stage stage(ctx, "distances of the exemplar", std::size_t(lattice.nx));
    for (int i = 0; i < lattice.nx; ++i) {
        parallelFor(ctx, std::size_t(lattice.ny), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j) {
                const std::size_t column = lattice.column(i, int(j));
                measureColumn(surface, origin + lattice.place(i, int(j), 0), lattice.step, lattice.nz, reach,
                              near.data() + column * std::size_t(lattice.nz),
                              field.values.data() + column * field.columnLength());
            }
        });
        stage.advance();
    }
    return field;
}

}  // namespace vdbsynth
