// MEDIT .mesh, ascii: the surface triangles and quadrilaterals of a mesh; if it has only volume elements, the
// faces that belong to exactly one of them.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>
#include <array>

namespace vdbsynth {
namespace {

// A face of a volume element; of a triangle the fourth corner is kNone.
using Side = std::array<std::uint32_t, 4>;
constexpr std::uint32_t kNone = 0xFFFFFFFF;

// Kinds of volume element: their corners, and their sides, facing out.
struct Volume {
    const char* keyword;
    std::size_t corners;
    std::vector<Side> sides;
};

const std::vector<Volume>& volumes() {
    static const std::vector<Volume> all{
        {"Tetrahedra", 4, {{0, 2, 1, kNone}, {0, 1, 3, kNone}, {1, 2, 3, kNone}, {0, 3, 2, kNone}}},
        {"Hexahedra",
         8,
         {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
        {"Prisms", 6, {{0, 2, 1, kNone}, {3, 4, 5, kNone}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
        {"Pyramids",
         5,
         {{0, 3, 2, 1}, {0, 1, 4, kNone}, {1, 2, 4, kNone}, {2, 3, 4, kNone}, {3, 0, 4, kNone}}}};
    return all;
}

std::int64_t readCount(TextScanner& scanner, const std::string& content, const char* what) {
    const std::int64_t count = scanner.whole();
    if (count < 0 || count > std::int64_t(content.size() / 4 + 1))
        scanner.fail("claims " + std::to_string(count) + " of " + what + ", more than the file can hold");
    return count;
}

std::vector<std::uint32_t> readCorners(TextScanner& scanner, std::size_t count, std::size_t vertices) {
    std::vector<std::uint32_t> corners(count);
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

// Of exactly one volume element.
void addSurface(const std::vector<Side>& sides, PolygonList& polygons) {
    struct Keyed {
        Side key, side;
    };
    std::vector<Keyed> all;
    for (const Side& side : sides) {
        all.push_back({side, side});
        std::sort(all.back().key.begin(), all.back().key.end());
    }
    std::stable_sort(all.begin(), all.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    for (std::size_t i = 0, j = 0; i < all.size(); i = j) {
        while (j < all.size() && all[j].key == all[i].key) ++j;
        if (j == i + 1) polygons.add(all[i].side.data(), all[i].side[3] == kNone ? 3 : 4);
    }
}

void readVolumes(TextScanner& scanner, const Volume& volume, std::int64_t count, std::size_t vertices,
                 std::vector<Side>& sides) {
    for (std::int64_t i = 0; i < count; ++i) {
        const std::vector<std::uint32_t> corners = readCorners(scanner, volume.corners, vertices);
        for (Side side : volume.sides) {
            for (std::uint32_t& corner : side)
                if (corner != kNone) corner = corners[corner];
            sides.push_back(side);
        }
    }
}

void skipValues(TextScanner& scanner, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) scanner.skipLine();
}

}  // namespace

MeshContent readMedit(const std::string& path, const std::string& content, const RunContext& ctx) {
    TextScanner scanner(path, content);
    if (scanner.word() != "MeshVersionFormatted")
        scanner.fail("not an ascii MEDIT file: it must begin with MeshVersionFormatted");
    scanner.whole();
    MeshContent mesh;
    std::vector<Side> sides;
    while (!scanner.atEnd()) {
        const std::string word(scanner.word());
        if (word == "End") break;
        if (word == "Dimension") {
            if (scanner.whole() != 3) scanner.fail("only meshes in three dimensions are supported");
            continue;
        }
        const std::int64_t count = readCount(scanner, content, word.c_str());
        const auto volume = std::find_if(volumes().begin(), volumes().end(),
                                         [&word](const Volume& known) { return word == known.keyword; });
        if (word == "Vertices") {
            for (std::int64_t i = 0; i < count; ++i) {
                Vec3d p;
                for (int axis = 0; axis < 3; ++axis) p[axis] = scanner.anyReal();
                scanner.real();  // a reference number
                mesh.points.push_back(p);
            }
        } else if (word == "Triangles" || word == "Quadrilaterals") {
            const std::size_t corners = word == "Triangles" ? 3 : 4;
            for (std::int64_t i = 0; i < count; ++i)
                mesh.polygons.add(readCorners(scanner, corners, mesh.points.size()).data(), corners);
        } else if (volume != volumes().end()) {
            readVolumes(scanner, *volume, count, mesh.points.size(), sides);
        } else {
            // Edges, corners, normals and similar: a number of lines.
            if (word.find("P2") != std::string::npos || word.find("Q2") != std::string::npos)
                message(ctx, MessageLevel::Warning,
                        path + ": " + countText(std::size_t(count), "curved element") + " (" +
                            printableText(word) + ") left out; save it with straight ones");
            scanner.skipLine();
            skipValues(scanner, count);
        }
    }
    if (mesh.polygons.sizes.empty()) addSurface(sides, mesh.polygons);
    return mesh;
}

}  // namespace vdbsynth
