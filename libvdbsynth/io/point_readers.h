#pragma once
#include "libvdbsynth/io/point_file.h"

namespace vdbsynth {

// One reader a format, behind readPoints, which drops what is not finite. `content` is the whole file.
// @throw Error BadData
PointCloud readPlyPoints(const std::string& path, const std::string& content);
PointCloud readPcd(const std::string& path, const std::string& content);
PointCloud readRows(const std::string& path, const std::string& content);

/// Number of faces and strips that a PLY header claims. @throw Error BadData
std::int64_t plyFaceCount(const std::string& path, const std::string& content);

}  // namespace vdbsynth
