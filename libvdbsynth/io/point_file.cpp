#include "libvdbsynth/io/point_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/point_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <fstream>

namespace vdbsynth {
namespace {

template <typename T>
bool isFinite(const Vec3<T>& v) {
    const auto fits = [](T value) { return std::abs(double(value)) <= double(FLT_MAX); };
    return fits(v.x) && fits(v.y) && fits(v.z);
}

// Removes points that are not finite, and all normals if one point lacks its normal.
std::size_t clean(PointContent& cloud) {
    bool normals = cloud.normals.size() == cloud.points.size();
    std::size_t kept = 0;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        if (!isFinite(cloud.points[i])) continue;
        cloud.points[kept] = cloud.points[i];
        if (normals) {
            const float size = isFinite(cloud.normals[i]) ? length(cloud.normals[i]) : 0;
            normals = size > 1e-6f;
            cloud.normals[kept] = normals ? cloud.normals[i] * (1 / size) : Vec3f{};
        }
        ++kept;
        rows.push_back(i);
    }
    const std::size_t dropped = cloud.points.size() - kept;
    if (dropped > 0) cloud.attributes = selectRows(cloud.attributes, rows);
    cloud.points.resize(kept);
    cloud.normals.resize(normals ? kept : 0);
    return dropped;
}

}  // namespace

bool isPointPath(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    return extension == "xyz" || extension == "pwn" || extension == "pcd";
}

bool holdsPoints(const std::string& path) {
    if (readExtensionOf(path) != "ply") return false;
    // A header is short, so most of a large file need not be read twice.
    std::string start(1 << 16, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), std::streamsize(start.size()));
    start.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
    const bool whole = isGzip(start) || start.find("end_header") == std::string::npos;
    return plyFaceCount(path, whole ? readWholeFile(path) : start) == 0;
}

PointFile readPoints(const std::string& path, const RunContext& ctx) {
    const std::string extension = readExtensionOf(path);
    if (!isPointPath(path) && extension != "ply")
        throw Error(ErrorCode::InvalidOption,
                    path + ": unknown extension; points are .ply, .xyz, .pwn or .pcd");
    Stage stage(ctx, "reading " + path, 2, /* reading= */ true);
    const std::string content = readWholeFile(path);
    stage.advance();
    if (content.empty()) throw Error(ErrorCode::BadData, path + ": the file is empty");
    PointFile file;
    PointContent points = extension == "ply"   ? readPlyPoints(path, content, ctx)
                          : extension == "pcd" ? readPcd(path, content, ctx)
                                               : readRows(path, content, ctx);
    file.invalid = clean(points);
    if (points.points.empty())
        throw Error(ErrorCode::EmptyInput, path + ": no points with finite coordinates");
    LocalPoints local = localPoints(points.points);
    file.cloud.points = std::move(local.points);
    file.cloud.origin = local.origin;
    file.cloud.normals = std::move(points.normals);
    file.cloud.attributes = std::move(points.attributes);
    stage.advance();
    return file;
}

}  // namespace vdbsynth
