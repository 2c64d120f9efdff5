#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

struct PointFieldOptions {
    float thickness = 0;  ///< [voxels] over 0: a shell about the points' surface
    float limit = 3;      ///< [voxels] largest absolute value of the field
};

/// A solid of oriented points as a field of which only the zero level is meant.
struct PointSolid {
    BrickField field;       ///< negative inside, in index space
    double solidShare = 1;  ///< of the points, those that clearly have an inside and an outside
};

/// Within 2.5 spacings of a point the value is made of the twelve nearest points: the distance to the sphere
/// fitted to them and their normals [guennebaud2007], which is right on what is smooth, and the moving least
/// squares one of their tangent planes [kolluri2008, Eq. 2], which is best at creases and on flat faces. They
/// share by how well plane and sphere explain the points, the planes alone where normals vary more than on a
/// sphere. Farther away the sign is that of the winding number of the points' areas [barill2018], which
/// closes gaps smoothly.
/// @param cloud  in index space, normals outward, at least 8 points
/// @par Cost    some microseconds for each voxel near a point
/// @par Repeats same bits for any number of threads
PointSolid pointField(const PointCloud& cloud, const PointFieldOptions& options = {},
                      const RunContext& ctx = {});

}  // namespace vdbsynth
