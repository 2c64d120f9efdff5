// STL, ascii and binary. A binary file may begin with "solid" too, so the size decides.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <cmath>
#include <cstring>
#include <unordered_map>

namespace vdbsynth {
namespace {

struct PointHash {
    std::size_t operator()(const Vec3f& p) const { return std::size_t(hash64(&p, sizeof p)); }
};
struct PointEqual {
    bool operator()(const Vec3f& a, const Vec3f& b) const { return std::memcmp(&a, &b, sizeof a) == 0; }
};

// Gives corners with the same bits one vertex.
class Welder {
public:
    explicit Welder(MeshContent& mesh) : mMesh(mesh) {}
    std::uint32_t add(Vec3f p) {
        for (int axis = 0; axis < 3; ++axis) p[axis] += 0.f;  // -0 becomes +0
        const auto [it, isNew] = mSeen.emplace(p, std::uint32_t(mMesh.points.size()));
        if (isNew) mMesh.points.push_back(cast<double>(p));
        return it->second;
    }

private:
    MeshContent& mMesh;
    std::unordered_map<Vec3f, std::uint32_t, PointHash, PointEqual> mSeen;
};

void addTriangle(MeshContent& mesh, Welder& welder, const Vec3f corner[3]) {
    const Triangle t{welder.add(corner[0]), welder.add(corner[1]), welder.add(corner[2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.polygons.add(t.data(), 3);
}

MeshContent readBinary(const std::string& path, const std::string& content, std::uint32_t count) {
    MeshContent mesh;
    Welder welder(mesh);
    mesh.polygons.corners.reserve(std::size_t(count) * 3);
    for (std::uint32_t i = 0; i < count; ++i) {
        Vec3f corner[3];
        std::memcpy(corner, content.data() + 84 + std::size_t(i) * 50 + 12, sizeof corner);
        for (const Vec3f& p : corner)
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                throw Error(ErrorCode::BadData, path + ": triangle " + std::to_string(i) +
                                                    " has a coordinate that is not a finite number");
        addTriangle(mesh, welder, corner);
    }
    return mesh;
}

MeshContent readAscii(const std::string& path, const std::string& content) {
    MeshContent mesh;
    Welder welder(mesh);
    TextScanner scanner(path, content, '\0');
    scanner.skipLine();  // solid NAME
    Vec3f corner[3];
    std::size_t corners = 0;
    bool ended = false;
    while (!scanner.atEnd()) {
        const std::string_view word = scanner.word();
        if (word == "vertex") {
            if (corners == 3) scanner.fail("a facet has more than three vertices");
            for (int axis = 0; axis < 3; ++axis) corner[corners][axis] = float(scanner.real());
            ++corners;
        } else if (word == "endfacet") {
            if (corners != 3) scanner.fail("a facet has fewer than three vertices");
            addTriangle(mesh, welder, corner);
            corners = 0;
        } else if (word == "solid" || word == "endsolid" || word == "facet" || word == "outer" ||
                   word == "endloop") {
            ended = word == "endsolid";
            if (word != "endloop") scanner.skipLine();
        } else {
            scanner.fail("\"" + std::string(word.substr(0, 40)) + "\" does not belong in an STL file");
        }
    }
    if (!ended) scanner.fail("the file ends without endsolid; it is truncated");
    return mesh;
}

}  // namespace

MeshContent readStl(const std::string& path, const std::string& content, const RunContext&) {
    if (content.size() >= 84) {
        std::uint32_t count = 0;
        std::memcpy(&count, content.data() + 80, 4);
        if (content.size() == 84 + std::size_t(count) * 50) return readBinary(path, content, count);
        if (content.compare(0, 5, "solid") != 0)
            throw Error(ErrorCode::BadData,
                        path + ": the header claims " + std::to_string(count) + " triangles (" +
                            std::to_string(84 + std::uint64_t(count) * 50) + " bytes), the file has " +
                            std::to_string(content.size()) + " bytes");
    }
    if (content.compare(0, 5, "solid") != 0) throw Error(ErrorCode::BadData, path + ": not an STL file");
    return readAscii(path, content);
}

}  // namespace vdbsynth
