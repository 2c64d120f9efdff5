#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/point_cloud.h"

#include <string>

namespace vdbsynth {

/// True if the path ends in .xyz, .pwn or .pcd, in any case, with or without .gz. A .ply, .gltf or .glb may
/// also hold points; see holdsPoints.
bool isPointPath(const std::string& path);

/// True for a .ply file without any face element, or with an empty one, and for a .gltf or .glb file whose
/// scene has points and no triangles.
/// @throw Error as readPoints
bool holdsPoints(const std::string& path);

struct PointFile {
    PointCloud cloud;
    std::size_t invalid = 0;  ///< points left out because a coordinate was not finite
};

/// Reads a point cloud, with normals if it has them and none has length zero:
/// - .xyz, .pwn: rows of numbers; columns 4 to 6, or 7 to 9, are normals if all are unit vectors, within
///   2 %, else colours if all are from 0 to 255. A .pwn may also begin with a count, followed by all
///   points, then all normals;
/// - .pcd: ascii, binary and binary_compressed, fields of any type and order;
/// - .ply: as readMesh, vertices with nx ny nz;
/// - .gltf, .glb: as readMesh, primitives of points.
/// Strict as readMesh, except for non-finite coordinates, with which scanners mark pixels without a point.
/// @throw Error Io, BadData (truncated, corrupt, no x y z), EmptyInput (no points), InvalidOption (extension)
/// @par Cost    O(file size)   @par Repeats yes
PointFile readPoints(const std::string& path, const RunContext& ctx = {});

}  // namespace vdbsynth
