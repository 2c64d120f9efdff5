#include "libvdbsynth/io/readers/facet_soup.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

namespace vdbsynth {
namespace {

struct PointHash {
    std::size_t operator()(const Vec3f& p) const { return std::size_t(hash64(&p, sizeof p)); }
};
struct PointEqual {
    bool operator()(const Vec3f& a, const Vec3f& b) const { return std::memcmp(&a, &b, sizeof a) == 0; }
};

bool isFinite(const Vec3f& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

struct FacetSoup::Vertices {
    std::unordered_map<Vec3f, std::uint32_t, PointHash, PointEqual> seen;
    std::vector<std::uint32_t> corners;  // of one facet
};

FacetSoup::FacetSoup() : mVertices(std::make_unique<Vertices>()) {}
FacetSoup::~FacetSoup() = default;

void FacetSoup::add(const Vec3f* keys, const Vec3d* points, std::size_t count) {
    ++mFacets;
    if (!std::all_of(keys, keys + count, isFinite)) {
        ++mUnfinite;
        return;
    }
    std::vector<std::uint32_t>& corners = mVertices->corners;
    corners.clear();
    for (std::size_t i = 0; i < count; ++i) {
        Vec3f key = keys[i];
        for (int axis = 0; axis < 3; ++axis) key[axis] += 0.f;  // -0 becomes +0
        const auto [it, isNew] = mVertices->seen.emplace(key, std::uint32_t(mMesh.points.size()));
        if (isNew) mMesh.points.push_back(points[i]);
        if (corners.empty() || corners.back() != it->second) corners.push_back(it->second);
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() >= 3) mMesh.polygons.add(corners.data(), corners.size());
}

bool FacetSoup::isClosed() const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(mMesh.polygons.corners.size());
    const std::uint32_t* corner = mMesh.polygons.corners.data();
    for (const std::uint32_t size : mMesh.polygons.sizes) {
        for (std::uint32_t i = 0; i < size; ++i)
            edges.push_back(std::minmax(corner[i], corner[i + 1 < size ? i + 1 : 0]));
        corner += size;
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
        while (j < edges.size() && edges[j] == edges[i]) ++j;
        if ((j - i) % 2 != 0) return false;
    }
    return !edges.empty();
}

MeshContent FacetSoup::take(const std::string& path, const RunContext& ctx) {
    const std::string some = std::to_string(mUnfinite) + " of " + std::to_string(mFacets) +
                             " triangles have a coordinate that is not a finite number";
    if (mUnfinite > mFacets / 2) throw Error(ErrorCode::BadData, path + ": " + some);
    if (mUnfinite > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + some + "; they are left out, and the surface may have holes there");
    mFacets = mUnfinite = 0;
    mVertices->seen.clear();
    return std::exchange(mMesh, {});
}

}  // namespace vdbsynth
