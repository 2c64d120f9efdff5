#include "libvdbsynth/io/readers/texture_seams.h"

#include "libvdbsynth/geometry/attribute.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace vdbsynth {
namespace {

// Gives every vertex its texture coordinates; a vertex with several is duplicated for each.
class SeamSplitter {
public:
    SeamSplitter(MeshContent& mesh, const std::vector<float>& texture) : mMesh(mesh), mTexture(texture) {
        mOf.assign(mesh.points.size(), kNoTexture);
    }
    std::uint32_t vertex(std::uint32_t point, std::int32_t texture) {
        if (texture == kNoTexture) return point;
        if (mOf[point] == kNoTexture) mOf[point] = texture;
        if (mOf[point] == texture) return point;
        const auto [at, fresh] = mSplit.try_emplace({point, texture}, std::uint32_t(mMesh.points.size()));
        if (fresh) {
            mMesh.points.push_back(Vec3d(mMesh.points[point]));
            mSource.push_back({point, texture});
        }
        return at->second;
    }
    // Adds the coordinates, and the attributes of the vertices that were split.
    bool finish() {
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < mOf.size(); ++i) rows.push_back(i);
        for (const auto& [point, texture] : mSource) {
            rows.push_back(point);
            mOf.push_back(texture);
        }
        if (!mSource.empty()) mMesh.attributes = selectRows(mMesh.attributes, rows);
        Attribute uv{"uv", 2, {}};
        for (const std::int32_t texture : mOf)
            for (std::size_t k = 0; k < 2; ++k)
                uv.values.push_back(texture == kNoTexture ? 0.f : mTexture[std::size_t(texture) * 2 + k]);
        if (!std::all_of(uv.values.begin(), uv.values.end(), [](float v) { return std::isfinite(v); }))
            return false;
        mMesh.attributes.push_back(std::move(uv));
        return true;
    }

private:
    MeshContent& mMesh;
    const std::vector<float>& mTexture;
    std::vector<std::int32_t> mOf;  // texture coordinates of each point
    std::map<std::pair<std::uint32_t, std::int32_t>, std::uint32_t> mSplit;
    std::vector<std::pair<std::uint32_t, std::int32_t>> mSource;
};

}  // namespace

bool splitAtSeams(MeshContent& content, const std::vector<std::int32_t>& cornerTexture,
                  const std::vector<float>& texture) {
    SeamSplitter splitter(content, texture);
    for (std::size_t i = 0; i < cornerTexture.size(); ++i)
        content.polygons.corners[i] = splitter.vertex(content.polygons.corners[i], cornerTexture[i]);
    return splitter.finish();
}

}  // namespace vdbsynth
