#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/point_cloud.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// True if the path ends in .pcd, or an extension of rows of numbers: .xyz, .xyzn, .xyzrgb, .pts, .pwn, .txt,
/// .asc, .csv; in any case, with or without .gz. A .ply, .npy, .gltf or .glb may also hold
/// points; see holdsPoints.
bool isPointPath(const std::string& path);
/// The extensions of isPointPath in words, for messages.
extern const char* const kPointExtensions;

/// True for a .ply file without any face element, or with an empty one, and for an .npy array of N x 3 (or
/// 3 x N) numbers: 3 to 9 real ones, or 3 whole ones of two bytes or more, of at least ten times as many
/// points; and for a .gltf or .glb file whose scene has points and no triangles.
/// @throw Error as readPoints
bool holdsPoints(const std::string& path);

struct PointFile {
    PointCloud cloud;
    std::size_t invalid = 0;  ///< points left out because a coordinate was not finite
    /// Of a .ply's header, in order; texture_box.h and others read what vdb_synth wrote there.
    std::vector<std::string> comments;
};

/// Reads a point cloud, with normals if it has them and none has length zero:
/// - rows of numbers, separated by blanks, tabs, commas, semicolons or pipes, with decimal points or commas.
///   A header line or comment that names x, y and z names the columns: nx ny nz are normals, r g b colours,
///   others attributes. Without one, columns 1 to 3 are the place; three more are normals if all are unit
///   vectors, within 2 %, else colours if all are from 0 to 255, then three more; a single column before or
///   behind them is an intensity. Counts of points on lines of their own (PTS) may precede the rows; a count,
///   all points, then all normals (.pwn) is read too. The last row of a file that was cut off is left out;
/// - .pcd 0.5 to 0.7: ascii, binary and binary_compressed, fields of any type and order;
/// - .ply: as readMesh, vertices with nx ny nz;
/// - .gltf, .glb: as readMesh, primitives of points;
/// - .npy: as rows without names; see holdsPoints.
/// Whatever is guessed, or left out, is a message. Strict otherwise, except for non-finite coordinates, with
/// which scanners mark pixels without a point. Coordinates are read as doubles.
/// @throw Error Io, BadData (truncated, corrupt, no x y z), EmptyInput (no points), InvalidOption (extension)
/// @par Cost    O(file size)   @par Repeats yes
PointFile readPoints(const std::string& path, const RunContext& ctx = {});

}  // namespace vdbsynth
