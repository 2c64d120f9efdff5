#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/math/vec3.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// What a file of points holds, before it becomes a PointCloud.
struct PointContent {
    std::vector<Vec3d> points;          ///< as in the file, also those that are not finite
    std::vector<Vec3f> normals;         ///< one per point, or empty
    Attributes attributes;              ///< of the points
    std::vector<std::string> comments;  ///< of a .ply's header
};

// One reader per format, behind readPoints, which drops non-finite points. `content` is the whole file. What
// a reader guesses or leaves out is a message.
// @throw Error BadData
PointContent readPlyPoints(const std::string& path, const std::string& content, const RunContext& ctx = {});
PointContent readPcd(const std::string& path, const std::string& content, const RunContext& ctx = {});
PointContent readGltfPoints(const std::string& path, const std::string& content, const RunContext& ctx = {});
PointContent readRows(const std::string& path, const std::string& content, const RunContext& ctx = {});
PointContent readNpyPoints(const std::string& path, const std::string& content, const RunContext& ctx = {});

/// True if an array's header claims points: 3 to 9 columns (or rows) of real numbers, or 3 of whole ones of
/// two bytes or more, and at least ten times as many of the other. @throw Error BadData
bool npyHoldsPoints(const std::string& path, const std::string& content);

/// Number of elements of faces or strips that are not empty, as a PLY header claims. @throw Error BadData
std::int64_t plyFaceCount(const std::string& path, const std::string& content);

/// True if the scene of a glTF file has points and no triangles. Of a .glb the JSON chunk is enough.
/// @throw Error BadData
bool gltfHoldsPoints(const std::string& path, const std::string& content);

}  // namespace vdbsynth
