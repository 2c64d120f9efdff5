#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/map/element_sources.h"
#include "libvdbsynth/math/vec3.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// A field over an exemplar and the position of its samples: sample p is at corner + p / samplesPerVoxel of
/// the exemplar's index space in the map's coordinates.
struct ExemplarSamples {
    std::shared_ptr<const BrickField> field;  ///< its box begins at 0; values in voxels of the result
    Vec3d corner;
    double samplesPerVoxel = 1;  ///< the texture's scale, times the factor of a finer exemplar
};

/// Distances read through the sources of voxels. A position v in a voxel of the map with a source takes the
/// mean of the proposals of the sources of the voxels j around it,
///     value(v) = sum_j w(v - j) E_j(x_j + R_j^T (v - j) / s_j) / sum_j w(v - j)
///     w(o) = t(o_x) t(o_y) t(o_z) / (1 + |o|^2)^2,   t(a) = min(1, max(0, 2 - |a|))
/// with x, R and s the position, rotation and scale of a source (volume_analogy.h). E is read by a cubic
/// polynomial (sampleCubic): trilinear values would cut the crests of a texture a few voxels fine. In the
/// middle of a voxel these are the voxel itself and its 26 neighbours. Sources that continue each other
/// propose one value, which is read once where their places agree within a thousandth of a sample; where they
/// do not, the mean has no seam. The voxel's own source has a quarter of the weight: with less, what is
/// finest of a texture is lost where sources agree but for a part of a voxel. A field of `factor` times the
/// map's resolution is read at the voxels that make up each voxel of the map. Where all proposals are sure to
/// be more than half the limit on one side, the voxel's own source is read alone.
/// @param sources    of voxels, each with one source
/// @param mapBox     the target box in the map's coordinates
/// @param factor     1..64
/// @param otherwise  values of voxels without a source; the result's resolution, box begins at 0
/// @param limit      [voxels of the result] proposals are clamped there; distances are good up to half of it
/// @par Cost    O(voxels with a source * factor^3 * 27)   @par Repeats same bits for any number of threads
BrickField gatherThroughSources(const ElementSources& sources, const IndexBox& mapBox, int factor,
                                const std::vector<ExemplarSamples>& exemplars, const BrickField& otherwise,
                                float limit, const RunContext& ctx = {});

}  // namespace vdbsynth
