// VTK ImageData in XML.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <pugixml.hpp>

#include <algorithm>
#include <map>

namespace vdbsynth {
namespace {

// Data encoding from the file's root element.
struct Encoding {
    bool swap = false, compressed = false, wideHeader = false;
    std::string appended;  // raw or still base64
    bool appendedBase64 = false;
};

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": " + what);
}

// Decodes base64 to its end, to padding or to `most` bytes. @return the number of characters used
std::size_t decodeBase64(const std::string& path, const std::string& text, std::size_t at, std::size_t most,
                         std::string& bytes) {
    const std::size_t start = at;
    std::uint32_t bits = 0;
    int have = 0;
    for (; at < text.size() && bytes.size() < most; ++at) {
        const char c = text[at];
        int value = 0;
        if (c >= 'A' && c <= 'Z')
            value = c - 'A';
        else if (c >= 'a' && c <= 'z')
            value = c - 'a' + 26;
        else if (c >= '0' && c <= '9')
            value = c - '0' + 52;
        else if (c == '+')
            value = 62;
        else if (c == '/')
            value = 63;
        else if (c == '=' || c == ' ' || c == '\n' || c == '\r' || c == '\t')
            continue;
        else
            refuse(path, "its base64 is invalid");
        bits = bits << 6 | std::uint32_t(value);
        have += 6;
        if (have < 8) continue;
        have -= 8;
        bytes += char(bits >> have & 255);
    }
    return at - start;
}

// A block of binary data as stored in the file: a header of sizes, then bytes, perhaps in compressed pieces.
class BlockReader {
public:
    BlockReader(const std::string& path, const Encoding& encoding, const std::string& text, std::size_t at,
                bool base64)
        : mPath(path), mEncoding(encoding), mText(text), mAt(at), mBase64(base64) {}

    std::string read(std::size_t expected) {
        const std::size_t word = mEncoding.wideHeader ? 8 : 4;
        if (!mEncoding.compressed) {
            // Header and data are one run of base64.
            const std::string bytes = take(word + expected);
            if (number(bytes, 0) < expected) truncated();
            return bytes.substr(word);
        }
        std::string header = peek(3 * word);
        const std::uint64_t blocks = number(header, 0), size = number(header, 1), last = number(header, 2);
        if (blocks > mText.size() / word || size > 4000ull * mText.size() + 1000000) truncated();
        header = take((3 + std::size_t(blocks)) * word);
        finishRun();
        std::size_t packed = 0;
        for (std::size_t i = 0; i < blocks; ++i)
            packed += std::size_t(std::min<std::uint64_t>(number(header, 3 + i), mText.size()));
        const std::string bytes = take(packed);
        std::string all;
        std::size_t from = 0;
        for (std::size_t i = 0; i < blocks; ++i) {
            const std::size_t length = std::size_t(number(header, 3 + i));
            const std::size_t made = std::size_t(i + 1 == blocks && last > 0 ? last : size);
            all += inflateZlib(mPath, bytes.substr(from, length), made);
            from += length;
        }
        if (all.size() < expected) truncated();
        return all;
    }

private:
    [[noreturn]] void truncated() const {
        refuse(mPath, "truncated, or its data array is smaller than its extent");
    }
    std::uint64_t number(const std::string& bytes, std::size_t index) const {
        const std::size_t word = mEncoding.wideHeader ? 8 : 4;
        std::uint64_t value = 0;
        if ((index + 1) * word > bytes.size()) truncated();
        std::string raw = bytes.substr(index * word, word);
        if (mEncoding.swap) std::reverse(raw.begin(), raw.end());
        std::memcpy(&value, raw.data(), word);
        return value;
    }
    std::string peek(std::size_t count) {
        const std::size_t at = mAt;
        std::string bytes = take(count);
        mAt = at;
        return bytes;
    }
    std::string take(std::size_t count) {
        std::string bytes;
        if (count > mText.size()) truncated();
        if (mBase64) {
            mAt += decodeBase64(mPath, mText, mAt, count, bytes);
        } else if (mAt <= mText.size() && count <= mText.size() - mAt) {
            bytes = mText.substr(mAt, count);
            mAt += count;
        }
        if (bytes.size() < count) truncated();
        return bytes;
    }
    // A run of base64 ends with its padding.
    void finishRun() {
        while (mBase64 && mAt < mText.size() && mText[mAt] == '=') ++mAt;
    }

    const std::string& mPath;
    const Encoding& mEncoding;
    const std::string& mText;
    std::size_t mAt;
    bool mBase64;
};

SampleType typeOf(const std::string& path, const std::string& name) {
    static const std::map<std::string, SampleType> types{
        {"UInt8", SampleType::U8},   {"Int8", SampleType::I8},    {"UInt16", SampleType::U16},
        {"Int16", SampleType::I16},  {"UInt32", SampleType::U32}, {"Int32", SampleType::I32},
        {"UInt64", SampleType::U64}, {"Int64", SampleType::I64},  {"Float32", SampleType::F32},
        {"Float64", SampleType::F64}};
    const auto found = types.find(name);
    if (found == types.end()) refuse(path, "its data is of type " + name + ", which is not supported");
    return found->second;
}

// Raw appended data is not XML: it is cut out before the rest is parsed.
std::string cutAppended(const std::string& content, Encoding& encoding) {
    const std::size_t tag = content.find("<AppendedData");
    if (tag == std::string::npos) return content;
    const std::size_t open = content.find('>', tag),
                      mark = open == std::string::npos ? open : content.find('_', open);
    if (mark == std::string::npos) return content;
    encoding.appendedBase64 = content.substr(tag, open - tag).find("base64") != std::string::npos;
    std::size_t end = content.rfind("</AppendedData>");
    if (end == std::string::npos || end < mark) end = content.size();
    encoding.appended = content.substr(mark + 1, end - mark - 1);
    return content.substr(0, mark) +
           (end < content.size() ? content.substr(end) : "</AppendedData></VTKFile>");
}

std::vector<double> numbersOf(const char* text) {
    std::vector<double> numbers;
    std::string rest = text;
    std::size_t at = 0;
    while ((at = rest.find_first_not_of(" \t\n\r", at)) != std::string::npos) {
        const std::size_t end = std::min(rest.find_first_of(" \t\n\r", at), rest.size());
        float value = 0;
        if (!parseAnyReal(std::string_view(rest).substr(at, end - at), value)) return {};
        numbers.push_back(double(value));
        at = end;
    }
    return numbers;
}

// The array of scalars that the file marks, else its first; of the points, else of the cells.
pugi::xml_node chooseArray(const std::string& path, const pugi::xml_node& piece, bool& cells) {
    for (const char* kind : {"PointData", "CellData"}) {
        const pugi::xml_node data = piece.child(kind);
        cells = std::string(kind) == "CellData";
        const pugi::xml_node marked =
            data.find_child_by_attribute("DataArray", "Name", data.attribute("Scalars").as_string(""));
        if (marked) return marked;
        if (data.child("DataArray")) return data.child("DataArray");
    }
    refuse(path, "has no data array");
}

void readArray(const std::string& path, const pugi::xml_node& array, const Encoding& encoding,
               Raster& raster) {
    const std::string format = array.attribute("format").as_string("ascii");
    const SampleType type = typeOf(path, array.attribute("type").as_string());
    raster.white = whiteOf(type);
    if (array.attribute("NumberOfComponents").as_int(1) != 1)
        refuse(path, "holds vectors; one value a point is read");
    const std::string text = array.text().as_string();
    const std::size_t expected = raster.values.size() * bytesOf(type);
    if (format == "ascii") {
        TextScanner scanner(path, text, '\0');
        for (float& value : raster.values) value = float(scanner.real());
        return;
    }
    std::string bytes;
    if (format == "appended") {
        const std::size_t at = std::size_t(array.attribute("offset").as_ullong(0));
        bytes = BlockReader(path, encoding, encoding.appended, at, encoding.appendedBase64).read(expected);
    } else {
        bytes = BlockReader(path, encoding, text, 0, true).read(expected);
    }
    toFloats(bytes.data(), raster.values.size(), type, encoding.swap, raster.values.data());
}

}  // namespace

Raster readVti(const std::string& path, const std::string& content, const RasterReadOptions&,
               const RunContext& ctx) {
    Encoding encoding;
    const std::string xml = cutAppended(content, encoding);
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
    if (!parsed) refuse(path, std::string("not a whole XML file: ") + parsed.description());
    const pugi::xml_node root = document.child("VTKFile"), image = root.child("ImageData"),
                         piece = image.child("Piece");
    if (!piece) refuse(path, "not a VTK image (VTKFile, ImageData, Piece)");
    if (piece.next_sibling("Piece")) refuse(path, "is in several pieces; write it as one");
    const std::string compressor = root.attribute("compressor").as_string();
    encoding.compressed = !compressor.empty();
    if (encoding.compressed && compressor != "vtkZLibDataCompressor")
        refuse(path, "is compressed with " + compressor + "; only zlib is supported");
    encoding.swap = std::string(root.attribute("byte_order").as_string()) == "BigEndian";
    encoding.wideHeader = std::string(root.attribute("header_type").as_string()) == "UInt64";
    const std::vector<double> extent =
        numbersOf(piece.attribute("Extent").as_string(image.attribute("WholeExtent").as_string()));
    if (extent.size() != 6) refuse(path, "its Extent is not six numbers");
    bool cells = false;
    const pugi::xml_node array = chooseArray(path, piece, cells);
    std::int64_t sides[3];
    for (std::size_t i = 0; i < 3; ++i)
        sides[i] = std::int64_t(std::clamp(extent[2 * i + 1] - extent[2 * i] + (cells ? 0 : 1), -1e15, 1e15));
    // Text or bytes of a sample; zlib reduces these to a thousandth at best.
    if (!productFits({sides[0], sides[1], sides[2]}, (encoding.compressed ? 1100 : 1) * content.size()))
        refuse(path, "truncated, or its Extent is empty");
    Raster raster = makeRaster(path, sides[0], sides[1], sides[2], 1, ctx);
    raster.stack = true;
    const std::vector<double> spacing = numbersOf(image.attribute("Spacing").as_string("1 1 1")),
                              origin = numbersOf(image.attribute("Origin").as_string("0 0 0"));
    if (spacing.size() != 3 || origin.size() != 3)
        refuse(path, "its Spacing and Origin must be three numbers each");
    raster.knownSpacing = true;
    for (int axis = 0; axis < 3; ++axis) {
        raster.spacing[axis] = spacing[std::size_t(axis)];
        raster.origin[axis] = origin[std::size_t(axis)] +
                              raster.spacing[axis] * (extent[std::size_t(2 * axis)] + (cells ? 0.5 : 0));
    }
    readArray(path, array, encoding, raster);
    return raster;
}

}  // namespace vdbsynth
