// NIfTI-1 and NIfTI-2, single files.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/raster/raster_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace vdbsynth {
namespace {

// Reads fields of the header in either byte order.
class HeaderFields {
public:
    HeaderFields(const std::string& content, bool swap) : mContent(content), mSwap(swap) {}
    template <typename T>
    double at(std::size_t offset) const {
        char raw[sizeof(T)];
        std::memcpy(raw, mContent.data() + offset, sizeof(T));
        if (mSwap) std::reverse(raw, raw + sizeof(T));
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return double(value);
    }

private:
    const std::string& mContent;
    bool mSwap;
};

// The fields used from both versions' headers.
struct Header {
    bool swap = false;
    double dims[8] = {}, pixdim[8] = {}, offset = 0, slope = 0, intercept = 0;
    int datatype = 0, qform = 0, sform = 0, units = 0;
    double quaternion[6] = {};
    Affine srow = kIdentity;
};

template <typename Dim, typename Real, typename Code>
void readFields(const HeaderFields& f, Header& h, const std::array<std::size_t, 10>& at) {
    for (std::size_t i = 0; i < 8; ++i) {
        h.dims[i] = f.at<Dim>(at[0] + i * sizeof(Dim));
        h.pixdim[i] = f.at<Real>(at[1] + i * sizeof(Real));
    }
    h.datatype = int(f.at<std::int16_t>(at[2]));
    h.slope = f.at<Real>(at[4]);
    h.intercept = f.at<Real>(at[4] + sizeof(Real));
    h.units = int(f.at<Code>(at[5]));
    h.qform = int(f.at<Code>(at[6]));
    h.sform = int(f.at<Code>(at[7]));
    for (std::size_t i = 0; i < 6; ++i) h.quaternion[i] = f.at<Real>(at[8] + i * sizeof(Real));
    for (std::size_t i = 0; i < 12; ++i) h.srow[i % 4 * 4 + i / 4] = f.at<Real>(at[9] + i * sizeof(Real));
}

// Analyze 7.5 and pairs of .hdr and .img have the same header.
void requireOneFile(const std::string& path, const std::string& magic) {
    if (magic.compare(0, 2, "n+") == 0) return;
    if (magic.compare(0, 2, "ni") == 0)
        throw Error(ErrorCode::BadData,
                    path + ": its voxels are in another file (.img); convert it to one .nii");
    throw Error(ErrorCode::BadData, path +
                                        ": has an Analyze 7.5 header (no NIfTI magic), which says nothing "
                                        "of orientation; convert it to one .nii");
}

Header parseHeader(const std::string& path, const std::string& content) {
    Header h;
    std::int32_t size = 0;
    if (content.size() >= 4) std::memcpy(&size, content.data(), 4);
    const std::int32_t swapped = std::int32_t(__builtin_bswap32(std::uint32_t(size)));
    h.swap = swapped == 348 || swapped == 540;
    if (h.swap) size = swapped;
    if ((size != 348 && size != 540) || content.size() < std::size_t(size) + 4)
        throw Error(ErrorCode::BadData, path + ": not a NIfTI file, or truncated in its header");
    const HeaderFields f(content, h.swap);
    requireOneFile(path, size == 348 ? content.substr(344, 3) : content.substr(4, 3));
    if (size == 348) {
        readFields<std::int16_t, float, std::int16_t>(f, h, {40, 76, 70, 108, 112, 123, 252, 254, 256, 280});
        h.offset = std::max(352.0, f.at<float>(108));
        h.units = content[123];
    } else {
        readFields<std::int64_t, double, std::int32_t>(f, h,
                                                       {16, 104, 12, 168, 176, 500, 344, 348, 352, 400});
        h.offset = std::max(544.0, f.at<std::int64_t>(168));
    }
    return h;
}

SampleType typeOf(const std::string& path, int code) {
    static const std::map<int, SampleType> types{
        {2, SampleType::U8},     {4, SampleType::I16},   {8, SampleType::I32},   {16, SampleType::F32},
        {64, SampleType::F64},   {256, SampleType::I8},  {512, SampleType::U16}, {768, SampleType::U32},
        {1024, SampleType::I64}, {1280, SampleType::U64}};
    static const std::map<int, const char*> others{
        {0, "unknown"},     {1, "bits"},          {32, "complex numbers"}, {128, "colours (RGB24)"},
        {1536, "float128"}, {1792, "complex128"}, {2048, "complex256"},    {2304, "colours (RGBA32)"}};
    const auto found = types.find(code);
    if (found != types.end()) return found->second;
    const auto other = others.find(code);
    throw Error(ErrorCode::BadData, path + ": holds values of NIfTI data type " + std::to_string(code) +
                                        (other == others.end() ? "" : std::string(", ") + other->second) +
                                        ", which is not supported; convert it to one real number a voxel");
}

// Sizes of voxels without a sign; zero is how some writers say one.
std::array<double, 3> voxelSizes(const Header& h) {
    std::array<double, 3> sizes;
    for (std::size_t i = 0; i < 3; ++i) sizes[i] = h.pixdim[i + 1] == 0 ? 1 : std::abs(h.pixdim[i + 1]);
    return sizes;
}

// The map by the quaternion.
Affine qformOf(const Header& h) {
    double b = h.quaternion[0], c = h.quaternion[1], d = h.quaternion[2];
    const double rest = 1 - (b * b + c * c + d * d);
    double a = 0;
    // Three parts stored as floats: what rounding left is no fourth part.
    if (rest < 1e-7) {
        const double norm = std::sqrt(b * b + c * c + d * d);
        b /= norm, c /= norm, d /= norm;
    } else {
        a = std::sqrt(rest);
    }
    Affine m = rotation(b, c, d, a);
    const std::array<double, 3> sizes = voxelSizes(h);
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) m[4 * j + i] *= sizes[j] * (j == 2 && h.pixdim[0] < 0 ? -1 : 1);
    for (std::size_t i = 0; i < 3; ++i) m[12 + i] = h.quaternion[3 + i];
    return m;
}

// How far apart two maps place a corner of the volume.
double largestDifference(const Affine& a, const Affine& b, const Index3& size) {
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d at{corner & 1 ? size.x - 1.0 : 0, corner & 2 ? size.y - 1.0 : 0,
                       corner & 4 ? size.z - 1.0 : 0};
        const Vec3d way = transformed(a, at) - transformed(b, at);
        most = std::max(most, length(way));
    }
    return most;
}

bool isUsable(const Affine& m) {
    const double volume = std::abs(determinant(m));
    return volume > 0 && std::isfinite(volume);
}

// Voxel to world by the transform that the standard prefers: sform, qform, voxel sizes alone.
Affine affineOf(const std::string& path, const Header& h, const Index3& size, const RunContext& ctx) {
    const std::array<double, 3> sizes = voxelSizes(h);
    const Affine q = h.qform > 0 ? qformOf(h) : kIdentity;
    if (h.sform > 0 && isUsable(h.srow)) {
        const double apart = h.qform > 0 && isUsable(q) ? largestDifference(h.srow, q, size) : 0;
        if (apart > 0.5 * *std::min_element(sizes.begin(), sizes.end()))
            message(ctx, MessageLevel::Note,
                    path + ": its sform and its qform place it differently, by up to " +
                        roundedText(apart, 3) + "; the sform is used");
        else
            message(ctx, MessageLevel::Detail, path + ": placed by its sform");
        return h.srow;
    }
    if (h.sform > 0)
        message(
            ctx, MessageLevel::Note,
            path + ": its sform is singular; placed by its " + (h.qform > 0 ? "qform" : "voxel sizes alone"));
    if (h.qform > 0) {
        message(ctx, MessageLevel::Detail, path + ": placed by its qform");
        return q;
    }
    if (h.sform <= 0)
        message(ctx, MessageLevel::Note,
                path + ": has no sform and no qform; placed by its voxel sizes alone");
    Affine m = kIdentity;
    for (std::size_t i = 0; i < 3; ++i) m[5 * i] = sizes[i];
    return m;
}

Raster placed(const std::string& path, Raster stored, const Header& h, const RunContext& ctx) {
    const Affine m = affineOf(path, h, stored.size, ctx);
    Raster raster = alignedToWorld(path, std::move(stored), m, ctx);
    raster.stack = true;
    raster.unit = (h.units & 7) == 1 ? "m" : (h.units & 7) == 2 ? "mm" : (h.units & 7) == 3 ? "um" : "";
    sayTurn(path, raster, ctx);
    return raster;
}

// Names of the volumes that follow each other: frames of time, parts of vectors and what else is counted.
std::vector<std::string> volumesOf(const std::string& path, const Header& h) {
    constexpr std::int64_t kMost = 100000;
    // Some writers leave dimensions that they do not use at zero.
    const auto side = [&](int i) {
        return i <= int(h.dims[0]) ? std::int64_t(std::clamp(h.dims[i], 1.0, 1e9)) : 1;
    };
    const std::optional<std::int64_t> count = checkedProduct({side(4), side(5), side(6), side(7)});
    if (!count || *count > kMost)
        throw Error(ErrorCode::BadData, path + ": its header claims over " + std::to_string(kMost) +
                                            " volumes; save the one you need as a file of its own");
    std::vector<std::string> names;
    const char* kind = side(4) == 1 && side(5) > 1 ? "component" : "volume";
    for (std::int64_t i = 1; i <= *count; ++i) names.push_back(kind + std::to_string(i));
    return names;
}

void scale(const Header& h, Raster& raster) {
    if (!std::isfinite(h.slope) || !std::isfinite(h.intercept) || h.slope == 0) return;
    if (h.slope == 1 && h.intercept == 0) return;
    for (float& value : raster.values) value = float(double(value) * h.slope + h.intercept);
    raster.white = 0;
}

}  // namespace

Raster readNifti(const std::string& path, const std::string& content, const RasterReadOptions& options,
                 const RunContext& ctx) {
    const Header h = parseHeader(path, content);
    if (!(h.dims[0] >= 1 && h.dims[0] <= 7))
        throw Error(ErrorCode::BadData, path + ": its header claims " + roundedText(h.dims[0], 6) +
                                            " dimensions; 1 to 7 are possible");
    const SampleType type = typeOf(path, h.datatype);
    const std::vector<std::string> volumes = volumesOf(path, h);
    // Version 2 allows sides that no other type holds.
    const auto side = [&h](int i) {
        return i <= int(h.dims[0]) ? std::int64_t(std::clamp(h.dims[i], -1e15, 1e15)) : 1;
    };
    const std::int64_t columns = side(1), rows = side(2), slices = side(3);
    if (!(h.offset >= 0 && h.offset <= double(content.size())) ||
        !productFits({columns, rows, slices, std::int64_t(bytesOf(type)), std::int64_t(volumes.size())},
                     content.size() - std::size_t(h.offset)))
        throw Error(ErrorCode::BadData,
                    path + ": truncated; its header claims " + std::to_string(columns) + " x " +
                        std::to_string(rows) + " x " + std::to_string(slices) + " voxels" +
                        (volumes.size() > 1 ? " in " + std::to_string(volumes.size()) + " volumes" : ""));
    const std::size_t volume = volumes.size() > 1 ? chosenArray(path, volumes, 0, options, ctx) : 0;
    Raster stored = makeRaster(path, columns, rows, slices, 1, ctx);
    stored.white = whiteOf(type);
    toFloats(content.data() + std::size_t(h.offset) + volume * stored.values.size() * bytesOf(type),
             stored.values.size(), type, h.swap, stored.values.data());
    scale(h, stored);
    Raster raster = placed(path, std::move(stored), h, ctx);
    if (volumes.size() > 1) raster.arrays = volumes;
    return raster;
}

}  // namespace vdbsynth
