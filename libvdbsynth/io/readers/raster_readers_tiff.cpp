#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"
#include "libvdbsynth/math/trigonometry.h"

#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <memory>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kPixelScale = 33550, kTiePoint = 33922, kGeoKeys = 34735, kNoData = 42113;

struct Source {
    const std::string& content;
    std::uint64_t at = 0;
};

tmsize_t readBytes(thandle_t handle, void* out, tmsize_t count) {
    Source& source = *static_cast<Source*>(handle);
    const std::uint64_t left = source.at < source.content.size() ? source.content.size() - source.at : 0;
    const std::uint64_t some = std::min<std::uint64_t>(left, std::uint64_t(std::max<tmsize_t>(count, 0)));
    std::memcpy(out, source.content.data() + source.at, some);
    source.at += some;
    return tmsize_t(some);
}
tmsize_t writeBytes(thandle_t, void*, tmsize_t) {
    return 0;
}
toff_t seek(thandle_t handle, toff_t offset, int from) {
    Source& source = *static_cast<Source*>(handle);
    source.at = (from == SEEK_CUR ? source.at : from == SEEK_END ? source.content.size() : 0) + offset;
    return source.at;
}
int closeNothing(thandle_t) {
    return 0;
}
toff_t sizeOf(thandle_t handle) {
    return static_cast<Source*>(handle)->content.size();
}

// libtiff has one handler for all files of the process; each thread stores its last message for our errors.
thread_local std::string lastFailure;
void keepFailure(const char*, const char* format, va_list arguments) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    lastFailure = text;
}

using File = std::unique_ptr<TIFF, void (*)(TIFF*)>;

struct Layout {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG;
    std::uint16_t photometric = PHOTOMETRIC_MINISBLACK, extras = 0;
    bool alpha = false;  // the last extra sample is the pixel's opacity
    bool stack = false;  // one of several pages: stored values are read, not displayed ones
    bool operator==(const Layout& o) const {
        return width == o.width && height == o.height && bits == o.bits && samples == o.samples &&
               format == o.format && planar == o.planar && photometric == o.photometric && extras == o.extras;
    }
};

Layout layoutOf(TIFF* file) {
    Layout layout;
    TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &layout.width);
    TIFFGetField(file, TIFFTAG_IMAGELENGTH, &layout.height);
    TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &layout.bits);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &layout.samples);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &layout.format);
    TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &layout.planar);
    TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &layout.photometric);
    std::uint16_t* kinds = nullptr;
    TIFFGetFieldDefaulted(file, TIFFTAG_EXTRASAMPLES, &layout.extras, &kinds);
    if (kinds && layout.extras > 0) {
        const std::uint16_t last = kinds[layout.extras - 1];
        layout.alpha = last == EXTRASAMPLE_ASSOCALPHA || last == EXTRASAMPLE_UNASSALPHA;
    }
    return layout;
}

// The type of a sample that is read as stored; false for packed bits and colours that libtiff must convert.
bool plainType(const Layout& layout, SampleType& type) {
    const bool grey = layout.photometric == PHOTOMETRIC_MINISBLACK ||
                      layout.photometric == PHOTOMETRIC_MINISWHITE ||
                      (layout.stack && layout.photometric == PHOTOMETRIC_PALETTE);
    if (!grey && layout.photometric != PHOTOMETRIC_RGB) return false;
    const bool real = layout.format == SAMPLEFORMAT_IEEEFP, integer = layout.format == SAMPLEFORMAT_INT;
    if (!real && !integer && layout.format != SAMPLEFORMAT_UINT && layout.format != SAMPLEFORMAT_VOID)
        return false;
    switch (layout.bits) {
        case 8:
            type = integer ? SampleType::I8 : SampleType::U8;
            return !real;
        case 16:
            type = real ? SampleType::F16 : integer ? SampleType::I16 : SampleType::U16;
            return true;
        case 32:
            type = real ? SampleType::F32 : integer ? SampleType::I32 : SampleType::U32;
            return true;
        case 64:
            type = real ? SampleType::F64 : integer ? SampleType::I64 : SampleType::U64;
            return true;
        default:
            return false;
    }
}

class PageReader {
public:
    PageReader(const std::string& path, TIFF* file, const RunContext& ctx)
        : mPath(path), mFile(file), mContext(ctx) {}

    // Channels that a page yields: three for an RGB image, else one.
    int channels(const Layout& layout) const {
        SampleType type{};
        if (!plainType(layout, type))
            return layout.photometric == PHOTOMETRIC_MINISBLACK ||
                           layout.photometric == PHOTOMETRIC_MINISWHITE
                       ? 1
                       : 3;
        return layout.photometric == PHOTOMETRIC_RGB && layout.samples >= 3 ? 3 : 1;
    }
    void read(const Layout& layout, int channels, float* out) {
        SampleType type{};
        if (plainType(layout, type))
            readPlain(layout, type, channels, out);
        else
            readConverted(layout, channels, out);
    }

private:
    [[noreturn]] void fail() const {
        throw Error(ErrorCode::BadData,
                    mPath + ": not a whole TIFF image: " + (lastFailure.empty() ? "corrupt" : lastFailure));
    }

    // Copies the part of a decoded strip or tile that lies within the page.
    void place(const Layout& layout, SampleType type, int channels, const char* bytes, std::size_t got,
               Index3 at, Index3 size, int plane, float* out) const {
        const std::size_t stored = layout.planar == PLANARCONFIG_CONTIG ? layout.samples : 1;
        std::vector<float> row(std::size_t(size.x) * stored);
        const bool whiteIsZero = layout.photometric == PHOTOMETRIC_MINISWHITE && whiteOf(type) > 0;
        for (int y = 0; y < size.y && at.y + y < int(layout.height); ++y) {
            const std::size_t offset = std::size_t(y) * row.size() * bytesOf(type);
            if (offset + row.size() * bytesOf(type) > got) fail();
            toFloats(bytes + offset, row.size(), type, false, row.data());
            for (int x = 0; x < size.x && at.x + x < int(layout.width); ++x) {
                float* pixel = out + (std::size_t(at.y + y) * layout.width + std::size_t(at.x + x)) *
                                         std::size_t(channels);
                const float* from = &row[std::size_t(x) * stored];
                if (stored == 1 && plane < channels) pixel[plane] = from[0];
                for (std::size_t c = 0; stored > 1 && c < std::size_t(channels); ++c) pixel[c] = from[c];
                for (int c = 0; whiteIsZero && c < channels; ++c)
                    if (stored > 1 || c == plane) pixel[c] = float(whiteOf(type)) - pixel[c];
                // A transparent pixel has no data; opacity in a separate plane is ignored.
                if (stored > std::size_t(channels) && layout.alpha && from[stored - 1] == 0)
                    for (int c = 0; c < channels; ++c) pixel[c] = std::nanf("");
            }
        }
    }

    void readPlain(const Layout& layout, SampleType type, int channels, float* out) {
        const bool tiled = TIFFIsTiled(mFile) != 0;
        std::uint32_t width = layout.width, height = layout.height;
        if (tiled) {
            TIFFGetField(mFile, TIFFTAG_TILEWIDTH, &width);
            TIFFGetField(mFile, TIFFTAG_TILELENGTH, &height);
        } else {
            TIFFGetFieldDefaulted(mFile, TIFFTAG_ROWSPERSTRIP, &height);
            height = std::min(height, layout.height);
        }
        const tmsize_t most = tiled ? TIFFTileSize(mFile) : TIFFStripSize(mFile);
        if (width == 0 || height == 0 || width > 1 << 24 || height > 1 << 24 || most <= 0) fail();
        requireMemory(mContext, double(most), mPath + ": a strip", "store it in smaller ones");
        std::vector<char> bytes(static_cast<std::size_t>(most));
        const std::uint32_t across = (layout.width + width - 1) / width,
                            down = (layout.height + height - 1) / height;
        const std::uint32_t planes = layout.planar == PLANARCONFIG_SEPARATE ? layout.samples : 1;
        // libtiff counts pieces in 32 bits.
        if (!productFits({across, down, planes}, 0xffffffffu)) fail();
        for (std::uint32_t plane = 0; plane < planes; ++plane)
            for (std::uint32_t i = 0; i < across * down; ++i) {
                const std::uint32_t number = plane * across * down + i;
                const tmsize_t got = tiled ? TIFFReadEncodedTile(mFile, number, bytes.data(), most)
                                           : TIFFReadEncodedStrip(mFile, number, bytes.data(), most);
                if (got < 0) fail();
                const Index3 at{int(i % across * width), int(i / across * height), 0};
                const int rows = tiled ? int(height) : std::min(int(height), int(layout.height) - at.y);
                place(layout, type, channels, bytes.data(), std::size_t(got), at, {int(width), rows, 1},
                      int(plane), out);
            }
    }

    // For a stack of few bits the stored numbers: libtiff spreads them to 255.
    static float unscaled(float value, const Layout& layout) {
        if (!layout.stack || layout.bits >= 8) return value;
        return std::round(value * float((1 << layout.bits) - 1) / 255);
    }

    // Palettes, packed bits, JPEG inside TIFF and similar: libtiff converts to 8-bit colours.
    void readConverted(const Layout& layout, int channels, float* out) {
        char reason[1024];
        if (!TIFFRGBAImageOK(mFile, reason))
            throw Error(ErrorCode::BadData,
                        mPath + ": a kind of TIFF image that is not supported: " + reason);
        const std::size_t count = std::size_t(layout.width) * layout.height;
        std::vector<std::uint32_t> pixels(count);
        if (!TIFFReadRGBAImageOriented(mFile, layout.width, layout.height, pixels.data(), ORIENTATION_TOPLEFT,
                                       1))
            fail();
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < channels; ++c)
                out[i * std::size_t(channels) + std::size_t(c)] =
                    unscaled(float(pixels[i] >> (8 * c) & 255), layout);
    }

    const std::string& mPath;
    TIFF* mFile;
    const RunContext& mContext;
};

// The values of a tag unknown to libtiff, null unless they are of this type: a file may use any type.
const void* valuesOf(TIFF* file, std::uint32_t tag, TIFFDataType type, std::uint32_t& count) {
    const TIFFField* field = TIFFFindField(file, tag, TIFF_ANY);
    const void* values = nullptr;
    count = 0;
    const bool good = field && TIFFFieldDataType(field) == type && TIFFFieldPassCount(field) &&
                      TIFFFieldReadCount(field) == TIFF_VARIABLE2 && TIFFGetField(file, tag, &count, &values);
    return good ? values : nullptr;
}

// GDAL's text for the no-data value.
void dropNoData(TIFF* file, Raster& raster) {
    std::uint32_t count = 0;
    const char* text = static_cast<const char*>(valuesOf(file, kNoData, TIFF_ASCII, count));
    if (!text || count == 0) return;
    std::string word(text, strnlen(text, count));
    while (!word.empty() && word.back() == ' ') word.pop_back();
    float value = 0;
    if (!parseAnyReal(word, value)) return;
    for (float& sample : raster.values)
        if (sample == value) sample = std::nanf("");
}

// GeoTIFF: the size of a pixel, in metres; degrees become metres at the image's middle.
void readGeography(TIFF* file, Raster& raster) {
    std::uint32_t count = 0;
    const double* scale = static_cast<const double*>(valuesOf(file, kPixelScale, TIFF_DOUBLE, count));
    if (!scale || count < 2 || !(scale[0] > 0) || !(scale[1] > 0)) return;
    raster.spacing = {scale[0], scale[1], 1};
    raster.knownSpacing = true;
    bool degrees = false;
    if (const auto* keys = static_cast<const std::uint16_t*>(valuesOf(file, kGeoKeys, TIFF_SHORT, count)))
        for (std::uint32_t i = 4; i + 3 < count; i += 4)
            degrees = degrees || (keys[i] == 1024 && keys[i + 3] == 2);
    if (!degrees) return;
    double latitude = 0;
    const double* tie = static_cast<const double*>(valuesOf(file, kTiePoint, TIFF_DOUBLE, count));
    if (tie && count >= 6) latitude = tie[4] - (raster.size.y / 2.0 - tie[1]) * scale[1];
    constexpr double kMetresPerDegree = 111320, kRadians = 3.14159265358979323846 / 180;
    const double narrowing = std::abs(latitude) < 89 ? cosine(latitude * kRadians) : 1;
    raster.spacing = {scale[0] * kMetresPerDegree * narrowing, scale[1] * kMetresPerDegree, 1};
    raster.unit = "m";
}

// ImageJ writes stacks over 4 GB as one page followed by the others, which TIFF does not record.
void refuseContiguousStack(TIFF* file, const std::string& path) {
    const char* text = nullptr;
    if (!TIFFGetField(file, TIFFTAG_IMAGEDESCRIPTION, &text) || !text) return;
    const std::string words = text;
    const std::size_t images = words.find("images=");
    if (words.compare(0, 7, "ImageJ=") != 0 || images == std::string::npos) return;
    const std::size_t number = images + 7, end = words.find_first_not_of("0123456789", number);
    int count = 0;
    const bool several = parseWhole(words.substr(number, end - number), count) && count > 1 &&
                         TIFFNumberOfDirectories(file) == 1;
    if (several)
        throw Error(ErrorCode::BadData, path +
                                            ": is an ImageJ stack with one page and raw slices behind it; "
                                            "save it as npy or in several files");
}

int countPages(TIFF* file, const Layout& first, const std::string& path) {
    int pages = 1;
    lastFailure.clear();
    while (TIFFReadDirectory(file)) {
        const Layout layout = layoutOf(file);
        std::uint32_t kind = 0;
        TIFFGetField(file, TIFFTAG_SUBFILETYPE, &kind);
        if (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) continue;  // a preview or a mask of the first
        if (!(layout == first))
            throw Error(ErrorCode::BadData,
                        path + ": its pages differ in size or kind; a stack needs equal pages");
        if (++pages >= 65535) break;
        lastFailure.clear();
    }
    // A page that cannot be read ends the file as its last page does, but for what libtiff says of it.
    if (!lastFailure.empty())
        throw Error(ErrorCode::BadData,
                    path + ": truncated after page " + std::to_string(pages) + ": " + lastFailure);
    return pages;
}

}  // namespace

Raster readTiff(const std::string& path, const std::string& content, const RasterReadOptions&,
                const RunContext& ctx) {
    TIFFSetErrorHandler(keepFailure);
    TIFFSetWarningHandler(nullptr);
    lastFailure.clear();
    Source source{content};
    const File file(TIFFClientOpen(path.c_str(), "rm", &source, readBytes, writeBytes, seek, closeNothing,
                                   sizeOf, nullptr, nullptr),
                    TIFFClose);
    if (!file) throw Error(ErrorCode::BadData, path + ": not a TIFF image: " + lastFailure);
    Layout layout = layoutOf(file.get());
    if (layout.samples == 0) throw Error(ErrorCode::BadData, path + ": has no samples");
    refuseContiguousStack(file.get(), path);
    const int pages = countPages(file.get(), layout, path);
    layout.stack = pages > 1;
    PageReader reader(path, file.get(), ctx);
    const int channels = reader.channels(layout);
    // The strongest TIFF compression gives a thousandth.
    const double bytes = double(layout.width) * layout.height * layout.bits / 8 * pages;
    if (bytes > 4000.0 * double(content.size()) + 1e6) throw Error(ErrorCode::BadData, path + ": truncated");
    Raster raster = makeRaster(path, layout.width, layout.height, pages, channels, ctx);
    raster.rowsFromTop = pages == 1;
    raster.stack = pages > 1;
    SampleType type{};
    raster.white = plainType(layout, type) ? whiteOf(type) : 255;
    const std::size_t page = std::size_t(layout.width) * layout.height * std::size_t(channels);
    TIFFSetDirectory(file.get(), 0);
    readGeography(file.get(), raster);
    for (int done = 0; done < pages; TIFFReadDirectory(file.get())) {
        std::uint32_t kind = 0;
        TIFFGetField(file.get(), TIFFTAG_SUBFILETYPE, &kind);
        if (done > 0 && kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) continue;
        throwIfCancelled(ctx);
        reader.read(layout, channels, raster.values.data() + page * std::size_t(done));
        ++done;
    }
    TIFFSetDirectory(file.get(), 0);
    dropNoData(file.get(), raster);
    return raster;
}

}  // namespace vdbsynth
