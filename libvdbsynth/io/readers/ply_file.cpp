#include "libvdbsynth/io/readers/ply_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbsynth {
namespace {

std::string lowerCase(std::string_view word) {
    std::string lower(word);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

std::size_t sizeOf(PlyType type) {
    static const std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[std::size_t(type)];
}

bool typeOf(std::string_view word, PlyType& type) {
    static const std::pair<const char*, PlyType> names[] = {
        {"char", PlyType::Int8},     {"int8", PlyType::Int8},     {"uchar", PlyType::UInt8},
        {"uint8", PlyType::UInt8},   {"short", PlyType::Int16},   {"int16", PlyType::Int16},
        {"ushort", PlyType::UInt16}, {"uint16", PlyType::UInt16}, {"int", PlyType::Int32},
        {"int32", PlyType::Int32},   {"uint", PlyType::UInt32},   {"uint32", PlyType::UInt32},
        {"int64", PlyType::Int64},   {"uint64", PlyType::UInt64}, {"float", PlyType::Float},
        {"float32", PlyType::Float}, {"double", PlyType::Double}, {"float64", PlyType::Double},
        {"byte", PlyType::Int8},     {"ubyte", PlyType::UInt8}};
    std::string name = lowerCase(word);
    if (name.size() > 2 && name.compare(name.size() - 2, 2, "_t") == 0) name.resize(name.size() - 2);
    for (const auto& [text, value] : names)
        if (name == text) {
            type = value;
            return true;
        }
    return false;
}

PlyProperty readProperty(TextScanner& scanner) {
    PlyProperty property;
    std::string_view word = scanner.wordOnLine();
    if (word == "list") {
        property.list = true;
        if (!typeOf(scanner.wordOnLine(), property.count)) scanner.fail("unknown type of a list's length");
        word = scanner.wordOnLine();
    }
    if (!typeOf(word, property.value))
        scanner.fail("unknown property type \"" + std::string(word.substr(0, 40)) + "\"");
    property.name = std::string(scanner.wordOnLine());
    return property;
}

PlyEncoding readEncoding(TextScanner& scanner) {
    const std::string_view word = scanner.wordOnLine();
    const std::string name = lowerCase(word);
    if (name == "ascii") return PlyEncoding::Ascii;
    if (name == "binary_little_endian") return PlyEncoding::Little;
    if (name == "binary_big_endian") return PlyEncoding::Big;
    scanner.fail("unknown format \"" + std::string(word.substr(0, 40)) +
                 "\"; known are ascii, binary_little_endian and binary_big_endian");
}

// Behind "end_header". Where lines end in CR alone, an LF behind the last one is the first byte of the body.
std::size_t bodyBegin(const std::string& content, std::size_t at) {
    const std::size_t first = content.find_first_of("\r\n");
    const bool onlyCr = content[first] == '\r' && content.compare(first, 2, "\r\n") != 0;
    const std::size_t end = content.find(onlyCr ? '\r' : '\n', at);
    return end == std::string::npos ? content.size() : end + 1;
}

// Gives the first element of one of these names the usual one, unless another has it.
void rename(PlyHeader& header, const char* usual, const std::vector<std::string>& others) {
    const auto named = [&header](const std::string& name) {
        return std::find_if(header.elements.begin(), header.elements.end(),
                            [&name](const PlyElement& element) { return lowerCase(element.name) == name; });
    };
    auto found = named(usual);
    for (auto other = others.begin(); found == header.elements.end() && other != others.end(); ++other)
        found = named(*other);
    if (found != header.elements.end()) found->name = usual;
}

template <typename T>
double as(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return double(value);
}

}  // namespace

PlyHeader readPlyHeader(const std::string& path, const std::string& content) {
    TextScanner scanner(path, content, '\0');
    if (lowerCase(scanner.word().substr(0, 8)) != "ply")
        throw Error(ErrorCode::BadData, path + ": not a PLY file: it must begin with ply");
    scanner.skipLine();
    PlyHeader header;
    bool format = false;
    while (!scanner.atEnd()) {
        const std::string_view word = scanner.word();
        if (word == "format") {
            header.encoding = readEncoding(scanner);
            format = true;
        } else if (word == "element") {
            PlyElement element;
            element.name = std::string(scanner.wordOnLine());
            element.count = scanner.whole();
            if (element.count < 0) scanner.fail("a negative number of elements");
            header.elements.push_back(element);
        } else if (word == "property") {
            if (header.elements.empty()) scanner.fail("a property before any element");
            header.elements.back().properties.push_back(readProperty(scanner));
        } else if (word == "end_header") {
            if (!format) scanner.fail("the header names no format");
            header.bytes = bodyBegin(content, scanner.position());
            rename(header, "vertex", {"vertices", "point", "points"});
            rename(header, "face", {"faces", "polygon", "polygons"});
            return header;
        }
        scanner.skipLine();
    }
    scanner.fail("the header has no end_header; the file is truncated");
}

std::vector<std::string> plyCommentsIn(const std::string& content) {
    std::vector<std::string> comments;
    for (std::size_t at = 0; at < content.size();) {
        const std::size_t end = std::min(content.find_first_of("\r\n", at), content.size());
        std::string line = content.substr(at, std::min<std::size_t>(end - at, 4096));
        line.erase(line.find_last_not_of(" \t") + 1);
        if (line == "end_header") break;
        if (line.compare(0, 8, "comment ") == 0) comments.push_back(line.substr(8));
        at = end + 1;
    }
    return comments;
}

PlyBody::PlyBody(const std::string& path, const std::string& content, const PlyHeader& header)
    : mPath(path),
      mContent(content),
      mAt(header.bytes),
      mEncoding(header.encoding),
      mScanner(path, content, '\0', header.bytes) {
    checkCounts(header);
    if (mEncoding != PlyEncoding::Ascii) return;
    std::int64_t elements = 0;
    for (const PlyElement& element : header.elements) elements += element.count;
    mByLine = true;
    mManyLines = mScanner.linesWithWords() >= elements;
}

// The smallest size of an element: one byte per value in binary (a list may be empty), two characters in
// text.
void PlyBody::checkCounts(const PlyHeader& header) const {
    for (const PlyElement& element : header.elements) {
        std::size_t least = 0;
        for (const PlyProperty& p : element.properties)
            least += mEncoding == PlyEncoding::Ascii ? 2 : p.list ? sizeOf(p.count) : sizeOf(p.value);
        const std::size_t room = mContent.size() - header.bytes + 1;
        if (element.count > 0 && (least == 0 || std::uint64_t(element.count) > room / least))
            fail("the header claims " + std::to_string(element.count) + " of \"" +
                 element.name.substr(0, 40) + "\", more than the file can hold; it is truncated or corrupt");
    }
}

void PlyBody::begin(const PlyElement& element) {
    if (mElement != &element) mEnded = mExact = 0;
    mElement = &element;
    mInElement = false;
}

void PlyBody::end() {
    ++mEnded;
    if (!mByLine) return;
    TextScanner ahead = mScanner;
    const bool exact = ahead.wordOnLine().empty();
    if (!exact && !mManyLines && mExact == 0) {
        mByLine = false;  // several elements on a line
        return;
    }
    ++(exact ? mExact : mLongLines);
    mScanner.skipLine();
}

double PlyBody::number(PlyType type) {
    if (mEncoding == PlyEncoding::Ascii) return asciiNumber(type);
    unsigned char bytes[8];
    take(bytes, sizeOf(type));
    if (mEncoding == PlyEncoding::Big) std::reverse(bytes, bytes + sizeOf(type));
    switch (type) {
        case PlyType::Int8:
            return as<std::int8_t>(bytes);
        case PlyType::UInt8:
            return as<std::uint8_t>(bytes);
        case PlyType::Int16:
            return as<std::int16_t>(bytes);
        case PlyType::UInt16:
            return as<std::uint16_t>(bytes);
        case PlyType::Int32:
            return as<std::int32_t>(bytes);
        case PlyType::UInt32:
            return as<std::uint32_t>(bytes);
        case PlyType::Int64:
            return as<std::int64_t>(bytes);
        case PlyType::UInt64:
            return as<std::uint64_t>(bytes);
        case PlyType::Float:
            return as<float>(bytes);
        case PlyType::Double:
            return as<double>(bytes);
    }
    return 0;
}

std::int64_t PlyBody::listLength(const PlyProperty& property) {
    const double length = number(property.count);
    if (!(length >= 0) || length != std::floor(length) || length > double(mContent.size()))
        fail("a list longer than the file, or of no whole length");
    return std::int64_t(length);
}

void PlyBody::skip(const PlyProperty& property) {
    const std::int64_t values = property.list ? listLength(property) : 1;
    if (mEncoding == PlyEncoding::Ascii) {
        for (std::int64_t i = 0; i < values; ++i) word();
        return;
    }
    const std::size_t bytes = std::size_t(values) * sizeOf(property.value);
    if (bytes > mContent.size() - mAt) failTruncated();
    mAt += bytes;
}

void PlyBody::skipAll(const PlyElement& element) {
    for (std::int64_t i = 0; i < element.count; ++i) {
        begin(element);
        for (const PlyProperty& property : element.properties) skip(property);
        end();
    }
}

std::size_t PlyBody::bytesLeft() const {
    const std::size_t at = mEncoding == PlyEncoding::Ascii ? mScanner.position() : mAt;
    const std::size_t last = mContent.find_last_not_of(" \t\r\n");
    return last == std::string::npos || last < at ? 0 : last + 1 - at;
}

void PlyBody::fail(const std::string& what) const {
    throw Error(ErrorCode::BadData, mPath + ": " + printableText(what));
}

void PlyBody::failTruncated() const {
    fail("truncated: " + std::to_string(mEnded) + " of " + std::to_string(mElement->count) + " of \"" +
         mElement->name.substr(0, 40) + "\" are there");
}

void PlyBody::take(unsigned char* bytes, std::size_t count) {
    if (count > mContent.size() - mAt) failTruncated();
    std::memcpy(bytes, mContent.data() + mAt, count);
    mAt += count;
}

std::string_view PlyBody::word() {
    std::string_view word = mByLine ? mScanner.wordOnLine() : mScanner.word();
    if (word.empty() && mByLine) {
        word = mScanner.word();
        if (mInElement && !word.empty()) {
            // An element goes on in the next line: all may, unless some were whole lines or were cut.
            const bool lists = std::any_of(mElement->properties.begin(), mElement->properties.end(),
                                           [](const PlyProperty& property) { return property.list; });
            if (mLongLines > 0 || (mExact > 0 && !lists))
                fail(
                    "a line of \"" + mElement->name.substr(0, 40) +
                    "\" has fewer words than the header declares; the file is truncated or the header wrong");
            mByLine = false;
        }
    }
    if (word.empty()) failTruncated();
    mInElement = true;
    return word;
}

double PlyBody::asciiNumber(PlyType type) {
    const std::string_view text = word();
    double value = 0;
    const bool whole = type != PlyType::Float && type != PlyType::Double;
    if (!parseForeignReal(text, value) || (whole && !std::isfinite(value)))
        mScanner.fail("\"" + std::string(text.substr(0, 40)) + "\" is not a number");
    return value;
}

}  // namespace vdbsynth
