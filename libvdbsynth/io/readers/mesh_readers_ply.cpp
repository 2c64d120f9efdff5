// PLY as meshes and as points: vertex x y z of any number type, faces as lists of indices; every other
// element and property is skipped by its declared size.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/points/point_readers.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/ply_file.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

bool isVertices(const PlyElement& element) {
    return element.name == "vertex";
}

bool isFaces(const PlyElement& element) {
    return element.name == "face";
}

bool isStrips(const PlyElement& element) {
    return element.name == "tristrips";
}

// The destination of a vertex's property.
struct VertexLayout {
    std::vector<int>
        slot;  // of each property: 0 to 5 for x y z nx ny nz, 6 and on for a column, -1 for a list
    std::vector<AttributeColumn> columns;
    bool normals = false;
};

VertexLayout layoutOf(const PlyBody& body, const PlyElement& element) {
    static const char* const names[6] = {"x", "y", "z", "nx", "ny", "nz"};
    static const char* const capitals[6] = {"X", "Y", "Z", "NX", "NY", "NZ"};
    VertexLayout layout;
    bool found[6] = {};
    for (const PlyProperty& property : element.properties) {
        layout.slot.push_back(-1);
        if (property.list) continue;
        for (int k = 0; k < 6; ++k)
            if ((property.name == names[k] || property.name == capitals[k]) && !found[k]) {
                layout.slot.back() = k;
                found[k] = true;
            }
        if (layout.slot.back() >= 0) continue;
        layout.slot.back() = 6 + int(layout.columns.size());
        const double white = property.value == PlyType::UInt8    ? 255
                             : property.value == PlyType::UInt16 ? 65535
                                                                 : 0;
        layout.columns.push_back({property.name, white, {}});
    }
    for (int axis = 0; axis < 3; ++axis)
        if (!found[axis]) body.fail(std::string("the vertices have no ") + names[axis]);
    layout.normals = found[3] && found[4] && found[5];
    return layout;
}

// Reads vertices; `normals` is null if not requested, and stays empty if there are none.
void readVertices(PlyBody& body, const PlyElement& element, std::vector<Vec3d>& points,
                  std::vector<Vec3f>* normals, Attributes& attributes) {
    VertexLayout layout = layoutOf(body, element);
    points.reserve(std::size_t(element.count));
    for (std::int64_t v = 0; v < element.count; ++v) {
        body.begin(element);
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
        body.end();
        points.push_back({row[0], row[1], row[2]});
        if (normals && layout.normals) normals->push_back({float(row[3]), float(row[4]), float(row[5])});
    }
    attributes = groupColumns(std::move(layout.columns));
}

// One index of a list. @return -1 for a negative one, which ends a strip
std::int64_t readIndex(PlyBody& body, const PlyProperty& property, const std::string& what,
                       std::size_t vertices) {
    const double index = body.number(property.value);
    if (index == -1) return -1;
    if (!(index >= 0) || index >= double(vertices) || index != std::floor(index))
        body.fail(what + " uses vertex " + roundedText(index, 10) + " of " + std::to_string(vertices) +
                  " (counting from 0)");
    return std::int64_t(index);
}

// The list of a face's corners: by its name, else the first list of whole numbers.
const PlyProperty* cornersOf(const PlyElement& element) {
    for (const PlyProperty& property : element.properties)
        if (property.list && (property.name == "vertex_indices" || property.name == "vertex_index"))
            return &property;
    for (const PlyProperty& property : element.properties)
        if (property.list && property.isWhole()) return &property;
    return nullptr;
}

// Calls visit(property, number of the element, length) for every list of corners and skips everything else.
template <typename Visit>
void forIndexLists(PlyBody& body, const PlyElement& element, Visit&& visit) {
    const PlyProperty* corners = cornersOf(element);
    for (std::int64_t i = 0; i < element.count; ++i) {
        body.begin(element);
        for (const PlyProperty& property : element.properties)
            if (&property == corners)
                visit(property, i, body.listLength(property));
            else
                body.skip(property);
        body.end();
    }
}

void readFaces(PlyBody& body, const PlyElement& element, std::size_t vertices, MeshContent& mesh) {
    std::vector<std::uint32_t> corners;
    forIndexLists(body, element, [&](const PlyProperty& property, std::int64_t face, std::int64_t count) {
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
void readStrips(PlyBody& body, const PlyElement& element, std::size_t vertices, MeshContent& mesh) {
    forIndexLists(body, element, [&](const PlyProperty& property, std::int64_t, std::int64_t count) {
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

const PlyElement& verticesOf(const PlyBody& body, const PlyHeader& header) {
    const PlyElement* vertices = nullptr;
    for (const PlyElement& element : header.elements) {
        if (!isVertices(element)) continue;
        if (vertices) body.fail("the header has two elements \"vertex\", which is not supported");
        vertices = &element;
    }
    if (!vertices) body.fail("the header has no element \"vertex\"");
    return *vertices;
}

// The names of what is skipped, for one line.
std::string skippedOf(const PlyHeader& header) {
    std::vector<std::string> names;
    const auto add = [&names](const std::string& of, const std::string& name) {
        names.push_back(of + printableText(name.substr(0, 40)));
    };
    for (const PlyElement& element : header.elements) {
        if (element.count == 0) continue;
        const bool vertices = isVertices(element), faces = isFaces(element) || isStrips(element);
        const PlyProperty* corners = faces ? cornersOf(element) : nullptr;
        if (!vertices && !faces) add("element ", element.name);
        for (const PlyProperty& property : element.properties)
            if ((vertices && property.list) || (faces && &property != corners))
                add(vertices ? "vertex " : "face ", property.name);
    }
    constexpr std::size_t kMost = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) text += (i > 0 ? ", " : "") + names[i];
    if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
    return text;
}

// What was guessed or left out, once all is read.
void report(const std::string& path, const PlyHeader& header, const PlyBody& body, const RunContext& ctx) {
    const auto say = [&](MessageLevel level, const std::string& text) {
        message(ctx, level, path + ": " + text);
    };
    for (const PlyElement& element : header.elements) {
        if (element.count == 0 || !(isFaces(element) || isStrips(element))) continue;
        const PlyProperty* corners = cornersOf(element);
        if (!corners)
            say(MessageLevel::Warning, "its faces have no list of whole numbers, so no corners");
        else if (corners->name != "vertex_indices" && corners->name != "vertex_index")
            say(MessageLevel::Note, "the list \"" + printableText(corners->name.substr(0, 40)) +
                                        "\" is read as the corners of the faces");
    }
    if (const std::string skipped = skippedOf(header); !skipped.empty())
        say(MessageLevel::Note, "not read: " + skipped);
    if (body.longLines() > 0)
        say(MessageLevel::Note, std::to_string(body.longLines()) +
                                    " lines have more words than the header declares, which are not read");
    if (const std::size_t left = body.bytesLeft())
        say(MessageLevel::Note, countText(left, "byte") + " behind the last element left out");
}

// All normals of points, or none if some have no direction.
void dropNormals(const std::string& path, std::vector<Vec3f>& normals, const RunContext& ctx) {
    const auto isDirection = [](const Vec3f& n) { return length(n) > 1e-6f && std::isfinite(length(n)); };
    const auto without =
        std::count_if(normals.begin(), normals.end(), [&](const Vec3f& n) { return !isDirection(n); });
    if (without == 0) return;
    message(ctx, MessageLevel::Note,
            path + ": " + std::to_string(without) + " of " + std::to_string(normals.size()) +
                " normals have no length, so that none are read");
    normals.clear();
}

}  // namespace

MeshContent readPly(const std::string& path, const std::string& content, const RunContext& ctx) {
    const PlyHeader header = readPlyHeader(path, content);
    PlyBody body(path, content, header);
    const std::size_t vertices = std::size_t(verticesOf(body, header).count);
    MeshContent mesh;
    for (const PlyElement& element : header.elements) {
        if (isVertices(element))
            readVertices(body, element, mesh.points, nullptr, mesh.attributes);
        else if (isFaces(element))
            readFaces(body, element, vertices, mesh);
        else if (isStrips(element))
            readStrips(body, element, vertices, mesh);
        else
            body.skipAll(element);
    }
    report(path, header, body, ctx);
    return mesh;
}

PointContent readPlyPoints(const std::string& path, const std::string& content, const RunContext& ctx) {
    const PlyHeader header = readPlyHeader(path, content);
    PlyBody body(path, content, header);
    const PlyElement& vertices = verticesOf(body, header);
    PointContent cloud;
    for (const PlyElement& element : header.elements) {
        if (&element == &vertices)
            readVertices(body, element, cloud.points, &cloud.normals, cloud.attributes);
        else
            body.skipAll(element);
    }
    report(path, header, body, ctx);
    dropNormals(path, cloud.normals, ctx);
    cloud.comments = plyCommentsIn(content);
    return cloud;
}

std::int64_t plyFaceCount(const std::string& path, const std::string& content) {
    std::int64_t faces = 0;
    for (const PlyElement& element : readPlyHeader(path, content).elements)
        if (isFaces(element) || isStrips(element)) faces += element.count > 0 ? 1 : 0;
    return faces;
}

}  // namespace vdbsynth
