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
#include <cstdint>
#include <cstring>
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

bool isGltf(const std::string& extension) {
    return extension == "gltf" || extension == "glb";
}

// True if the beginning of a .glb file reaches to the end of its first chunk, which is its JSON.
bool holdsGltfJson(const std::string& start) {
    std::uint32_t length = 0;
    if (start.size() < 20 || start.compare(0, 4, "glTF") != 0) return false;
    std::memcpy(&length, &start[12], sizeof length);
    return length <= start.size() - 20;
}

}  // namespace

bool isPointPath(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    return extension == "xyz" || extension == "pwn" || extension == "pcd";
}

bool holdsPoints(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    const bool gltf = isGltf(extension);
    if (extension != "ply" && !gltf) return false;
    // A header is short, so most of a large file need not be read twice.
    std::string start(1 << 16, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), std::streamsize(start.size()));
    start.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
    const bool part =
        !isGzip(start) && (gltf ? holdsGltfJson(start) : start.find("end_header") != std::string::npos);
    const std::string content = part ? start : readWholeFile(path);
    return gltf ? gltfHoldsPoints(path, content) : plyFaceCount(path, content) == 0;
}

PointFile readPoints(const std::string& path, const RunContext& ctx) {
    const std::string extension = readExtensionOf(path);
    if (!isPointPath(path) && extension != "ply" && !isGltf(extension))
        throw Error(ErrorCode::InvalidOption,
                    path + ": unknown extension; points are .ply, .xyz, .pwn, .pcd, .gltf or .glb");
    Stage stage(ctx, "reading " + path, 2, /* reading= */ true);
    const std::string content = readWholeFile(path);
    stage.advance();
    if (content.empty()) throw Error(ErrorCode::BadData, path + ": the file is empty");
    PointFile file;
    PointContent points = extension == "ply"   ? readPlyPoints(path, content, ctx)
                          : isGltf(extension)  ? readGltfPoints(path, content, ctx)
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
