#include "libvdbsynth/coordinates/coordinate_level.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/site_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kMostNeighbours = 16;
constexpr int kClasses = 32;

// A neighbour as a site sees it.
struct Continuation {
    Vec2f here;   // [texels] where its coordinates continue to at the site
    Vec2f turn;   // from the site's frame to its own
    Vec2f place;  // [texels] of the neighbour, in the site's frame
};

// A site's neighbourhood and its candidates.
class Neighbourhood {
public:
    Neighbourhood(const CoordinateLevel& level, std::size_t site)
        : mLevel(level), mSample(level.samples[std::size_t(level.label[site])]), mSite(site) {
        const SiteFrame own = siteFrame(level.sites.normal[site], level.tangent[site]);
        const float toTexels = 1 / float(level.texel);
        for (std::size_t k = level.sites.begin[site]; k < level.sites.begin[site + 1]; ++k) {
            const std::uint32_t j = level.sites.neighbours[k];
            if (level.label[j] != level.label[site]) continue;
            const SiteFrame frame = siteFrame(level.sites.normal[j], level.tangent[j]);
            const Vec3f difference = level.sites.point[site] - level.sites.point[j];
            const Vec2f offset = flattened(frame, difference) * toTexels;
            Continuation& c = mNear[mCount];
            c.here = level.coordinate[j] + offset;
            c.turn = turnBetween(own, frame);
            c.place = turned(offset, {-c.turn.x, c.turn.y});
            if (++mCount == kMostNeighbours) break;
        }
    }

    bool empty() const { return mCount == 0; }
    std::size_t count() const { return mCount; }
    const Continuation& operator[](std::size_t k) const { return mNear[k]; }

    // The feature that would fit: appearances at the taps, as the neighbours continue to them.
    void wanted(float* feature) const {
        std::array<float, 4 * kAppearance> taps{};
        std::array<int, 4> found{};
        for (std::size_t k = 0; k < mCount; ++k) {
            const std::size_t quadrant =
                (mNear[k].place.x >= 0 ? 1u : 0u) + (mNear[k].place.y >= 0 ? 2u : 0u);
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

    // The best of the site's own coordinate, its neighbours' continuations and the texels like these.
    Vec2f best(const float* feature, float jumpFactor, float& cost) const {
        Vec2f chosen = mLevel.coordinate[mSite];
        cost = std::numeric_limits<float>::infinity();
        consider(mLevel.coordinate[mSite], feature, jumpFactor, chosen, cost);
        for (std::size_t k = 0; k < mCount; ++k) consider(mNear[k].here, feature, jumpFactor, chosen, cost);
        return chosen;
    }

private:
    void addTap(std::size_t k, std::size_t quadrant, float* sum) const {
        const Vec2f tap = mNear[k].here + turned(kTaps[quadrant] * float(mSample.step), mNear[k].turn);
        const float* a = mSample.appearance.data() + std::size_t(mSample.node(tap)) * kAppearance;
        for (std::size_t d = 0; d < kAppearance; ++d) sum[d] += a[d];
    }

    std::size_t nearestTo(std::size_t quadrant) const {
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

    float costOf(std::int32_t node, const float* feature) const {
        const float* f = mSample.feature.data() + std::size_t(node) * kFeature;
        float sum = 0;
        for (std::size_t d = 0; d < kFeature; ++d) sum += (f[d] - feature[d]) * (f[d] - feature[d]);
        return sum;
    }

    void take(const Vec2f& at, float candidate, Vec2f& chosen, float& cost) const {
        if (!(candidate < cost) || !mSample.isSource(at)) return;
        cost = candidate;
        chosen = at;
    }

    void consider(const Vec2f& at, const float* feature, float jumpFactor, Vec2f& chosen, float& cost) const {
        const std::int32_t node = mSample.node(at);
        take(at, costOf(node, feature), chosen, cost);
        // Texels like it, at the same place within the texel.
        const Vec2f within = mSample.isSource(at) ? foldedIn(at) - mSample.centre(node) : Vec2f{};
        const std::int32_t* like = mSample.similar.data() + std::size_t(node) * mSample.similarCount;
        for (std::size_t k = 0; k < mSample.similarCount && like[k] >= 0; ++k)
            take(mSample.centre(like[k]) + within, jumpFactor * costOf(like[k], feature), chosen, cost);
    }

    Vec2f foldedIn(const Vec2f& at) const {
        const float w = float(mSample.width * mSample.stride), h = float(mSample.height * mSample.stride);
        return {at.x - w * std::floor(at.x / w), at.y - h * std::floor(at.y / h)};
    }

    const CoordinateLevel& mLevel;
    const SampleLevel& mSample;
    std::size_t mSite;
    std::size_t mCount = 0;
    std::array<Continuation, kMostNeighbours> mNear;
};

// The members of every class, in the order of their numbers.
std::vector<std::vector<std::uint32_t>> membersOf(const std::vector<std::uint8_t>& classes) {
    std::vector<std::vector<std::uint32_t>> members;
    for (std::uint32_t i = 0; i < classes.size(); ++i) {
        if (classes[i] >= members.size()) members.resize(classes[i] + 1u);
        members[classes[i]].push_back(i);
    }
    return members;
}

}  // namespace

std::vector<std::uint8_t> siteClasses(const SurfaceSites& sites) {
    constexpr std::uint8_t kNone = 255;
    std::vector<std::uint8_t> classes(sites.size(), kNone);
    for (std::size_t i = 0; i < sites.size(); ++i) {
        std::uint32_t taken = 0;
        for (std::size_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k) {
            const std::uint8_t other = classes[sites.neighbours[k]];
            if (other != kNone) taken |= 1u << other;
        }
        std::uint8_t free = 0;
        while (free < kClasses - 1 && (taken >> free & 1u)) ++free;
        classes[i] = free;
    }
    return classes;
}

void correctCoordinates(CoordinateLevel& level, int passes, const CoordinateOptions& options,
                        const RunContext& ctx) {
    const std::vector<std::vector<std::uint32_t>> members = membersOf(siteClasses(level.sites));
    const float jumpFactor = 1 + float(options.coherence);
    std::vector<Vec2f> corrected;
    for (int pass = 0; pass < passes; ++pass)
        for (const std::vector<std::uint32_t>& sites : members) {
            corrected.resize(sites.size());
            parallelFor(ctx, sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
                std::array<float, kFeature> feature;
                for (std::size_t m = begin; m < end; ++m) {
                    const Neighbourhood near(level, sites[m]);
                    corrected[m] = level.coordinate[sites[m]];
                    if (near.empty()) continue;
                    near.wanted(feature.data());
                    float cost = 0;
                    corrected[m] = near.best(feature.data(), jumpFactor, cost);
                }
            });
            for (std::size_t m = 0; m < sites.size(); ++m) level.coordinate[sites[m]] = corrected[m];
        }
}

CoordinateLevelStats levelStats(const CoordinateLevel& level, const RunContext& ctx) {
    constexpr std::size_t kGrain = 4096;
    const std::size_t chunks = (level.sites.size() + kGrain - 1) / kGrain;
    std::vector<double> cost(chunks), coherent(chunks);
    std::vector<std::size_t> counted(chunks);
    parallelFor(ctx, level.sites.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::array<float, kFeature> feature;
        for (std::size_t i = begin; i < end; ++i) {
            const Neighbourhood near(level, i);
            if (near.empty()) continue;
            near.wanted(feature.data());
            const SampleLevel& sample = level.samples[std::size_t(level.label[i])];
            const float* own =
                sample.feature.data() + std::size_t(sample.node(level.coordinate[i])) * kFeature;
            double squared = 0;
            for (std::size_t d = 0; d < kFeature; ++d)
                squared += double((own[d] - feature[d]) * (own[d] - feature[d]));
            bool continues = false;
            for (std::size_t k = 0; k < near.count() && !continues; ++k)
                continues = length(near[k].here - level.coordinate[i]) < 0.5f * float(sample.step);
            cost[begin / kGrain] += squared;
            coherent[begin / kGrain] += continues;
            ++counted[begin / kGrain];
        }
    });
    CoordinateLevelStats stats;
    double sites = 0;
    for (std::size_t c = 0; c < chunks; ++c) {
        stats.cost += cost[c];
        stats.coherent += coherent[c];
        sites += double(counted[c]);
    }
    if (sites > 0) {
        stats.cost /= sites;
        stats.coherent /= sites;
    }
    if (!level.samples.empty()) stats.step = level.samples[0].step;
    return stats;
}

Vec2f randomSource(const SampleLevel& sample, std::uint64_t seed, std::uint64_t site, std::uint32_t level) {
    Random random(seed, site, 0x7e0000u + level);
    const double m = double(sample.margin);
    const double x = random.uniform(m, double(sample.width) - m);
    const double y = random.uniform(m, double(sample.height) - m);
    return {float(x * sample.stride), float(y * sample.stride)};
}

}  // namespace vdbsynth
