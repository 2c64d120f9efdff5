#include "libvdbsynth/io/raster_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "libvdbsynth/raster/raster_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace vdbsynth {
namespace {

using Reader = Raster (*)(const std::string&, const std::string&, const RasterReadOptions&,
                          const RunContext&);

const std::map<std::string, Reader>& readers() {
    static const std::map<std::string, Reader> table{
        {"png", readPng}, {"jpg", readJpeg},  {"jpeg", readJpeg},   {"pgm", readPnm},     {"ppm", readPnm},
        {"pnm", readPnm}, {"tif", readTiff},  {"tiff", readTiff},   {"exr", readExr},     {"npy", readNpy},
        {"vti", readVti}, {"nii", readNifti}, {"sgems", readGslib}, {"gslib", readGslib}, {"inr", readInr}};
    return table;
}

float halfToFloat(std::uint16_t half) {
    const int exponent = (half >> 10) & 31;
    const float mantissa = float(half & 1023);
    const float size = exponent == 0    ? std::ldexp(mantissa, -24)
                       : exponent == 31 ? (mantissa > 0 ? std::nanf("") : INFINITY)
                                        : std::ldexp(mantissa + 1024, exponent - 25);
    return half & 0x8000 ? -size : size;
}

template <typename T, typename Convert>
void convert(const char* bytes, std::size_t count, bool swap, float* out, Convert toFloat) {
    for (std::size_t i = 0; i < count; ++i) {
        char raw[sizeof(T)];
        std::memcpy(raw, bytes + i * sizeof(T), sizeof(T));
        if (swap) std::reverse(raw, raw + sizeof(T));
        T value;
        std::memcpy(&value, raw, sizeof(T));
        out[i] = toFloat(value);
    }
}

template <typename T>
void convertPlain(const char* bytes, std::size_t count, bool swap, float* out) {
    convert<T>(bytes, count, swap, out, [](T value) { return float(value); });
}

}  // namespace

const char* const kRasterExtensions =
    "images .png, .jpg, .pgm, .ppm, .tif, .exr, volumes .npy, .tif, .vti, .nii, .sgems, .inr";

std::size_t bytesOf(SampleType type) {
    switch (type) {
        case SampleType::U8:
        case SampleType::I8:
            return 1;
        case SampleType::U16:
        case SampleType::I16:
        case SampleType::F16:
            return 2;
        case SampleType::U32:
        case SampleType::I32:
        case SampleType::F32:
            return 4;
        default:
            return 8;
    }
}

double whiteOf(SampleType type) {
    return type == SampleType::U8 ? 255 : type == SampleType::U16 ? 65535 : 0;
}

void toFloats(const char* bytes, std::size_t count, SampleType type, bool swap, float* out) {
    switch (type) {
        case SampleType::U8:
            return convertPlain<std::uint8_t>(bytes, count, swap, out);
        case SampleType::I8:
            return convertPlain<std::int8_t>(bytes, count, swap, out);
        case SampleType::U16:
            return convertPlain<std::uint16_t>(bytes, count, swap, out);
        case SampleType::I16:
            return convertPlain<std::int16_t>(bytes, count, swap, out);
        case SampleType::U32:
            return convertPlain<std::uint32_t>(bytes, count, swap, out);
        case SampleType::I32:
            return convertPlain<std::int32_t>(bytes, count, swap, out);
        case SampleType::U64:
            return convertPlain<std::uint64_t>(bytes, count, swap, out);
        case SampleType::I64:
            return convertPlain<std::int64_t>(bytes, count, swap, out);
        case SampleType::F16:
            return convert<std::uint16_t>(bytes, count, swap, out, halfToFloat);
        case SampleType::F32:
            return convertPlain<float>(bytes, count, swap, out);
        case SampleType::F64:
            return convertPlain<double>(bytes, count, swap, out);
    }
}

std::size_t chosenArray(const std::string& path, const std::vector<std::string>& names, std::size_t standard,
                        const RasterReadOptions& options, const RunContext& ctx) {
    constexpr std::size_t kMostListed = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
        list += (i > 0 ? ", " : "") + names[i];
    if (names.size() > kMostListed) list += " and " + std::to_string(names.size() - kMostListed) + " more";
    if (!options.array.empty()) {
        const auto found = std::find(names.begin(), names.end(), options.array);
        if (found == names.end())
            throw Error(ErrorCode::BadData, "`grid` " + options.array + ": not in " + path + ", which has " +
                                                (names.empty() ? "no arrays" : list));
        return std::size_t(found - names.begin());
    }
    if (names.size() > 1)
        message(ctx, MessageLevel::Note,
                path + ": holds " + list + "; " + names[standard] + " is read; `grid` chooses another");
    return standard;
}

void sayTurn(const std::string& path, const Raster& raster, const RunContext& ctx) {
    if (runAlongWorld(raster.axes)) return;
    message(ctx, MessageLevel::Note,
            path + ": its axes are turned by " + roundedText(turnOf(raster.axes).degrees, 3) +
                " degrees from those of the world; so are the voxels of the result");
}

Raster makeRaster(const std::string& path, std::int64_t columns, std::int64_t rows, std::int64_t slices,
                  int channels, const RunContext& ctx) {
    constexpr std::int64_t kMost = 1 << 24;
    for (const std::int64_t side : {columns, rows, slices})
        if (side < 1 || side > kMost)
            throw Error(ErrorCode::BadData, path + ": its header claims " + std::to_string(columns) + " x " +
                                                std::to_string(rows) + " x " + std::to_string(slices) +
                                                " samples; 1 to " + std::to_string(kMost) +
                                                " per side are supported");
    const double bytes = double(columns) * double(rows) * double(slices) * double(channels) * sizeof(float);
    requireMemory(ctx, bytes, path, "crop or shrink it first");
    if (bytes > 256e9) throw Error(ErrorCode::BadData, path + ": its header claims over 256 GB of samples");
    Raster raster;
    raster.size = {int(columns), int(rows), int(slices)};
    raster.channels = channels;
    raster.values.resize(raster.sampleCount() * std::size_t(channels));
    return raster;
}

bool isRasterPath(const std::string& path) {
    return readers().count(readExtensionOf(path)) > 0;
}

Raster readRaster(const std::string& path, const RasterReadOptions& options, const RunContext& ctx) {
    const auto reader = readers().find(readExtensionOf(path));
    if (reader == readers().end())
        throw Error(ErrorCode::InvalidOption, path + ": unknown extension; rasters are " + kRasterExtensions);
    Stage stage(ctx, "reading " + path, 2, /* reading= */ true);
    const std::string content = readWholeFile(path);
    stage.advance();
    if (content.empty()) throw Error(ErrorCode::BadData, path + ": the file is empty");
    Raster raster = reader->second(path, content, options, ctx);
    if (!options.array.empty() && raster.arrays.empty())
        message(ctx, MessageLevel::Note,
                path + ": holds one array without a name; `grid` does not apply to it");
    for (int axis = 0; axis < 3; ++axis)
        if (!(raster.spacing[axis] > 0 && raster.spacing[axis] < 1e30) || !std::isfinite(raster.origin[axis]))
            throw Error(ErrorCode::BadData, path + ": its spacing or origin is not a usable number");
    stage.advance();
    return raster;
}

}  // namespace vdbsynth
