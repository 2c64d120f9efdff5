#include "libvdbsynth/coordinates/coordinate_neighbourhood.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

Neighbourhood::Neighbourhood(const CoordinateLevel& level, std::size_t site, const char* only)
    : mLevel(level), mSample(level.samples[std::size_t(level.label[site])]), mSite(site) {
    const SiteFrame own = siteFrame(level.sites.normal[site], level.tangent[site]);
    const float toTexels = 1 / float(level.texel);
    for (std::size_t k = level.sites.begin[site]; k < level.sites.begin[site + 1]; ++k) {
        const std::uint32_t j = level.sites.neighbours[k];
        if (level.label[j] != level.label[site] || (only && !only[j])) continue;
        const SiteFrame frame = siteFrame(level.sites.normal[j], level.tangent[j]);
        const Vec3f difference = level.sites.point[site] - level.sites.point[j];
        const Vec2f offset = flattened(frame, difference) * toTexels;
        Continuation& c = mNear[mCount];
        c.here = level.coordinate[j] + offset;
        c.rotation = frameRotation(own, frame);
        c.place = rotated(offset, {-c.rotation.x, c.rotation.y});
        c.tangent = carried(level.tangent[j], level.sites.normal[j], level.sites.normal[site]);
        c.allowed = dot(c.tangent, level.field[site]) >= level.leastCosine - 1e-5f;
        if (++mCount == kMostNeighbours) break;
    }
}

void Neighbourhood::wanted(float* feature) const {
    std::array<float, 4 * kAppearance> taps{};
    std::array<int, 4> found{};
    for (std::size_t k = 0; k < mCount; ++k) {
        const std::size_t quadrant = (mNear[k].place.x >= 0 ? 1u : 0u) + (mNear[k].place.y >= 0 ? 2u : 0u);
        addTap(k, quadrant, taps.data() + quadrant * kAppearance);
        ++found[quadrant];
    }
    for (std::size_t q = 0; q < 4; ++q) {
        if (found[q] == 0) {
            addTap(nearestTo(q), q, taps.data() + q * kAppearance);
            continue;
        }
        const float share = 1 / float(found[q]);
        for (std::size_t d = 0; d < kAppearance; ++d) taps[q * kAppearance + d] *= share;
    }
    mSample.toFeature(taps.data(), feature);
}

Placed Neighbourhood::best(const float* feature, float jumpFactor, const SourceUse& use) const {
    const float jumpCost = kJump * float(mSample.spread);
    Choice choice{{mLevel.coordinate[mSite], mLevel.tangent[mSite]}};
    const std::int32_t own = mSample.node(choice.placed.at);
    take(choice.placed, own, costOf(own, feature) + jumpCost, use, choice);
    for (std::size_t k = 0; k < mCount; ++k)
        if (mNear[k].allowed)
            consider({mNear[k].here, mNear[k].tangent}, feature, jumpFactor, jumpCost, use, choice);
    Placed settled;
    return meanNear(choice.placed, settled) > 0 ? settled : choice.placed;
}

bool Neighbourhood::settled(Placed& mean) const {
    return meanNear({mLevel.coordinate[mSite], mLevel.tangent[mSite]}, mean) == mCount;
}

std::size_t Neighbourhood::meanNear(const Placed& placed, Placed& mean, float steps) const {
    const float reach = steps * float(mSample.step);
    Vec2f offset;
    Vec3f tangent;
    std::size_t count = 0;
    for (std::size_t k = 0; k < mCount; ++k) {
        const Vec2f off = mNear[k].here - placed.at;
        if (dot(off, off) > reach * reach || dot(mNear[k].tangent, placed.tangent) < kSameRotation) continue;
        offset = offset + off;
        tangent = tangent + mNear[k].tangent;
        ++count;
    }
    if (count == 0) return 0;
    mean.at = placed.at + offset * (1 / float(count));
    mean.tangent = tangentNear(mLevel.sites.normal[mSite], tangent);
    if (!mSample.isSource(mean.at) || dot(mean.tangent, mLevel.field[mSite]) < mLevel.leastCosine - 1e-5f)
        return 0;
    return count;
}

std::int32_t Neighbourhood::nearestNode(const float* feature) const {
    std::int32_t nearest = 0;
    float least = std::numeric_limits<float>::infinity();
    for (std::int32_t node = 0; node < mSample.width * mSample.height; ++node) {
        if (!mSample.isSource(mSample.centre(node))) continue;
        const float cost = costOf(node, feature);
        if (cost < least) {
            least = cost;
            nearest = node;
        }
    }
    return nearest;
}

void Neighbourhood::addTap(std::size_t k, std::size_t quadrant, float* sum) const {
    const Vec2f tap = mNear[k].here + rotated(kTaps[quadrant] * float(mSample.step), mNear[k].rotation);
    const float* a = mSample.appearance.data() + std::size_t(mSample.node(tap)) * kAppearance;
    for (std::size_t d = 0; d < kAppearance; ++d) sum[d] += a[d];
}

std::size_t Neighbourhood::nearestTo(std::size_t quadrant) const {
    std::size_t nearest = 0;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < mCount; ++k) {
        const Vec2f off = mNear[k].place - kTaps[quadrant] * float(mSample.step);
        if (dot(off, off) < least) {
            least = dot(off, off);
            nearest = k;
        }
    }
    return nearest;
}

float Neighbourhood::costOf(std::int32_t node, const float* feature) const {
    const float* f = mSample.feature.data() + std::size_t(node) * kFeature;
    float sum = 0;
    for (std::size_t d = 0; d < kFeature; ++d) sum += (f[d] - feature[d]) * (f[d] - feature[d]);
    return sum;
}

void Neighbourhood::take(const Placed& placed, std::int32_t node, float cost, const SourceUse& use,
                         Choice& choice) const {
    if (!mSample.isSource(placed.at)) return;
    cost += use.cost(mLevel.label[mSite], node);
    if (cost < choice.cost) choice = {placed, cost};
}

void Neighbourhood::consider(const Placed& placed, const float* feature, float jumpFactor, float jumpCost,
                             const SourceUse& use, Choice& choice) const {
    const std::int32_t node = mSample.node(placed.at);
    take(placed, node, costOf(node, feature), use, choice);
    // Texels like it, at the same place within the texel.
    const Vec2f within = mSample.isSource(placed.at) ? foldedIn(placed.at) - mSample.centre(node) : Vec2f{};
    const std::int32_t* like = mSample.similar.data() + std::size_t(node) * mSample.similarCount;
    for (std::size_t k = 0; k < mSample.similarCount && like[k] >= 0; ++k)
        take({mSample.centre(like[k]) + within, placed.tangent}, like[k],
             jumpCost + jumpFactor * costOf(like[k], feature), use, choice);
}

Vec2f Neighbourhood::foldedIn(const Vec2f& at) const {
    const float w = float(mSample.width * mSample.stride), h = float(mSample.height * mSample.stride);
    return {at.x - w * std::floor(at.x / w), at.y - h * std::floor(at.y / h)};
}

}  // namespace vdbsynth
