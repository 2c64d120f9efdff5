#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/measure/components.h"
#include "libvdbsynth/measure/thickness.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

/// A level set made ready to be measured, in voxels of its own from 0 on.
struct MeasuredModel {
    std::shared_ptr<const BrickField> field;  ///< [voxels] clamped to `band`
    float band = 3;
    IndexBox counted;                 ///< the domain within the field's box; statistics mean this box
    Beyond beyond = Beyond::Unknown;  ///< Void: `counted` is the box of a whole object, the field goes on
    Mesh surface;                     ///< zero level, faces outward, with its caps beyond the domain
    SurfaceElements elements;         ///< of the surface
    Occupancy solid;                  ///< of the field's box
    Thickness thickness, pores;       ///< pores empty for a whole object
};

/// Fills elements, solid, thickness and pores from the rest.
/// @param coarsening  side of the samples that thickness works on [voxels]: 1, 2, 4 ...
/// @throw Error Memory, Cancelled
void prepare(MeasuredModel& model, int coarsening, const RunContext& ctx = {});

/// One statistic of a box: a number, or a curve.
struct Statistic {
    std::string name;
    int power = 0;  ///< world value = value * voxel size^power (of a number; a curve's abscissa is a length)
    bool curve = false;
    std::vector<double> values;  ///< [1], [3] by axis, or the curve, for several axes one after another;
                                 ///< empty: not measured (pores of an object)
    bool measured() const { return !values.empty(); }
};

/// All statistics of a box of a model that do not depend on the box's size in the mean, in a fixed order.
/// Of a whole object's Euler characteristic and surface all is counted, over the box's volume.
/// @param box    within model.counted, sides at least 4
/// @param reach  [voxels] of curves, less than every side
/// @par Repeats same bits for any number of threads
std::vector<Statistic> measureStatistics(const MeasuredModel& model, const IndexBox& box, int reach,
                                         const RunContext& ctx = {});

/// What is counted once for a whole model.
struct Topology {
    Components solid, empty;  ///< parts of solid and void; of an object the outside is one of the void's
    double eulerCharacteristic = 0;  ///< total; density times volume where the texture goes on
    double enclosed = 0;             ///< parts of the void that touch no face
    double tunnels = 0;              ///< first Betti number, of a whole object only
};
Topology measureTopology(const MeasuredModel& model, const RunContext& ctx = {});

/// How true to a distance the field is where |value| < 1: mean and 99th percentile of | |grad| - 1 |, by
/// central or upwind differences, whichever is nearer (a ridge inside a wall has no central gradient). Two
/// voxels at the faces of a domain do not count, where caps bend the field.
struct GradientError {
    double mean = 0, percentile99 = 0;
};
GradientError measureGradient(const MeasuredModel& model, const RunContext& ctx = {});

/// Distance of two statistics: the absolute difference of numbers, the root of the mean squared difference of
/// curves (as far as both go).
double statisticDistance(const Statistic& a, const Statistic& b);

}  // namespace vdbsynth
