// PLY, ascii and binary of both byte orders: vertex x y z of any number type, faces as lists of indices;
// every other element and property is skipped by its declared size.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/point_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbsynth {
namespace {

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float, Double };

struct Property {
    std::string name;
    bool list = false;
    Type count = Type::UInt8;
    Type value = Type::Float;
};

struct Element {
    std::string name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding { Ascii, Little, Big };

struct Header {
    Encoding encoding = Encoding::Ascii;
    std::vector<Element> elements;
    std::size_t bytes = 0;
};

std::size_t sizeOf(Type type) {
    static const std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[std::size_t(type)];
}

bool typeOf(std::string_view name, Type& type) {
    static const std::pair<const char*, Type> names[] = {
        {"char", Type::Int8},     {"int8", Type::Int8},     {"uchar", Type::UInt8},
        {"uint8", Type::UInt8},   {"short", Type::Int16},   {"int16", Type::Int16},
        {"ushort", Type::UInt16}, {"uint16", Type::UInt16}, {"int", Type::Int32},
        {"int32", Type::Int32},   {"uint", Type::UInt32},   {"uint32", Type::UInt32},
        {"float", Type::Float},   {"float32", Type::Float}, {"double", Type::Double},
        {"float64", Type::Double}};
    for (const auto& [text, value] : names)
        if (name == text) {
            type = value;
            return true;
        }
    return false;
}

Property readProperty(TextScanner& scanner) {
    Property property;
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

Header readHeader(const std::string& path, const std::string& content) {
    TextScanner scanner(path, content, '\0');
    if (scanner.wordOnLine() != "ply")
        throw Error(ErrorCode::BadData, path + ": not a PLY file: it must begin with ply");
    Header header;
    bool format = false;
    while (!scanner.atEnd()) {
        const std::string_view word = scanner.word();
        if (word == "format") {
            const std::string_view name = scanner.wordOnLine();
            format = name == "ascii" || name == "binary_little_endian" || name == "binary_big_endian";
            if (!format) scanner.fail("unknown format \"" + std::string(name.substr(0, 40)) + "\"");
            header.encoding = name == "ascii"               ? Encoding::Ascii
                              : name == "binary_big_endian" ? Encoding::Big
                                                            : Encoding::Little;
        } else if (word == "element") {
            Element element;
            element.name = std::string(scanner.wordOnLine());
            element.count = scanner.whole();
            if (element.count < 0) scanner.fail("a negative number of elements");
            header.elements.push_back(element);
        } else if (word == "property") {
            if (header.elements.empty()) scanner.fail("a property before any element");
            header.elements.back().properties.push_back(readProperty(scanner));
        } else if (word == "end_header") {
            if (!format) scanner.fail("the header names no format");
            scanner.skipLine();
            header.bytes = scanner.position();
            return header;
        }
        scanner.skipLine();
    }
    scanner.fail("the header has no end_header; the file is truncated");
}

// Reads consecutive numbers from text or bytes.
class Body {
public:
    Body(const std::string& path, const std::string& content, const Header& header)
        : mPath(path),
          mContent(content),
          mAt(header.bytes),
          mEncoding(header.encoding),
          mScanner(path, content, '\0', header.bytes) {}

    double number(Type type) {
        if (mEncoding == Encoding::Ascii)
            return type == Type::Double || type == Type::Float ? asciiReal() : double(mScanner.whole());
        unsigned char bytes[8];
        take(bytes, sizeOf(type));
        if (mEncoding == Encoding::Big) std::reverse(bytes, bytes + sizeOf(type));
        switch (type) {
            case Type::Int8:
                return double(*reinterpret_cast<const std::int8_t*>(bytes));
            case Type::UInt8:
                return double(bytes[0]);
            case Type::Int16:
                return as<std::int16_t>(bytes);
            case Type::UInt16:
                return as<std::uint16_t>(bytes);
            case Type::Int32:
                return as<std::int32_t>(bytes);
            case Type::UInt32:
                return as<std::uint32_t>(bytes);
            case Type::Float:
                return as<float>(bytes);
            case Type::Double:
                return as<double>(bytes);
        }
        return 0;
    }

    void skip(const Property& property) {
        std::int64_t values = 1;
        if (property.list) values = listLength(property);
        if (mEncoding == Encoding::Ascii) {
            for (std::int64_t i = 0; i < values; ++i)
                if (mScanner.word().empty()) fail("the file is truncated");
        } else {
            const std::size_t bytes = std::size_t(values) * sizeOf(property.value);
            if (bytes > mContent.size() - mAt) fail("the file is truncated");
            mAt += bytes;
        }
    }

    std::int64_t listLength(const Property& property) {
        const double length = number(property.count);
        if (!(length >= 0) || length > double(mContent.size())) fail("a list longer than the file");
        return std::int64_t(length);
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorCode::BadData, mPath + ": " + what);
    }

private:
    template <typename T>
    static double as(const unsigned char* bytes) {
        T value;
        std::memcpy(&value, bytes, sizeof value);
        return double(value);
    }
    void take(unsigned char* bytes, std::size_t count) {
        if (count > mContent.size() - mAt) fail("the file is truncated");
        std::memcpy(bytes, mContent.data() + mAt, count);
        mAt += count;
    }
    // Skipped properties may hold nan; the caller checks coordinates.
    double asciiReal() {
        const std::string_view word = mScanner.word();
        double value = 0;
        if (word.empty()) fail("the file is truncated");
        if (!parseAnyReal(word, value)) fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
        return value;
    }

    const std::string& mPath;
    const std::string& mContent;
    std::size_t mAt;
    Encoding mEncoding;
    TextScanner mScanner;
};

void checkCounts(const std::string& path, const std::string& content, const Header& header) {
    // The smallest size of an element: one byte per value in binary (a list may be
    // empty), two characters in text.
    for (const Element& element : header.elements) {
        std::size_t least = 0;
        for (const Property& p : element.properties)
            least += header.encoding == Encoding::Ascii ? 2 : p.list ? sizeOf(p.count) : sizeOf(p.value);
        const std::size_t room = content.size() - header.bytes + 1;
        if (element.count > 0 && (least == 0 || std::uint64_t(element.count) > room / least))
            throw Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(element.count) +
                                                " of \"" + element.name + "\", more than the file can hold");
    }
}

// The destination of a vertex's property.
struct VertexLayout {
    std::vector<int>
        slot;  // of each property: 0 to 5 for x y z nx ny nz, 6 and on for a column, -1 for a list
    std::vector<AttributeColumn> columns;
    bool normals = false;
};

VertexLayout layoutOf(const Body& body, const Element& element) {
    static const char* const names[6] = {"x", "y", "z", "nx", "ny", "nz"};
    VertexLayout layout;
    bool found[6] = {};
    for (const Property& property : element.properties) {
        layout.slot.push_back(-1);
        if (property.list) continue;
        for (int k = 0; k < 6; ++k)
            if (property.name == names[k] && !found[k]) {
                layout.slot.back() = k;
                found[k] = true;
            }
        if (layout.slot.back() >= 0) continue;
        layout.slot.back() = 6 + int(layout.columns.size());
        const double white = property.value == Type::UInt8 ? 255 : property.value == Type::UInt16 ? 65535 : 0;
        layout.columns.push_back({property.name, white, {}});
    }
    for (int axis = 0; axis < 3; ++axis)
        if (!found[axis]) body.fail(std::string("the vertices have no ") + names[axis]);
    layout.normals = found[3] && found[4] && found[5];
    return layout;
}

// Reads vertices; `normals` is null if not requested, and stays empty if there are none.
void readVertices(Body& body, const Element& element, std::vector<Vec3d>& points, std::vector<Vec3f>* normals,
                  Attributes& attributes) {
    VertexLayout layout = layoutOf(body, element);
    points.reserve(std::size_t(element.count));
    for (std::int64_t v = 0; v < element.count; ++v) {
        double row[6] = {};
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const int slot = layout.slot[i];
            if (slot < 0) {
                body.skip(element.properties[i]);
                continue;
            }
            const double value = body.number(element.properties[i].value);
            if (slot >= 6) {
                layout.columns[std::size_t(slot - 6)].values.push_back(float(value));
                continue;
            }
            row[slot] = value;
        }
        points.push_back({row[0], row[1], row[2]});
        if (normals && layout.normals) normals->push_back({float(row[3]), float(row[4]), float(row[5])});
    }
    attributes = groupColumns(std::move(layout.columns));
}

// One index of a list. @return -1 for a negative one, which ends a strip
std::int64_t readIndex(Body& body, const Property& property, const std::string& what, std::size_t vertices) {
    const double index = body.number(property.value);
    if (index == -1) return -1;
    if (!(index >= 0) || index >= double(vertices) || index != std::floor(index))
        body.fail(what + " uses vertex " + roundedText(index, 10) + " of " + std::to_string(vertices) +
                  " (counting from 0)");
    return std::int64_t(index);
}

// Calls visit(property, number of the element, length) for every list of indices and skips everything else.
template <typename Visit>
void forIndexLists(Body& body, const Element& element, Visit&& visit) {
    for (std::int64_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties)
            if (property.list && (property.name == "vertex_indices" || property.name == "vertex_index"))
                visit(property, i, body.listLength(property));
            else
                body.skip(property);
}

void readFaces(Body& body, const Element& element, std::size_t vertices, MeshContent& mesh) {
    std::vector<std::uint32_t> corners;
    forIndexLists(body, element, [&](const Property& property, std::int64_t face, std::int64_t count) {
        corners.clear();
        const std::string what = "face " + std::to_string(face);
        for (std::int64_t c = 0; c < count; ++c) {
            const std::int64_t index = readIndex(body, property, what, vertices);
            if (index < 0) body.fail(what + " uses vertex -1");
            corners.push_back(std::uint32_t(index));
        }
        mesh.polygons.add(corners.data(), corners.size());
    });
}

// Triangle strips: every corner makes a face with the two before it, every second one
// flipped; -1 starts a new strip.
void readStrips(Body& body, const Element& element, std::size_t vertices, MeshContent& mesh) {
    forIndexLists(body, element, [&](const Property& property, std::int64_t, std::int64_t count) {
        std::uint32_t before[2] = {0, 0};
        std::int64_t length = 0;
        for (std::int64_t c = 0; c < count; ++c) {
            const std::int64_t index = readIndex(body, property, "a strip", vertices);
            if (index < 0) {
                length = 0;
                continue;
            }
            const std::uint32_t corner = std::uint32_t(index);
            const bool degenerate = corner == before[0] || corner == before[1] || before[0] == before[1];
            const std::size_t flipped = length % 2 == 0 ? 0 : 1;
            const Triangle face{before[flipped], before[1 - flipped], corner};
            if (length >= 2 && !degenerate) mesh.polygons.add(face.data(), 3);
            before[0] = before[1];
            before[1] = corner;
            ++length;
        }
    });
}

}  // namespace

MeshContent readPly(const std::string& path, const std::string& content, const RunContext&) {
    const Header header = readHeader(path, content);
    checkCounts(path, content, header);
    Body body(path, content, header);
    MeshContent mesh;
    for (const Element& element : header.elements) {
        if (element.name == "vertex")
            readVertices(body, element, mesh.points, nullptr, mesh.attributes);
        else if (element.name == "face")
            readFaces(body, element, mesh.points.size(), mesh);
        else if (element.name == "tristrips")
            readStrips(body, element, mesh.points.size(), mesh);
        else
            for (std::int64_t i = 0; i < element.count; ++i)
                for (const Property& property : element.properties) body.skip(property);
    }
    return mesh;
}

PointContent readPlyPoints(const std::string& path, const std::string& content, const RunContext&) {
    const Header header = readHeader(path, content);
    checkCounts(path, content, header);
    Body body(path, content, header);
    PointContent cloud;
    for (const Element& element : header.elements) {
        if (element.name == "vertex") {
            readVertices(body, element, cloud.points, &cloud.normals, cloud.attributes);
            break;
        }
        for (std::int64_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) body.skip(property);
    }
    return cloud;
}

std::int64_t plyFaceCount(const std::string& path, const std::string& content) {
    std::int64_t faces = 0;
    for (const Element& element : readHeader(path, content).elements)
        if (element.name == "face" || element.name == "tristrips") faces += element.count > 0 ? 1 : 0;
    return faces;
}

}  // namespace vdbsynth
