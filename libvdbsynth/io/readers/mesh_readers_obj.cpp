// OBJ through tinyobjloader, in the only file that includes it. It reads "v 1 2" as (1, 2, 0) and "nan" as 0
// silently, and its coordinates differ in the last bit from the C library's, so vertices are read here and
// tinyobjloader reads the faces.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

namespace vdbsynth {
namespace {

// Vertices with the colours that some programs append: they count only if every line is "v x y z r g b".
void readVertexLines(const std::string& path, const std::string& content, MeshContent& mesh) {
    TextScanner scanner(path, content);
    std::vector<AttributeColumn> colour{{"red", 0, {}}, {"green", 0, {}}, {"blue", 0, {}}};
    while (!scanner.atEnd()) {
        if (scanner.word() == "v") {
            Vec3d p;
            for (int axis = 0; axis < 3; ++axis) {
                const std::string_view number = scanner.wordOnLine();
                if (number.empty()) scanner.fail("a vertex has fewer than three coordinates");
                if (!parseAnyReal(number, p[axis]))
                    scanner.fail("\"" + std::string(number.substr(0, 40)) + "\" is not a number");
                if (!std::isfinite(p[axis])) scanner.fail("a coordinate is not a finite number");
            }
            mesh.points.push_back(p);
            for (AttributeColumn& column : colour) {
                float value = 0;
                if (parseAnyReal(scanner.wordOnLine(), value)) column.values.push_back(value);
            }
        }
        scanner.skipLine();
    }
    bool coloured = !mesh.points.empty();
    for (const AttributeColumn& column : colour)
        coloured = coloured && column.values.size() == mesh.points.size();
    if (coloured) mesh.attributes = groupColumns(std::move(colour));
}

// Gives every vertex its texture coordinates; a vertex with several, at a seam, is duplicated for each.
class SeamSplitter {
public:
    SeamSplitter(const std::string& path, MeshContent& mesh, const std::vector<tinyobj::real_t>& texture)
        : mPath(path), mMesh(mesh), mTexture(texture) {
        mOf.assign(mesh.points.size(), kUnset);
    }
    std::uint32_t vertex(int point, int texture) {
        const std::size_t p = std::size_t(point);
        if (point < 0 || p >= mOf.size())
            throw Error(ErrorCode::BadData, mPath + ": a face uses vertex " + std::to_string(point) + " of " +
                                                std::to_string(mOf.size()) + " (counting from 0)");
        if (texture < 0 || std::size_t(texture) * 2 + 1 >= mTexture.size()) return std::uint32_t(point);
        if (mOf[p] == kUnset) mOf[p] = texture;
        if (mOf[p] == texture) return std::uint32_t(point);
        const auto [at, fresh] = mSplit.try_emplace({point, texture}, std::uint32_t(mMesh.points.size()));
        if (fresh) {
            mMesh.points.push_back(Vec3d(mMesh.points[p]));
            mSource.push_back({point, texture});
        }
        return at->second;
    }
    // Adds the coordinates, and the attributes of the vertices that were split.
    void finish() {
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < mOf.size(); ++i) rows.push_back(i);
        for (const auto& [point, texture] : mSource) {
            rows.push_back(std::size_t(point));
            mOf.push_back(texture);
        }
        if (!mSource.empty()) mMesh.attributes = selectRows(mMesh.attributes, rows);
        Attribute uv{"uv", 2, {}};
        for (int texture : mOf)
            for (std::size_t k = 0; k < 2; ++k)
                uv.values.push_back(texture < 0 ? 0.f : float(mTexture[std::size_t(texture) * 2 + k]));
        const bool any = std::any_of(mOf.begin(), mOf.end(), [](int texture) { return texture >= 0; });
        const bool finite =
            std::all_of(uv.values.begin(), uv.values.end(), [](float v) { return std::isfinite(v); });
        if (any && finite) mMesh.attributes.push_back(std::move(uv));
    }

private:
    static constexpr int kUnset = -1;
    const std::string& mPath;
    MeshContent& mMesh;
    const std::vector<tinyobj::real_t>& mTexture;
    std::vector<int> mOf;  // texture coordinates of each point
    std::map<std::pair<int, int>, std::uint32_t> mSplit;
    std::vector<std::pair<int, int>> mSource;
};

// A backslash at a line's end joins it to the next; the line end moves behind the joined line, so that the
// following lines keep their numbers.
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

MeshContent readObj(const std::string& path, const std::string& text, const RunContext&) {
    const std::string content = withJoinedLines(text);
    MeshContent mesh;
    readVertexLines(path, content, mesh);
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
    SeamSplitter splitter(path, mesh, attributes.texcoords);
    std::vector<std::uint32_t> corners;
    for (const tinyobj::shape_t& shape : shapes) {
        std::size_t at = 0;
        for (const auto count : shape.mesh.num_face_vertices) {
            corners.clear();
            for (std::size_t c = 0; c < std::size_t(count); ++c)
                corners.push_back(splitter.vertex(shape.mesh.indices[at + c].vertex_index,
                                                  shape.mesh.indices[at + c].texcoord_index));
            at += std::size_t(count);
            mesh.polygons.add(corners.data(), corners.size());
        }
    }
    splitter.finish();
    return mesh;
}

}  // namespace vdbsynth
