// OBJ through tinyobjloader, the one file that sees it. It reads "v 1 2" as (1, 2, 0) and "nan" as 0 without
// a word, and rounds coordinates to another last bit than the C library does, so vertices are read here and
// tinyobjloader is asked for the faces.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_readers.h"
#include "libvdbsynth/io/text_scanner.h"

#include <tiny_obj_loader.h>

#include <cmath>
#include <sstream>

namespace vdbsynth {
namespace {

std::vector<Vec3f> readVertexLines(const std::string& path, const std::string& content) {
    std::vector<Vec3f> points;
    TextScanner scanner(path, content);
    while (!scanner.atEnd()) {
        if (scanner.word() == "v") {
            Vec3f p;
            for (int axis = 0; axis < 3; ++axis) {
                const std::string_view number = scanner.wordOnLine();
                if (number.empty()) scanner.fail("a vertex has fewer than three coordinates");
                if (!parseReal(number, p[axis]))
                    scanner.fail("\"" + std::string(number.substr(0, 40)) + "\" is not a number");
                if (!std::isfinite(p[axis])) scanner.fail("a coordinate is not a finite number");
            }
            points.push_back(p);
        }
        scanner.skipLine();
    }
    return points;
}

// A backslash at a line's end joins it to the next; the line end moves behind the whole, so that lines below
// keep their numbers.
std::string withJoinedLines(const std::string& text) {
    if (text.find('\\') == std::string::npos) return text;
    std::string joined;
    joined.reserve(text.size());
    std::size_t owed = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool carriage = i + 2 < text.size() && text[i + 1] == '\r' && text[i + 2] == '\n';
        if (text[i] == '\\' && (carriage || (i + 1 < text.size() && text[i + 1] == '\n'))) {
            joined += ' ';
            ++owed;
            i += carriage ? 2 : 1;
        } else {
            joined += text[i];
            if (text[i] != '\n') continue;
            joined.append(owed, '\n');
            owed = 0;
        }
    }
    return joined;
}

}  // namespace

Mesh readObj(const std::string& path, const std::string& text) {
    const std::string content = withJoinedLines(text);
    Mesh mesh;
    mesh.points = readVertexLines(path, content);
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, problem;
    std::istringstream stream(content);
    const bool ok = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &problem, &stream, nullptr,
                                     /* triangulate= */ false);
    if (!ok) {
        problem = problem.substr(0, problem.find('\n'));
        throw Error(ErrorCode::BadData, path + ": " + (problem.empty() ? "not a valid OBJ file" : problem));
    }
    std::vector<std::uint32_t> corners;
    for (const tinyobj::shape_t& shape : shapes) {
        std::size_t at = 0;
        for (const auto count : shape.mesh.num_face_vertices) {
            corners.clear();
            for (std::size_t c = 0; c < std::size_t(count); ++c)
                corners.push_back(std::uint32_t(shape.mesh.indices[at + c].vertex_index));
            at += std::size_t(count);
            appendPolygon(mesh, corners.data(), corners.size());
        }
    }
    return mesh;
}

}  // namespace vdbsynth
