#include "libvdbsynth/io/point_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/points/point_readers.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

namespace vdbsynth {
namespace {

template <typename T>
bool isFinite(const Vec3<T>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool fitsFloats(const Vec3d& v) {
    const auto fits = [](double value) { return std::abs(value) <= double(FLT_MAX); };
    return fits(v.x) && fits(v.y) && fits(v.z);
}

// What clean left out.
struct Cleaned {
    std::size_t invalid = 0;  // points that are not finite
    std::size_t tooFar = 0;   // points that floats cannot hold
    std::size_t bare = 0;     // points without a normal, because of which all normals are
};

constexpr float kRounding = 1e-6f;  // of a length of one

// Removes points that are not finite, and all normals if one point lacks its normal.
Cleaned clean(PointContent& cloud) {
    Cleaned cleaned;
    const bool normals = cloud.normals.size() == cloud.points.size();
    std::size_t kept = 0;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        if (!isFinite(cloud.points[i]) || !fitsFloats(cloud.points[i])) {
            ++(isFinite(cloud.points[i]) ? cleaned.tooFar : cleaned.invalid);
            continue;
        }
        cloud.points[kept] = cloud.points[i];
        if (normals) {
            const float size = isFinite(cloud.normals[i]) ? length(cloud.normals[i]) : 0;
            cleaned.bare += !(size > 1e-6f);
            // Of length one but for rounding they keep their bits, so that a file comes out as it went in.
            const float scale = std::abs(size - 1) > kRounding ? 1 / size : 1.f;
            cloud.normals[kept] = size > 1e-6f ? cloud.normals[i] * scale : Vec3f{};
        }
        ++kept;
        rows.push_back(i);
    }
    const std::size_t dropped = cloud.points.size() - kept;
    if (dropped > 0) cloud.attributes = selectRows(cloud.attributes, rows);
    cloud.points.resize(kept);
    cloud.normals.resize(normals && cleaned.bare == 0 ? kept : 0);
    return cleaned;
}

void sayCleaned(const std::string& path, const Cleaned& cleaned, std::size_t points, const RunContext& ctx) {
    if (cleaned.tooFar > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + countText(cleaned.tooFar, "outlier") + " of " + countText(points, "point") +
                    " left out: their coordinates are over 3.4e38");
    if (cleaned.bare > 0)
        message(ctx, MessageLevel::Note,
                path + ": its normals left out, for " + std::to_string(cleaned.bare) +
                    " of its points have none (zero or not finite)");
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

bool isRowsExtension(const std::string& extension) {
    static const char* const known[] = {"xyz", "pwn", "pts", "txt", "asc", "csv", "xyzn", "xyzrgb"};
    return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

// A header is short, so most of a large file need not be read twice.
std::string startOf(const std::string& path) {
    std::string start(1 << 16, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), std::streamsize(start.size()));
    start.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
    return start;
}

}  // namespace

const char* const kPointExtensions = ".xyz, .xyzn, .xyzrgb, .pts, .pwn, .txt, .asc, .csv, .pcd";

bool isPointPath(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    return extension == "pcd" || isRowsExtension(extension);
}

bool holdsPoints(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    const bool gltf = isGltf(extension);
    if (extension != "ply" && extension != "npy" && !gltf) return false;
    const std::string start = startOf(path);
    if (start.empty()) return false;  // which its reader will say
    if (extension == "npy") return npyHoldsPoints(path, isGzip(start) ? readWholeFile(path) : start);
    const bool part =
        !isGzip(start) && (gltf ? holdsGltfJson(start) : start.find("end_header") != std::string::npos);
    const std::string content = part ? start : readWholeFile(path);
    return gltf ? gltfHoldsPoints(path, content) : plyFaceCount(path, content) == 0;
}

PointFile readPoints(const std::string& path, const RunContext& ctx) {
    const std::string extension = readExtensionOf(path);
    if (!isPointPath(path) && extension != "ply" && extension != "npy" && !isGltf(extension))
        throw Error(ErrorCode::InvalidOption,
                    path + ": unknown extension; points are .ply, .npy, .gltf, .glb, " + kPointExtensions);
    Stage stage(ctx, "reading " + path, 2, /* reading= */ true);
    const std::string content = readWholeFile(path);
    stage.advance();
    if (content.empty()) throw Error(ErrorCode::BadData, path + ": the file is empty");
    PointFile file;
    PointContent points = extension == "ply"   ? readPlyPoints(path, content, ctx)
                          : extension == "npy" ? readNpyPoints(path, content, ctx)
                          : isGltf(extension)  ? readGltfPoints(path, content, ctx)
                          : extension == "pcd" ? readPcd(path, content, ctx)
                                               : readRows(path, content, ctx);
    const std::size_t count = points.points.size();
    const Cleaned cleaned = clean(points);
    file.invalid = cleaned.invalid;
    sayCleaned(path, cleaned, count, ctx);
    if (points.points.empty())
        throw Error(ErrorCode::EmptyInput, path + ": no points with finite coordinates");
    LocalPoints local = localPoints(points.points);
    file.cloud.points = std::move(local.points);
    file.cloud.origin = local.origin;
    file.cloud.normals = std::move(points.normals);
    file.cloud.attributes = std::move(points.attributes);
    file.comments = std::move(points.comments);
    stage.advance();
    return file;
}

}  // namespace vdbsynth
