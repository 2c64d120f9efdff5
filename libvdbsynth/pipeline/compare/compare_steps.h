#pragma once
#include "libvdbsynth/measure/local_patches.h"
#include "libvdbsynth/measure/novelty.h"
#include "libvdbsynth/measure/patch_distribution.h"
#include "libvdbsynth/measure/statistics.h"
#include "libvdbsynth/measure/surface_distance.h"
#include "libvdbsynth/measure/verdict.h"
#include "libvdbsynth/pipeline/compare/compare.h"

#include <string>
#include <vector>

namespace vdbsynth {

// The steps of compareModels, for its own files.

inline constexpr int kCapMargin = 2;  ///< [voxels] at a domain's face where caps distort the field

/// A model with everything that is measured more than once.
struct PreparedModel {
    MeasuredModel model;
    Index3 corner;  ///< the voxel of the grid that is the field's voxel 0
    PatchSource patches;
    std::vector<Projections> projections;  ///< by scale
};

/// @param coarsening  see prepare (measure/statistics.h)
PreparedModel prepareModel(const std::string& name, const LevelSet& levelSet, int coarsening,
                           const RunContext& ctx);

/// Thickness is measured on samples of one size for all models, so that results are comparable.
int thicknessCoarsening(const CompareInput& reference, const std::vector<CompareInput>& others);

/// Axes whose two end faces of the domain cut about the same area of the solid. A slab or a terrain is cut
/// below but hardly or not at all above.
std::array<bool, 3> cutAxes(const MeasuredModel& model);

/// The spread of the reference's own sub-volumes.
struct Spread {
    Index3 part;                                     ///< size of a sub-volume
    std::vector<std::vector<Statistic>> statistics;  ///< [statistic][part]
    std::vector<std::vector<double>> wasserstein;    ///< [scale][part] from the other parts; empty: none
};
Spread spreadOf(const PreparedModel& reference, const std::vector<IndexBox>& parts, int reach,
                const RunContext& ctx);

/// A model relative to that spread. Its statistics are means over boxes of the size of a sub-volume, so that
/// statistics that depend on the box size (a long chord fits into few boxes) are comparable; over its whole
/// length where it is shorter.
std::vector<Verdict> verdictsOn(const Spread& spread, const PreparedModel& other,
                                const ModelDistances& distances, int reach, const RunContext& ctx);

/// The part of a model's measurements that yardsticks need later.
using ScaleProjections = std::vector<Projections>;

/// Rows for everything that is measured for the reference and for all samples.
/// @param others  projections of the models of comparison.others
std::vector<Yardstick> yardsticksOf(const CompareInput& reference, const PreparedModel& to,
                                    const Comparison& comparison, const std::vector<ScaleProjections>& others,
                                    const CompareOptions& options, const RunContext& ctx);

}  // namespace vdbsynth
