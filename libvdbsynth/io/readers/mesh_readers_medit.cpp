// MEDIT .mesh, ascii: the surface triangles and quadrilaterals of a mesh; if it has only tetrahedra, the
// faces that belong to exactly one of them.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>
#include <array>

namespace vdbsynth {
namespace {

using Tetrahedron = std::array<std::uint32_t, 4>;

std::int64_t readCount(TextScanner& scanner, const std::string& content, const char* what) {
    const std::int64_t count = scanner.whole();
    if (count < 0 || count > std::int64_t(content.size() / 4 + 1))
        scanner.fail("claims " + std::to_string(count) + " " + what + ", more than the file can hold");
    return count;
}

template <std::size_t N>
std::array<std::uint32_t, N> readCorners(TextScanner& scanner, std::size_t vertices) {
    std::array<std::uint32_t, N> corners;
    for (std::uint32_t& corner : corners) {
        const std::int64_t index = scanner.whole();
        if (index < 1 || index > std::int64_t(vertices))
            scanner.fail("vertex " + std::to_string(index) + " of " + std::to_string(vertices) +
                         " does not exist (counting from 1)");
        corner = std::uint32_t(index - 1);
    }
    scanner.whole();  // a reference number
    return corners;
}

// Faces of exactly one tetrahedron, facing out of it.
std::vector<Triangle> surfaceOf(const std::vector<Tetrahedron>& tetrahedra) {
    struct Side {
        Triangle key, face;
    };
    std::vector<Side> sides;
    for (const Tetrahedron& t : tetrahedra)
        for (const Triangle& face : {Triangle{t[0], t[2], t[1]}, Triangle{t[0], t[1], t[3]},
                                     Triangle{t[1], t[2], t[3]}, Triangle{t[0], t[3], t[2]}}) {
            Side side{face, face};
            std::sort(side.key.begin(), side.key.end());
            sides.push_back(side);
        }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key < b.key; });
    std::vector<Triangle> surface;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i;
        while (j < sides.size() && sides[j].key == sides[i].key) ++j;
        if (j == i + 1) surface.push_back(sides[i].face);
        i = j;
    }
    return surface;
}

void skipValues(TextScanner& scanner, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) scanner.skipLine();
}

}  // namespace

MeshContent readMedit(const std::string& path, const std::string& content, const RunContext&) {
    TextScanner scanner(path, content);
    if (scanner.word() != "MeshVersionFormatted")
        scanner.fail("not an ascii MEDIT file: it must begin with MeshVersionFormatted");
    scanner.whole();
    MeshContent mesh;
    std::vector<Tetrahedron> tetrahedra;
    while (!scanner.atEnd()) {
        const std::string word(scanner.word());
        if (word == "End") break;
        if (word == "Dimension") {
            if (scanner.whole() != 3) scanner.fail("only meshes in three dimensions are supported");
        } else if (word == "Vertices") {
            const std::int64_t count = readCount(scanner, content, "vertices");
            for (std::int64_t i = 0; i < count; ++i) {
                Vec3d p;
                for (int axis = 0; axis < 3; ++axis) p[axis] = scanner.real();
                scanner.real();  // a reference number
                mesh.points.push_back(p);
            }
        } else if (word == "Triangles") {
            const std::int64_t count = readCount(scanner, content, "triangles");
            for (std::int64_t i = 0; i < count; ++i)
                mesh.polygons.add(readCorners<3>(scanner, mesh.points.size()).data(), 3);
        } else if (word == "Quadrilaterals") {
            const std::int64_t count = readCount(scanner, content, "quadrilaterals");
            for (std::int64_t i = 0; i < count; ++i)
                mesh.polygons.add(readCorners<4>(scanner, mesh.points.size()).data(), 4);
        } else if (word == "Tetrahedra") {
            const std::int64_t count = readCount(scanner, content, "tetrahedra");
            for (std::int64_t i = 0; i < count; ++i)
                tetrahedra.push_back(readCorners<4>(scanner, mesh.points.size()));
        } else {
            // Edges, corners, normals and similar: a number of lines.
            const std::int64_t count = readCount(scanner, content, word.c_str());
            scanner.skipLine();
            skipValues(scanner, count);
        }
    }
    if (mesh.polygons.sizes.empty())
        for (const Triangle& face : surfaceOf(tetrahedra)) mesh.polygons.add(face.data(), 3);
    return mesh;
}

}  // namespace vdbsynth
