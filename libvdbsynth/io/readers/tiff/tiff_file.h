#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

// Numbers of the TIFF specification.
enum class TiffTag : std::uint32_t {
    Description = 270,
    PixelScale = 33550,
    TiePoint = 33922,
    Transformation = 34264,
    GeoKeys = 34735,
    NoData = 42113
};
enum class TiffColour : std::uint16_t { WhiteIsZero = 0, BlackIsZero = 1, Rgb = 2, Palette = 3, Mask = 4 };
enum class TiffNumber : std::uint16_t { Unsigned = 1, Signed = 2, Real = 3, Untyped = 4 };

// One page of a TIFF file as its tags describe it. The enums may have values without a name.
struct TiffPage {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 1, samples = 1;
    TiffNumber number = TiffNumber::Unsigned;
    TiffColour colour = TiffColour::BlackIsZero;
    bool planes = false;                 // samples are stored one plane after the other
    bool alpha = false;                  // the last sample is the pixel's opacity
    bool reduced = false, mask = false;  // a smaller copy of another page; the opacity of another page
    bool compressed = false;
    int orientation = 1;
    std::uint32_t pieceWidth = 0, pieceHeight = 0;  // of a strip or tile
    std::uint64_t directoryOffset = 0,
                  dataOffset = 0;      // in the file, of the tags and the first strip or tile
    double resolution[2] = {0, 0};     // pixels per unit; 0: unknown
    std::uint16_t resolutionUnit = 1;  // 1 none, 2 inch, 3 centimetre

    // Pages of one stack: the same size and kind.
    bool matches(const TiffPage& other) const;
};

// The only door to libtiff. One file in memory, one selected page.
class TiffFile {
public:
    // Reads all directories. The content is borrowed. @throw Error BadData (not a TIFF, a page that cannot be
    // read)
    TiffFile(const std::string& path, const std::string& content);
    ~TiffFile();
    TiffFile(const TiffFile&) = delete;
    TiffFile& operator=(const TiffFile&) = delete;

    const std::vector<TiffPage>& pages() const;
    bool bigEndian() const;
    std::size_t fileBytes() const;

    // Selects a page, for all below. @throw Error BadData
    void select(std::size_t page);
    // Values of a tag, empty where it is missing or of another type.
    std::string text(TiffTag tag) const;
    std::vector<double> reals(TiffTag tag) const;
    std::vector<std::uint16_t> shorts(TiffTag tag) const;
    // Bytes that a decoded strip or tile takes. @throw Error BadData (none)
    std::size_t pieceBytes() const;
    // Decodes a strip or tile, in the machine's byte order. @return bytes written  @throw Error BadData
    std::size_t readPiece(std::uint32_t piece, char* out, std::size_t most);
    // All pixels as 8-bit colours, red in the lowest byte, rows as stored: what libtiff makes of palettes,
    // YCbCr and other colours. @throw Error BadData (a kind it does not convert; corrupt)
    std::vector<std::uint32_t> readColours();
    // @throw Error BadData that says what libtiff said last
    [[noreturn]] void fail() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> mImpl;
};

}  // namespace vdbsynth
