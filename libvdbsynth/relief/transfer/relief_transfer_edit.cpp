// A target's distances with relief.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/transfer/relief_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::size_t kMixed = 6;  // sites
constexpr float kMixedReach = 3;   // [voxels] at which a site counts no more
constexpr float kLimit = 3;        // [voxels] of the result
constexpr float kWallStep = 0.5f;  // [voxels] along a normal

// [voxels] of solid under every site along its inward normal, at most `most`.
std::vector<float> wallsUnder(const ReliefTarget& target, float most, const RunContext& ctx) {
    std::vector<float> walls(target.point.size(), most);
    parallelFor(ctx, walls.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float depth = 1;
            for (; depth < most; depth += std::max(kWallStep, 0.5f * depth * 0.1f))
                if (sampleTrilinear(target.distance, target.point[i] - target.normal[i] * depth) > 0) break;
            walls[i] = std::min(depth, most);
        }
    });
    return walls;
}

class Edit {
public:
    Edit(const ReliefTarget& target, const std::vector<ReliefSample>& samples, const ReliefMap& map,
         const ReliefTransferOptions& options, const RunContext& ctx)
        : mTarget(target),
          mSamples(samples),
          mMap(map),
          mTexel(float(options.texel)),
          mStrength(float(options.strength)),
          mReach(reliefReach(samples, options)),
          mMinWall(float(options.minWall)),
          mNearest(target.point) {
        if (mMinWall > 0) mWalls = wallsUnder(target, mMinWall + 2 * mReach, ctx);
    }

    float reach() const { return mReach; }

    // The new distance at a place of distance d; d itself where nothing changes.
    float at(const Vec3f& place, float d) const {
        const Vec3f gradient = sampleGradient(mTarget.distance, place);
        const Vec3f normal = normalized(gradient);
        const Vec3f foot = dot(normal, normal) > 0 ? place - normal * d : place;
        std::array<std::uint32_t, kMixed> site;
        std::array<float, kMixed> squared;
        const std::size_t count = mNearest.nearest(foot, kMixed, site.data(), squared.data());
        float sum = 0, whole = 0, share = 0, wall = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const float near = 1 - squared[k] / (kMixedReach * kMixedReach);
            const bool same = dot(mTarget.normal[site[k]], normal) > 0 || dot(normal, normal) == 0;
            float weight = near > 0 && same ? near * near : 0;
            if (k == 0) weight = std::max(weight, 1e-6f);
            if (weight == 0) continue;
            const float s = mTarget.strength.empty() ? 1 : mTarget.strength[site[k]];
            sum += weight * distanceOver(site[k], foot, d);
            share += weight * s;
            if (!mWalls.empty()) wall += weight * mWalls[site[k]];
            whole += weight;
        }
        const float s = mStrength * share / whole;
        if (s == 0) return d;
        float phi = d + s * (sum / whole - d);
        if (!mWalls.empty()) phi = std::min(phi, d + std::max(0.f, 0.5f * (wall / whole - mMinWall)));
        return phi;
    }

private:
    // Distance to the relief as a site's chart continues at the foot. [voxels]
    float distanceOver(std::uint32_t site, const Vec3f& foot, float d) const {
        const Vec3f& n = mTarget.normal[site];
        const Vec3f off = foot - mTarget.point[site];
        const Vec2f flat = flattened(siteFrame(n, mMap.tangent[site]), off - n * dot(off, n));
        const Vec2f at = mMap.coordinate[site] + flat * (1 / mTexel);
        return mTexel * reliefDistance(mSamples[std::size_t(mMap.sample[site])], at, d / mTexel);
    }

    const ReliefTarget& mTarget;
    const std::vector<ReliefSample>& mSamples;
    const ReliefMap& mMap;
    float mTexel, mStrength, mReach, mMinWall;
    PointNeighbours mNearest;
    std::vector<float> mWalls;
};

}  // namespace

BrickField reliefOnTarget(const ReliefTarget& target, const std::vector<ReliefSample>& samples,
                          const ReliefMap& map, const ReliefTransferOptions& options, const RunContext& ctx) {
    validate(options);
    if (map.coordinate.size() != target.point.size() || map.sample.size() != target.point.size() ||
        map.tangent.size() != target.point.size())
        throw Error(ErrorCode::ShapeMismatch, "the map and the target's sites differ in number");
    return withThreads(ctx, [&] {
        const Edit edit(target, samples, map, options, ctx);
        if (target.reach < edit.reach())
            throw Error(ErrorCode::InvalidOption,
                        "the target's distances end nearer than the relief reaches");
        Stage stage(ctx, "relief on the target", 1);
        BrickField made =
            BrickField::generate(target.distance.box(), ctx, [&](const IndexBox& brick, float* values) {
                target.distance.readBox(brick.min, brick.size(), values);
                forEachVoxel(brick, [&](const Index3& p) {
                    const float d = *values;
                    float value = d;
                    if (std::abs(d) < edit.reach()) value = edit.at({float(p.x), float(p.y), float(p.z)}, d);
                    *values++ = std::clamp(value, -kLimit, kLimit);
                });
            });
        stage.advance();
        return made;
    });
}

}  // namespace vdbsynth
