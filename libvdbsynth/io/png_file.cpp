#include "libvdbsynth/io/png_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/io/readers/orientation.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <string_view>

namespace vdbsynth {
namespace {

void writeImage(const std::string& path, int width, int height, png_uint_32 format, const void* pixels) {
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(width);
    image.height = png_uint_32(height);
    image.format = format;
    image.flags = PNG_IMAGE_FLAG_FAST;
    errno = 0;
    if (!png_image_write_to_file(&image, path.c_str(), 0, pixels, 0, nullptr))
        throw Error(ErrorCode::Io,
                    path + ": cannot be written: " + (errno ? std::strerror(errno) : image.message));
}

// State of libpng's callbacks: the bytes to read, and the message of its last error.
struct Source {
    const std::string& content;
    std::size_t at = 0;
    std::string failure{};
};

void readBytes(png_structp png, png_bytep out, png_size_t count) {
    Source& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.content.size() - source.at) png_error(png, "truncated");
    std::memcpy(out, source.content.data() + source.at, count);
    source.at += count;
}

void fail(png_structp png, png_const_charp text) {
    static_cast<Source*>(png_get_error_ptr(png))->failure = text;
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

struct Decoded {
    png_uint_32 width = 0, height = 0;
    int channels = 0, bits = 0;
    std::vector<png_byte> bytes{};
    std::vector<png_bytep> rows{};
};

// libpng exits by longjmp: nothing here has a destructor, and the caller owns the output. (The simplified
// interface would convert 16-bit values, which hold heights, to linear light.)
bool decode(png_structp png, png_infop info, Source& source, Decoded& image, const RunContext& ctx) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, &source, readBytes);
    png_set_user_limits(png, 1 << 20, 1 << 20);
    png_read_info(png, info);
    png_set_expand(png);
    image.width = png_get_image_width(png, info);
    image.height = png_get_image_height(png, info);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    image.channels = png_get_channels(png, info);
    image.bits = png_get_bit_depth(png, info);
    const std::size_t row = png_get_rowbytes(png, info);
    // A row of zeros deflates to a thousandth: the file cannot hold more pixels than that.
    if (double(row) * image.height > 1100.0 * double(source.content.size()) + 1e6)
        png_error(png, "truncated");
    requireMemory(ctx, double(row) * image.height * 3,
                  "an image of " + std::to_string(image.width) + " x " + std::to_string(image.height),
                  "shrink it first");
    image.bytes.resize(row * image.height);
    image.rows.resize(image.height);
    for (png_uint_32 y = 0; y < image.height; ++y) image.rows[y] = image.bytes.data() + y * row;
    png_read_image(png, image.rows.data());
    return true;
}

// The data of the first chunk of a kind, empty if there is none. libpng gives EXIF before the pixels only;
// this finds it behind them too.
std::string_view chunkNamed(const std::string& content, std::string_view name) {
    constexpr std::size_t kSignature = 8, kAround = 12;  // a chunk's length, name and checksum
    const std::string_view all(content);
    for (std::size_t at = kSignature; at + kAround <= all.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(all[at + i]);
        if (length > all.size() - at - kAround) break;
        if (all.substr(at + 4, 4) == name) return all.substr(at + 8, length);
        at += kAround + length;
    }
    return {};
}

void appendBytes(png_structp png, png_bytep bytes, png_size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void flushNothing(png_structp) {}

// A picture to encode: rows of `row` bytes, samples of 16 bits in the machine's order.
struct Encoded {
    int width, height, bits, type;
    const std::uint8_t* pixels;
    std::size_t row;
};

bool encode(png_structp png, png_infop info, const Encoded& image, std::string& bytes) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &bytes, appendBytes, flushNothing);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), image.bits, image.type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    if (image.bits == 16) png_set_swap(png);
    for (int y = 0; y < image.height; ++y) png_write_row(png, image.pixels + std::size_t(y) * image.row);
    png_write_end(png, nullptr);
    return true;
}

// No gamma is recorded: the values are heights, or stored as they were read.
bool encoded(const Encoded& image, std::string& bytes) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool good = info && encode(png, info, image, bytes);
    png_destroy_write_struct(&png, &info);
    return good;
}

png_uint_32 formatOf(const Picture& picture) {
    return picture.channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
}

}  // namespace

void writePng(const std::string& path, const Picture& picture) {
    writeImage(path, picture.width, picture.height, formatOf(picture), picture.pixels.data());
}

std::string encodePng(const Picture& picture) {
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(picture.width);
    image.height = png_uint_32(picture.height);
    image.format = formatOf(picture);
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.pixels.data(), 0, nullptr))
        throw Error(ErrorCode::Memory, std::string("a picture cannot be encoded: ") + image.message);
    bytes.resize(size);
    return bytes;
}

void writeGreyPng(const std::string& path, int width, int height, const std::vector<float>& values) {
    const bool alpha = std::any_of(values.begin(), values.end(), [](float v) { return std::isnan(v); });
    std::vector<std::uint16_t> pixels;
    pixels.reserve(values.size() * (alpha ? 2 : 1));
    for (float value : values) {
        const bool missing = std::isnan(value);
        pixels.push_back(missing ? 0
                                 : std::uint16_t(std::lround(double(std::clamp(value, 0.f, 1.f)) * 65535)));
        if (alpha) pixels.push_back(missing ? 0 : 65535);
    }
    std::string bytes;
    const std::size_t row = std::size_t(width) * (alpha ? 4 : 2);
    if (!encoded({width, height, 16, alpha ? PNG_COLOR_TYPE_GRAY_ALPHA : PNG_COLOR_TYPE_GRAY,
                  reinterpret_cast<const std::uint8_t*>(pixels.data()), row},
                 bytes))
        throw Error(ErrorCode::Io, path + ": libpng failed");
    writeWholeFile(path, bytes);
}

void writeImagePng(const std::string& path, int width, int height, int channels, int bits,
                   const std::vector<float>& values) {
    const double white = bits == 16 ? 65535 : 255;
    std::vector<std::uint8_t> pixels(values.size() * std::size_t(bits / 8));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto value = std::uint16_t(std::lround(double(std::clamp(values[i], 0.f, 1.f)) * white));
        if (bits == 16)
            std::memcpy(&pixels[2 * i], &value, 2);
        else
            pixels[i] = std::uint8_t(value);
    }
    std::string bytes;
    const std::size_t row = std::size_t(width) * std::size_t(channels) * std::size_t(bits / 8);
    if (!encoded({width, height, bits, channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
                  pixels.data(), row},
                 bytes))
        throw Error(ErrorCode::Io, path + ": libpng failed");
    writeWholeFile(path, bytes);
}

Raster readPng(const std::string& path, const std::string& content, const RasterReadOptions&,
               const RunContext& ctx) {
    Source source{content};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info) throw Error(ErrorCode::Memory, path + ": out of memory");
    Decoded image;
    bool good = false;
    try {
        good = decode(png, info, source, image, ctx);
    } catch (...) {
        png_destroy_read_struct(&png, &info, nullptr);
        throw;
    }
    png_destroy_read_struct(&png, &info, nullptr);
    if (!good) throw Error(ErrorCode::BadData, path + ": not a whole PNG image: " + source.failure);
    const bool alpha = image.channels == 2 || image.channels == 4;
    const int channels = image.channels >= 3 ? 3 : 1;
    Raster raster = makeRaster(path, image.width, image.height, 1, channels, ctx);
    raster.white = image.bits == 16 ? 65535 : 255;
    raster.rowsFromTop = true;
    const std::size_t count = raster.sampleCount();
    const std::size_t step = std::size_t(image.channels);
    const auto sample = [&](std::size_t i) {
        const png_byte* bytes = image.bytes.data();
        return image.bits == 16 ? float(bytes[2 * i] << 8 | bytes[2 * i + 1]) : float(bytes[i]);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const bool missing = alpha && sample(i * step + step - 1) == 0;
        for (std::size_t c = 0; c < std::size_t(channels); ++c)
            raster.values[i * std::size_t(channels) + c] = missing ? std::nanf("") : sample(i * step + c);
    }
    turnUpright(path, raster, exifOrientation(chunkNamed(content, "eXIf")), "EXIF orientation", ctx);
    return raster;
}

}  // namespace vdbsynth
