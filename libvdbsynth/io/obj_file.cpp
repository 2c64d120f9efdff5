// OBJ through tinyobjloader, the one file that sees it. It reads "v 1 2" as (1, 2, 0) and "nan" as 0
// without a word, so vertex lines are checked first.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_readers.h"
#include "libvdbsynth/io/text_scanner.h"

#include <tiny_obj_loader.h>

#include <sstream>

namespace vdbsynth {
namespace {

void checkVertexLines(const std::string& path, const std::string& content) {
    TextScanner scanner(path, content);
    while (!scanner.atEnd()) {
        if (scanner.word() == "v")
            for (int i = 0; i < 3; ++i) {
                const std::string_view number = scanner.wordOnLine();
                float value = 0;
                if (number.empty()) scanner.fail("a vertex has fewer than three coordinates");
                if (!parseReal(number, value))
                    scanner.fail("\"" + std::string(number.substr(0, 40)) + "\" is not a number");
                if (!(value - value == 0.f)) scanner.fail("a coordinate is not a finite number");
            }
        scanner.skipLine();
    }
}

}  // namespace

Mesh readObj(const std::string& path, const std::string& content) {
    checkVertexLines(path, content);
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
    Mesh mesh;
    for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3)
        mesh.points.push_back(
            {attributes.vertices[i], attributes.vertices[i + 1], attributes.vertices[i + 2]});
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
