// NIfTI-1 and NIfTI-2, single files.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace vdbsynth {
namespace {

using Matrix = std::array<std::array<double, 4>, 3>;

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
    Matrix srow{};
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
    for (std::size_t i = 0; i < 12; ++i) h.srow[i / 4][i % 4] = f.at<Real>(at[9] + i * sizeof(Real));
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
    if (size == 348) {
        if (content.compare(344, 2, "n+") != 0)
            throw Error(ErrorCode::BadData,
                        path + ": its voxels are in another file (.img); convert it to one .nii");
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
    const auto found = types.find(code);
    if (found == types.end())
        throw Error(ErrorCode::BadData, path + ": NIfTI data type " + std::to_string(code) +
                                            " is not supported; plain numbers are");
    return found->second;
}

// Voxel to world by the transform that the file prefers; only its voxel sizes if it has none.
Matrix affineOf(const Header& h) {
    if (h.sform > 0) return h.srow;
    Matrix m{};
    const double fac = h.pixdim[0] < 0 ? -1 : 1;
    if (h.qform <= 0) {
        for (std::size_t i = 0; i < 3; ++i) m[i][i] = h.pixdim[i + 1];
        return m;
    }
    const double b = h.quaternion[0], c = h.quaternion[1], d = h.quaternion[2];
    const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
    const double r[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                            {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                            {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) m[i][j] = r[i][j] * h.pixdim[j + 1] * (j == 2 ? fac : 1);
        m[i][3] = h.quaternion[3 + i];
    }
    return m;
}

// For each world axis the voxel axis closest to it, without repetition.
std::array<int, 3> nearestAxes(const Matrix& m, bool& oblique) {
    std::array<int, 3> best{0, 1, 2}, order{0, 1, 2};
    double score = -1;
    do {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += std::abs(m[i][std::size_t(order[i])]);
        if (sum > score) {
            score = sum;
            best = order;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    oblique = false;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            oblique = oblique ||
                      (int(j) != best[i] && std::abs(m[i][j]) > 1e-3 * std::abs(m[i][std::size_t(best[i])]));
    return best;
}

// The samples reordered so that columns, rows and slices point along the world axes.
Raster aligned(const std::string& path, Raster stored, const Header& h, const RunContext& ctx) {
    const Matrix m = affineOf(h);
    bool oblique = false;
    const std::array<int, 3> axes = nearestAxes(m, oblique);
    Index3 size;
    for (int axis = 0; axis < 3; ++axis) size[axis] = stored.size[axes[std::size_t(axis)]];
    Raster raster = makeRaster(path, size.x, size.y, size.z, 1, ctx);
    raster.stack = true;
    raster.white = stored.white;
    bool flip[3];
    for (std::size_t i = 0; i < 3; ++i) {
        double squared = 0;
        for (std::size_t r = 0; r < 3; ++r)
            squared += m[r][std::size_t(axes[i])] * m[r][std::size_t(axes[i])];
        raster.spacing[int(i)] = std::sqrt(squared);
        flip[i] = m[i][std::size_t(axes[i])] < 0;
        raster.origin[int(i)] = m[i][3] - (flip[i] ? raster.spacing[int(i)] * (size[int(i)] - 1) : 0);
    }
    raster.knownSpacing = true;
    raster.unit = (h.units & 7) == 1 ? "m" : (h.units & 7) == 2 ? "mm" : (h.units & 7) == 3 ? "um" : "";
    if (oblique)
        message(ctx, MessageLevel::Note,
                path + ": is rotated relative to the world axes; the rotation is ignored");
    Index3 from;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const Index3 to{x, y, z};
                for (int axis = 0; axis < 3; ++axis)
                    from[axes[std::size_t(axis)]] = flip[axis] ? size[axis] - 1 - to[axis] : to[axis];
                raster.values[raster.index(x, y, z)] = stored.at(from.x, from.y, from.z);
            }
    return raster;
}

}  // namespace

Raster readNifti(const std::string& path, const std::string& content, const RasterReadOptions&,
                 const RunContext& ctx) {
    const Header h = parseHeader(path, content);
    const int dimensions = int(h.dims[0]);
    if (!(h.dims[0] >= 2 && h.dims[0] <= 7))
        throw Error(ErrorCode::BadData,
                    path + ": its header claims " + std::to_string(dimensions) + " dimensions");
    for (int i = 4; i <= dimensions; ++i)
        if (h.dims[i] > 1)
            throw Error(ErrorCode::BadData,
                        path + ": holds several volumes or vectors; one value a voxel is read");
    const SampleType type = typeOf(path, h.datatype);
    // Version 2 allows sides that no other type holds.
    const auto side = [&h](int i) { return std::int64_t(std::clamp(h.dims[i], -1e15, 1e15)); };
    const std::int64_t columns = side(1), rows = side(2), slices = dimensions > 2 ? side(3) : 1;
    if (!(h.offset >= 0 && h.offset <= double(content.size())) ||
        !productFits({columns, rows, slices, std::int64_t(bytesOf(type))},
                     content.size() - std::size_t(h.offset)))
        throw Error(ErrorCode::BadData, path + ": truncated");
    Raster stored = makeRaster(path, columns, rows, slices, 1, ctx);
    stored.white = whiteOf(type);
    toFloats(content.data() + std::size_t(h.offset), stored.values.size(), type, h.swap,
             stored.values.data());
    if (std::isfinite(h.slope) && std::isfinite(h.intercept) && h.slope != 0 &&
        !(h.slope == 1 && h.intercept == 0))
        for (float& value : stored.values) value = float(double(value) * h.slope + h.intercept);
    return aligned(path, std::move(stored), h, ctx);
}

}  // namespace vdbsynth
