#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/measure/functionals.h"
#include "libvdbsynth/measure/measures.h"
#include "libvdbsynth/measure/thickness.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

/// A level set prepared for measuring, in its own voxels from 0 on.
struct MeasuredModel {
    std::shared_ptr<const BrickField> field;  ///< [voxels] clamped to `band`
    float band = 3;
    IndexBox counted;                 ///< the domain within the field's box; statistics refer to this box
    Beyond beyond = Beyond::Unknown;  ///< Void: `counted` is the box of a whole object, the field continues
    Mesh surface;                     ///< zero level, faces outward, with its caps beyond the domain
    SurfaceElements elements;         ///< of the surface
    Occupancy solid;                  ///< of the field's box
    Thickness thickness, pores;       ///< pores empty for a whole object
};

/// Computes elements, solid, thickness and pores from the rest.
/// @param coarsening  side of the samples that thickness is measured on [voxels]: 1, 2, 4 ...
/// @throw Error Memory, Cancelled
void prepare(MeasuredModel& model, int coarsening, const RunContext& ctx = {});

/// All statistics of a box of a model whose mean does not depend on the box's size, in a fixed order. For a
/// whole object, and for a solid that no voxel at the sides of its domain belongs to, Euler characteristic
/// and surface are totals over the box's volume.
/// @param box    within model.counted, sides at least 4
/// @param reach  [voxels] of curves, less than every side
/// @par Repeats same bits for any number of threads
std::vector<Statistic> measureStatistics(const MeasuredModel& model, const IndexBox& box, int reach,
                                         const RunContext& ctx = {});

Topology measureTopology(const MeasuredModel& model, const RunContext& ctx = {});

GradientError measureGradient(const MeasuredModel& model, const RunContext& ctx = {});

/// Distance of two statistics: the absolute difference of numbers, the root of the mean squared difference of
/// curves (up to the shorter one's end).
double statisticDistance(const Statistic& a, const Statistic& b);

}  // namespace vdbsynth
