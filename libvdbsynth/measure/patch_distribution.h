#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/index_box.h"

#include <memory>
#include <vector>

namespace vdbsynth {

inline constexpr int kPatchSide = 8;    ///< [samples]
inline constexpr int kPatchScales = 3;  ///< full, half, a quarter of the resolution

/// Patches of a field near its surface, at three scales: cubes of 8^3 samples whose middle 4^3 has both
/// signs. The coarser scales are means over 2^3 and 4^3 voxels of the clamped distances, so all values are in
/// voxels of the finest.
struct PatchScale {
    std::shared_ptr<const BrickField> field;
    std::vector<Index3> places;  ///< minimum corners, in a fixed order
};
struct PatchSource {
    std::vector<PatchScale> scales;  ///< [kPatchScales], fewer if the box is too small for the coarser
};

struct PatchSourceOptions {
    IndexBox box;               ///< [voxels of the field] contains all patches
    std::size_t limit = 30000;  ///< most positions, sampled at random; a third of it at coarser scales
    int scales = kPatchScales;  ///< 1..kPatchScales
};

/// @param field  [voxels] clamped to the band, box beginning at 0
/// @par Repeats same bits for (field, options, ctx.seed), any number of threads
PatchSource patchSource(std::shared_ptr<const BrickField> field, const PatchSourceOptions& options,
                        const RunContext& ctx = {});

/// Up to `count` patches of a scale, sampled at random, each projected on the same 128 random directions.
struct Projections {
    std::vector<Index3> places;              ///< [patches]
    std::vector<std::vector<float>> values;  ///< [128][patches], in the order of places
};
/// @par Repeats same bits for (scale, count, ctx.seed), any number of threads
Projections project(const PatchScale& scale, std::size_t count, const RunContext& ctx = {});

/// The patches inside a box of the finest scale's voxels, or those outside.
/// @param scale  0, 1, 2: the scale of the patches
Projections within(const Projections& all, const IndexBox& box, int scale, bool inside = true);

/// Sliced Wasserstein distance of two sets of patches [elnekave2022, Eq. 3]: the mean over the directions of
/// the distance between the two sets of projections, that is, the area between their quantile functions.
/// [voxels] 0 if a set is empty.
/// @par Repeats same bits for any number of threads
double slicedWasserstein(const Projections& a, const Projections& b, const RunContext& ctx = {});

/// Similarity of the patches of `from` to those of `to`: the mean over up to `count` randomly sampled
/// patches of `from` of the least mean squared difference [voxels^2] to a patch of `to`: coherence of a
/// result with its exemplar and, with the two exchanged, completeness [simakov2008, Eq. 1]. The least is
/// exact over the sampled positions of `to`; from there it descends over neighbouring corners, so that a
/// verbatim copy costs 0 even if its position was not sampled. A patch whose best costs `limit` or more gets
/// that cost and no position.
/// @par Repeats same bits for ctx.seed, any number of threads
struct PatchMatches {
    double mean = 0;            ///< [voxels^2]
    std::vector<Index3> from;   ///< [matches] corners, in the order sampled
    std::vector<Index3> to;     ///< [matches]
    std::vector<double> costs;  ///< [matches] mean squared difference
};
PatchMatches matchPatches(const PatchScale& from, const PatchScale& to, std::size_t count, double limit,
                          const RunContext& ctx = {});

/// Mean squared difference of two patches, by their corners.
double patchCost(const BrickField& a, const Index3& cornerA, const BrickField& b, const Index3& cornerB);

}  // namespace vdbsynth
