#include "libvdbsynth/relief/growth/density_correlation.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

namespace vdbsynth {
namespace {

constexpr double kBytesAVertex = 320;  // with its faces and edges, while refining
constexpr std::size_t kMostVertices = 0xfffffff0u;

struct Edge {
    float squared;
    std::uint32_t a, b;                        // a < b
    bool operator<(const Edge& other) const {  // the longest is on top, of equal ones the lowest numbers
        if (squared != other.squared) return squared < other.squared;
        return a != other.a ? a > other.a : b > other.b;
    }
};

// A mesh of triangles with the faces of every edge.
class Refiner {
public:
    explicit Refiner(Mesh& mesh) : mMesh(mesh) {
        mesh.triangles = triangulated(mesh);
        mesh.quads.clear();
        for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) addFace(f);
        for (const auto& [key, faces] : mFaces) queue(key);
    }

    // Splits the longest edge. @return false if there is none
    bool splitLongest() {
        if (mEdges.empty()) return false;
        const Edge edge = mEdges.top();
        mEdges.pop();
        const std::uint64_t key = keyOf(edge.a, edge.b);
        const std::vector<std::uint32_t> faces = std::move(mFaces[key]);
        mFaces.erase(key);
        const std::uint32_t middle = addMiddle(edge.a, edge.b);
        for (std::uint32_t f : faces) splitFace(f, edge, middle);
        queue(keyOf(edge.a, middle));
        queue(keyOf(edge.b, middle));
        for (std::uint32_t opposite : mOpposite) queue(keyOf(opposite, middle));
        mOpposite.clear();
        return true;
    }

private:
    static std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
    }

    void queue(std::uint64_t key) {
        const std::uint32_t a = std::uint32_t(key >> 32), b = std::uint32_t(key);
        const Vec3f d = mMesh.points[b] - mMesh.points[a];
        if (dot(d, d) > 0) mEdges.push({dot(d, d), a, b});
    }

    void addFace(std::uint32_t f) {
        const Triangle& t = mMesh.triangles[f];
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<std::uint32_t>& faces = mFaces[keyOf(t[k], t[(k + 1) % 3])];
            if (faces.empty() || faces.back() != f) faces.push_back(f);
        }
    }

    std::uint32_t addMiddle(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t middle = std::uint32_t(mMesh.points.size());
        const Vec3f place = mMesh.points[a] * 0.5f + mMesh.points[b] * 0.5f;
        mMesh.points.push_back(place);
        for (Attribute& attribute : mMesh.attributes)
            for (std::size_t c = 0; c < attribute.width; ++c)
                attribute.values.push_back(0.5f * attribute.values[a * attribute.width + c] +
                                           0.5f * attribute.values[b * attribute.width + c]);
        return middle;
    }

    // The face keeps its half with a; a new one takes the half with b.
    void splitFace(std::uint32_t f, const Edge& edge, std::uint32_t middle) {
        const Triangle whole = mMesh.triangles[f];
        const std::uint32_t added = std::uint32_t(mMesh.triangles.size());
        Triangle first = whole, second = whole;
        std::uint32_t opposite = edge.a;
        for (std::size_t k = 0; k < 3; ++k) {
            if (whole[k] == edge.b)
                first[k] = middle;
            else if (whole[k] == edge.a)
                second[k] = middle;
            else
                opposite = whole[k];
        }
        mMesh.triangles[f] = first;
        mMesh.triangles.push_back(second);
        mFaces[keyOf(edge.a, middle)].push_back(f);
        mFaces[keyOf(edge.b, middle)].push_back(added);
        if (opposite == edge.a) return;  // a face that uses a corner twice
        std::vector<std::uint32_t>& across = mFaces[keyOf(edge.b, opposite)];
        std::replace(across.begin(), across.end(), f, added);
        std::vector<std::uint32_t>& inner = mFaces[keyOf(opposite, middle)];
        inner.push_back(f);
        inner.push_back(added);
        if (std::find(mOpposite.begin(), mOpposite.end(), opposite) == mOpposite.end())
            mOpposite.push_back(opposite);
    }

    Mesh& mMesh;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> mFaces;
    std::priority_queue<Edge> mEdges;
    std::vector<std::uint32_t> mOpposite;  // corners across the edge that is split
};

std::size_t usedVertices(const Mesh& mesh) {
    std::vector<char> used(mesh.points.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (std::uint32_t v : t) used[v] = 1;
    for (const Quad& q : mesh.quads)
        for (std::uint32_t v : q) used[v] = 1;
    return std::size_t(std::count(used.begin(), used.end(), 1));
}

}  // namespace

double vertexDensity(const Mesh& mesh) {
    const double area = summarize(mesh).area;
    return area > 0 ? double(usedVertices(mesh)) / area : 0;
}

std::size_t refineToVertices(Mesh& mesh, std::size_t vertices, const RunContext& ctx) {
    if (vertices <= mesh.points.size()) return 0;
    const std::size_t before = mesh.points.size(), wanted = vertices - before;
    requireMemory(ctx, double(vertices) * kBytesAVertex,
                  "refining a mesh to " + std::to_string(vertices) + " vertices",
                  "give meshes whose densities differ less");
    if (vertices > kMostVertices)
        throw Error(ErrorCode::Memory,
                    "the densities of the two meshes differ too much: refining the sparser needs " +
                        roundedText(double(vertices), 3) + " vertices");
    throwIfCancelled(ctx);
    Refiner refiner(mesh);
    Stage stage(ctx, "refining the sparser mesh", wanted);
    while (mesh.points.size() < vertices && refiner.splitLongest()) stage.advance();
    return mesh.points.size() - before;
}

DensityCorrelation correlateDensities(Mesh& sample, Mesh& target, const RunContext& ctx) {
    DensityCorrelation result{vertexDensity(sample), vertexDensity(target)};
    if (!(result.sample > 0)) throw Error(ErrorCode::EmptyInput, "the sample has no area");
    if (!(result.target > 0)) throw Error(ErrorCode::EmptyInput, "the target has no area");
    const double ratio = std::max(result.sample, result.target) / std::min(result.sample, result.target);
    if (ratio <= kSameDensity) return result;
    result.targetRefined = result.target < result.sample;
    Mesh& sparser = result.targetRefined ? target : sample;
    const double wanted = double(usedVertices(sparser)) * ratio;
    const double unused = double(sparser.points.size() - usedVertices(sparser));
    result.added = refineToVertices(sparser, std::size_t(std::min(wanted + unused, 9e15)), ctx);
    message(ctx, MessageLevel::Note,
            std::string(result.targetRefined ? "the target" : "the sample") + " has " +
                roundedText(ratio, 3) + " times fewer vertices for its area than the other: " +
                std::to_string(result.added) + " added by splitting long edges");
    return result;
}

}  // namespace vdbsynth
