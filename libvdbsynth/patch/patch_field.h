#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_exemplar.h"

#include <array>
#include <cstddef>
#include <vector>

namespace vdbsynth {

class PointSetSurface;

inline constexpr int kFieldValues = 4;   ///< of a node: distance, then the gradient's x, y, z
inline constexpr float kFieldReach = 3;  ///< [steps] distances are clamped to +-this

/// Nodes in the middle of cubes of side `step`, z fastest: those of a column lie together, which is what a
/// search over shifts along the plane compares.
struct PatchLattice {
    double step = 1;  ///< [world]
    int nx = 0, ny = 0, nz = 0;

    std::size_t columns() const { return std::size_t(nx) * std::size_t(ny); }
    std::size_t nodes() const { return columns() * std::size_t(nz); }
    std::size_t column(int i, int j) const { return std::size_t(i) * std::size_t(ny) + std::size_t(j); }
    Vec3d place(int i, int j, int k) const { return {(i + 0.5) * step, (j + 0.5) * step, (k + 0.5) * step}; }
};

/// The lattice of a box, at least one node along every axis; the last may reach beyond it by less than half a
/// step. @throw Error InvalidOption (a step that is not above 0), Memory (over 2^31 nodes)
PatchLattice latticeOf(const Vec3d& size, double step);

/// D(T) [duranleau2006, 5.1]: at every node the signed distance to a point-set surface, in steps, clamped to
/// +-kFieldReach, and its gradient, the direction from the surface to the node outside and the reverse
/// inside. Nodes farther from all points than `reach` have that limit and the gradient 0: inside below
/// a measured node that is, down to the next measured one if that is inside too, or to the bottom, else
/// outside.
struct PatchField {
    PatchLattice lattice;
    std::vector<float> values;  ///< [columns x nz x 4]

    std::size_t columnLength() const { return std::size_t(lattice.nz) * kFieldValues; }
    const float* column(int i, int j) const { return values.data() + lattice.column(i, j) * columnLength(); }
    float distance(int i, int j, int k) const { return column(i, j)[k * kFieldValues]; }
};

/// @param points  that the surface is of
/// @param origin  plane space, the lattice's minimum corner
/// @param reach   [steps] above 0, at most kFieldReach
/// @throw Error Cancelled
/// @par Cost    one projection per node near a point
/// @par Repeats same bits for any number of threads
PatchField patchField(const PointSetSurface& surface, const std::vector<Vec3f>& points,
                      const PatchLattice& lattice, const Vec3d& origin, float reach = kFieldReach,
                      const RunContext& ctx = {});

}  // namespace vdbsynth
