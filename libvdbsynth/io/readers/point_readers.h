#pragma once
#include "libvdbsynth/io/point_file.h"

namespace vdbsynth {

// One reader per format, behind readPoints, which drops non-finite points. `content` is the whole file.
// @throw Error BadData
PointCloud readPlyPoints(const std::string& path, const std::string& content);
PointCloud readPcd(const std::string& path, const std::string& content);
PointCloud readRows(const std::string& path, const std::string& content);

/// Number of elements of faces or strips that are not empty, as a PLY header claims. @throw Error BadData
std::int64_t plyFaceCount(const std::string& path, const std::string& content);

}  // namespace vdbsynth
