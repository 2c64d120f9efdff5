#include "libvdbsynth/io/readers/tiff/tiff_file.h"

#include "libvdbsynth/base/error.h"

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace vdbsynth {
namespace {

struct Source {
    const std::string& content;
    std::uint64_t at = 0;
};

tmsize_t readBytes(thandle_t handle, void* out, tmsize_t count) {
    Source& source = *static_cast<Source*>(handle);
    const std::uint64_t left = source.at < source.content.size() ? source.content.size() - source.at : 0;
    const std::uint64_t some = std::min<std::uint64_t>(left, std::uint64_t(std::max<tmsize_t>(count, 0)));
    if (some > 0) std::memcpy(out, source.content.data() + source.at, some);
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
    // Messages may quote the file.
    for (char& c : lastFailure)
        if (c < ' ' || c > '~') c = '?';
}

void readResolution(TIFF* file, TiffPage& page) {
    float across = 0, down = 0;
    if (TIFFGetField(file, TIFFTAG_XRESOLUTION, &across)) page.resolution[0] = double(across);
    if (TIFFGetField(file, TIFFTAG_YRESOLUTION, &down)) page.resolution[1] = double(down);
    TIFFGetFieldDefaulted(file, TIFFTAG_RESOLUTIONUNIT, &page.resolutionUnit);
}

void readPieces(TIFF* file, TiffPage& page) {
    if (TIFFIsTiled(file)) {
        TIFFGetField(file, TIFFTAG_TILEWIDTH, &page.pieceWidth);
        TIFFGetField(file, TIFFTAG_TILELENGTH, &page.pieceHeight);
    } else {
        page.pieceWidth = page.width;
        TIFFGetFieldDefaulted(file, TIFFTAG_ROWSPERSTRIP, &page.pieceHeight);
        page.pieceHeight = std::min(page.pieceHeight, page.height);
    }
    std::uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(file, TIFFTAG_COMPRESSION, &compression);
    page.compressed = compression != COMPRESSION_NONE;
    page.directoryOffset = TIFFCurrentDirOffset(file);
    page.dataOffset = TIFFGetStrileOffset(file, 0);
}

void readKind(TIFF* file, TiffPage& page) {
    std::uint32_t kind = 0;
    if (TIFFGetField(file, TIFFTAG_SUBFILETYPE, &kind)) {
        page.reduced = (kind & FILETYPE_REDUCEDIMAGE) != 0;
        page.mask = (kind & FILETYPE_MASK) != 0;
    }
}

TiffPage pageOf(TIFF* file) {
    TiffPage page;
    std::uint16_t number = SAMPLEFORMAT_UINT, colour = PHOTOMETRIC_MINISBLACK, planes = PLANARCONFIG_CONTIG,
                  orientation = ORIENTATION_TOPLEFT, extras = 0;
    std::uint16_t* kinds = nullptr;
    TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &page.width);
    TIFFGetField(file, TIFFTAG_IMAGELENGTH, &page.height);
    TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &page.bits);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &number);
    TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &planes);
    TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &colour);
    TIFFGetFieldDefaulted(file, TIFFTAG_ORIENTATION, &orientation);
    TIFFGetFieldDefaulted(file, TIFFTAG_EXTRASAMPLES, &extras, &kinds);
    page.number = TiffNumber(number);
    page.colour = TiffColour(colour);
    page.planes = planes == PLANARCONFIG_SEPARATE && page.samples > 1;
    page.orientation = orientation;
    if (kinds && extras > 0 && page.samples > 1)
        page.alpha =
            kinds[extras - 1] == EXTRASAMPLE_ASSOCALPHA || kinds[extras - 1] == EXTRASAMPLE_UNASSALPHA;
    readKind(file, page);
    readPieces(file, page);
    readResolution(file, page);
    return page;
}

// A tag unknown to libtiff: the file may use any type.
const void* valuesOf(TIFF* file, TiffTag tag, TIFFDataType type, std::uint32_t& count) {
    const TIFFField* field = TIFFFindField(file, std::uint32_t(tag), TIFF_ANY);
    const void* values = nullptr;
    count = 0;
    const bool good = field && TIFFFieldDataType(field) == type && TIFFFieldPassCount(field) &&
                      TIFFFieldReadCount(field) == TIFF_VARIABLE2 &&
                      TIFFGetField(file, std::uint32_t(tag), &count, &values);
    return good ? values : nullptr;
}

}  // namespace

bool TiffPage::matches(const TiffPage& o) const {
    return width == o.width && height == o.height && bits == o.bits && samples == o.samples &&
           number == o.number && colour == o.colour && planes == o.planes && alpha == o.alpha &&
           orientation == o.orientation;
}

struct TiffFile::Implementation {
    std::string path;
    Source source;
    std::unique_ptr<TIFF, void (*)(TIFF*)> file{nullptr, TIFFClose};
    std::vector<TiffPage> pages{};
};

TiffFile::TiffFile(const std::string& path, const std::string& content)
    : mImpl(new Implementation{path, Source{content}}) {
    TIFFSetErrorHandler(keepFailure);
    TIFFSetWarningHandler(nullptr);
    lastFailure.clear();
    mImpl->file.reset(TIFFClientOpen(path.c_str(), "rm", &mImpl->source, readBytes, writeBytes, seek,
                                     closeNothing, sizeOf, nullptr, nullptr));
    TIFF* file = mImpl->file.get();
    if (!file) throw Error(ErrorCode::BadData, path + ": not a TIFF image: " + lastFailure);
    do {
        mImpl->pages.push_back(pageOf(file));
        lastFailure.clear();
    } while (TIFFReadDirectory(file));
    // A page that cannot be read ends the file as its last page does, but for what libtiff says of it.
    if (!lastFailure.empty())
        throw Error(ErrorCode::BadData, path + ": truncated after page " +
                                            std::to_string(mImpl->pages.size()) + ": " + lastFailure);
}

TiffFile::~TiffFile() = default;

const std::vector<TiffPage>& TiffFile::pages() const {
    return mImpl->pages;
}

bool TiffFile::bigEndian() const {
    return TIFFIsBigEndian(mImpl->file.get()) != 0;
}

std::size_t TiffFile::fileBytes() const {
    return mImpl->source.content.size();
}

void TiffFile::select(std::size_t page) {
    // By its place in the file: by number libtiff would walk through all pages before it.
    if (!TIFFSetSubDirectory(mImpl->file.get(), mImpl->pages[page].directoryOffset)) fail();
}

std::string TiffFile::text(TiffTag tag) const {
    if (tag == TiffTag::Description) {
        const char* known = nullptr;
        return TIFFGetField(mImpl->file.get(), TIFFTAG_IMAGEDESCRIPTION, &known) && known ? known : "";
    }
    std::uint32_t count = 0;
    const char* values = static_cast<const char*>(valuesOf(mImpl->file.get(), tag, TIFF_ASCII, count));
    return values ? std::string(values, strnlen(values, count)) : std::string();
}

std::vector<double> TiffFile::reals(TiffTag tag) const {
    std::uint32_t count = 0;
    const double* values = static_cast<const double*>(valuesOf(mImpl->file.get(), tag, TIFF_DOUBLE, count));
    return values ? std::vector<double>(values, values + count) : std::vector<double>();
}

std::vector<std::uint16_t> TiffFile::shorts(TiffTag tag) const {
    std::uint32_t count = 0;
    const auto* values =
        static_cast<const std::uint16_t*>(valuesOf(mImpl->file.get(), tag, TIFF_SHORT, count));
    return values ? std::vector<std::uint16_t>(values, values + count) : std::vector<std::uint16_t>();
}

std::size_t TiffFile::pieceBytes() const {
    TIFF* file = mImpl->file.get();
    const tmsize_t bytes = TIFFIsTiled(file) ? TIFFTileSize(file) : TIFFStripSize(file);
    if (bytes <= 0) fail();
    return std::size_t(bytes);
}

std::size_t TiffFile::readPiece(std::uint32_t piece, char* out, std::size_t most) {
    TIFF* file = mImpl->file.get();
    const tmsize_t got = TIFFIsTiled(file) ? TIFFReadEncodedTile(file, piece, out, tmsize_t(most))
                                           : TIFFReadEncodedStrip(file, piece, out, tmsize_t(most));
    if (got < 0) fail();
    return std::size_t(got);
}

std::vector<std::uint32_t> TiffFile::readColours() {
    TIFF* file = mImpl->file.get();
    char reason[1024];
    if (!TIFFRGBAImageOK(file, reason))
        throw Error(ErrorCode::BadData,
                    mImpl->path + ": a kind of TIFF image that is not supported: " + reason);
    const TiffPage page = pageOf(file);
    std::vector<std::uint32_t> pixels(std::size_t(page.width) * page.height);
    // Asked for its own orientation, libtiff turns nothing: it cannot exchange rows and columns.
    if (!TIFFReadRGBAImageOriented(file, page.width, page.height, pixels.data(), page.orientation, 1)) fail();
    return pixels;
}

void TiffFile::fail() const {
    throw Error(ErrorCode::BadData,
                mImpl->path + ": not a whole TIFF image: " + (lastFailure.empty() ? "corrupt" : lastFailure));
}

}  // namespace vdbsynth
