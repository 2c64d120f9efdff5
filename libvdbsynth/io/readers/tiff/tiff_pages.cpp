#include "libvdbsynth/io/readers/tiff/tiff_pages.h"

#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// The type of samples of whole bytes; false if there is none.
bool plainType(const TiffPage& page, SampleType& type) {
    const bool real = page.number == TiffNumber::Real, isSigned = page.number == TiffNumber::Signed;
    switch (page.bits) {
        case 8:
            type = isSigned ? SampleType::I8 : SampleType::U8;
            return !real;
        case 16:
            type = real ? SampleType::F16 : isSigned ? SampleType::I16 : SampleType::U16;
            return true;
        case 32:
            type = real ? SampleType::F32 : isSigned ? SampleType::I32 : SampleType::U32;
            return true;
        case 64:
            type = real ? SampleType::F64 : isSigned ? SampleType::I64 : SampleType::U64;
            return true;
        default:
            return false;
    }
}

void toNumbers(const TiffPage& page, const char* bytes, std::size_t count, bool swap, float* out) {
    SampleType type{};
    if (plainType(page, type))
        toFloats(bytes, count, type, swap, out);
    else
        unpackBits(bytes, count, page.bits, page.number == TiffNumber::Signed, out);
}

// Where a decoded strip or tile lies.
struct Piece {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    std::size_t plane = 0;
};

class PageReader {
public:
    PageReader(const TiffPage& page, const TiffSamples& samples, float* out)
        : mPage(page), mSamples(samples), mOut(out) {}

    std::size_t rowBytes(std::uint32_t width) const {
        return (std::size_t(width) * (mPage.planes ? 1 : mPage.samples) * mPage.bits + 7) / 8;
    }
    bool wantsPlane(std::size_t plane) const {
        const std::size_t end = mSamples.first + std::size_t(mSamples.channels);
        return (plane >= mSamples.first && plane < end) || (mPage.alpha && plane + 1 == mPage.samples);
    }

    // Copies the part within the page. @return false if there are too few bytes
    bool place(const Piece& piece, const char* bytes, std::size_t size, bool swap) const {
        const std::size_t stored = mPage.planes ? 1 : mPage.samples, step = rowBytes(piece.width);
        std::vector<float> row(std::size_t(piece.width) * stored);
        for (std::uint32_t y = 0; y < piece.height && piece.y + y < mPage.height; ++y) {
            if ((y + 1) * step > size) return false;
            toNumbers(mPage, bytes + y * step, row.size(), swap, row.data());
            for (std::uint32_t x = 0; x < piece.width && piece.x + x < mPage.width; ++x)
                placePixel(&row[x * stored], piece.plane,
                           mOut + (std::size_t(piece.y + y) * mPage.width + piece.x + x) *
                                      std::size_t(mSamples.channels));
        }
        return true;
    }

private:
    void placePixel(const float* from, std::size_t plane, float* pixel) const {
        const std::size_t channels = std::size_t(mSamples.channels);
        bool transparent = false;
        if (mPage.planes) {
            if (plane >= mSamples.first && plane < mSamples.first + channels)
                pixel[plane - mSamples.first] = from[0];
            transparent = mPage.alpha && plane + 1 == mPage.samples && from[0] == 0;
        } else {
            std::copy_n(from + mSamples.first, channels, pixel);
            transparent = mPage.alpha && from[mPage.samples - 1u] == 0;
        }
        if (transparent) std::fill_n(pixel, channels, std::nanf(""));
    }

    const TiffPage& mPage;
    const TiffSamples& mSamples;
    float* mOut;
};

void readStored(const std::string& path, TiffFile& file, const TiffPage& page, const TiffSamples& samples,
                const RunContext& ctx, float* out) {
    constexpr std::uint32_t kMost = 1 << 24;
    const std::uint32_t width = page.pieceWidth, height = page.pieceHeight;
    if (width == 0 || height == 0 || width > kMost || height > kMost) file.fail();
    const std::size_t most = file.pieceBytes();
    requireMemory(ctx, double(most), path + ": a strip", "store it in smaller ones");
    std::vector<char> bytes(most);
    const std::uint32_t across = (page.width + width - 1) / width, down = (page.height + height - 1) / height;
    const std::uint32_t planes = page.planes ? page.samples : 1;
    // libtiff counts pieces in 32 bits.
    if (!productFits({across, down, planes}, 0xffffffffu)) file.fail();
    const PageReader reader(page, samples, out);
    for (std::uint32_t plane = 0; plane < planes; ++plane) {
        if (page.planes && !reader.wantsPlane(plane)) continue;
        for (std::uint32_t i = 0; i < across * down; ++i) {
            const std::size_t got = file.readPiece(plane * across * down + i, bytes.data(), most);
            Piece piece{i % across * width, i / across * height, width, height, plane};
            piece.height = std::min(height, page.height - piece.y);
            if (!reader.place(piece, bytes.data(), got, false)) file.fail();
        }
    }
}

void readConverted(TiffFile& file, const TiffSamples& samples, float* out) {
    for (const std::uint32_t pixel : file.readColours())
        for (int c = 0; c < samples.channels; ++c) *out++ = float(pixel >> (8 * c) & 255);
}

}  // namespace

bool isStored(const TiffPage& page, bool stack) {
    const bool grey = page.colour == TiffColour::BlackIsZero || page.colour == TiffColour::WhiteIsZero ||
                      page.colour == TiffColour::Mask || (stack && page.colour == TiffColour::Palette);
    if (!grey && page.colour != TiffColour::Rgb) return false;
    SampleType type{};
    switch (page.number) {
        case TiffNumber::Real:
            return plainType(page, type);
        case TiffNumber::Unsigned:
        case TiffNumber::Signed:
        case TiffNumber::Untyped:
            return (page.bits >= 1 && page.bits <= 32) || page.bits == 64;
        default:
            return false;
    }
}

std::size_t dataSamples(const TiffPage& page) {
    return page.samples - (page.alpha ? 1u : 0u);
}

double whiteOf(const TiffPage& page, bool stack) {
    if (!isStored(page, stack)) return 255;
    const bool painted = page.number == TiffNumber::Unsigned || page.number == TiffNumber::Untyped;
    return painted && page.bits <= 16 ? double((1 << page.bits) - 1) : 0;
}

void unpackBits(const char* bytes, std::size_t count, int bits, bool isSigned, float* out) {
    const auto byte = [&](std::size_t i) { return std::uint64_t(static_cast<unsigned char>(bytes[i])); };
    const double half = std::ldexp(1.0, bits - 1);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t value = 0;
        if (bits == 24) {
            value = byte(3 * i) | byte(3 * i + 1) << 8 | byte(3 * i + 2) << 16;
        } else {
            const std::size_t begin = i * std::size_t(bits), end = begin + std::size_t(bits);
            for (std::size_t at = begin / 8; at * 8 < end; ++at) value = value << 8 | byte(at);
            value = value >> ((8 - end % 8) % 8) & ((std::uint64_t(1) << bits) - 1);
        }
        const double number = double(value);
        out[i] = float(isSigned && number >= half ? number - 2 * half : number);
    }
}

void readTiffPage(const std::string& path, TiffFile& file, const TiffPage& page, const TiffSamples& samples,
                  bool stack, const RunContext& ctx, float* out) {
    if (isStored(page, stack))
        readStored(path, file, page, samples, ctx, out);
    else
        readConverted(file, samples, out);
}

void readRawPage(const std::string& path, const TiffFile& file, const TiffPage& page,
                 const TiffSamples& samples, const std::string& content, std::uint64_t offset, float* out) {
    const PageReader reader(page, samples, out);
    const Piece all{0, 0, page.width, page.height, 0};
    if (offset > content.size() ||
        !reader.place(all, content.data() + offset, content.size() - std::size_t(offset), file.bigEndian()))
        throw Error(ErrorCode::BadData, path + ": truncated: its slices end early");
}

}  // namespace vdbsynth
