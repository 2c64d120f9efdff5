#include "libvdbsynth/coordinates/coordinate_level.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/coordinate_neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kExamined = 100000;     // sites, about, whose figures stand for the level's
constexpr std::size_t kOftenCounted = 50000;  // sites below which use is counted for every class
constexpr int kClasses = 32;
// [texels] between sites, up to which one that continues all its neighbours is not searched for: inside a
// piece of the sample its own place fits but for sampling noise, and three quarters of the time went there.
constexpr double kFinest = 1.5;

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

namespace {

// Which sites need no search: those that continued all their neighbours in the last pass, as these did.
class Settled {
public:
    Settled(const CoordinateLevel& level) : mOn(level.samples[0].step < kFinest), mSites(level.sites) {
        if (mOn) mSettled.assign(level.sites.size(), 0);
    }

    bool on() const { return mOn; }

    bool around(std::uint32_t site) const {
        if (!mOn || !mSettled[site]) return false;
        for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k)
            if (!mSettled[mSites.neighbours[k]]) return false;
        return true;
    }

    void set(std::uint32_t site, bool settled) {
        if (mOn) mSettled[site] = settled;
    }

private:
    bool mOn;
    const SurfaceSites& mSites;
    std::vector<char> mSettled;
};

struct Corrected {
    Placed placed;
    bool settled = false;
};

Corrected corrected(const CoordinateLevel& level, std::uint32_t site, const Settled& settled,
                    float jumpFactor, const SourceUse& use) {
    Corrected out{{level.coordinate[site], level.tangent[site]}, false};
    if (settled.around(site)) return {out.placed, true};
    const Neighbourhood near(level, site);
    if (near.empty()) return out;
    if (settled.on() && near.settled(out.placed)) return {out.placed, true};
    std::array<float, kFeature> feature;
    near.wanted(feature.data());
    return {near.best(feature.data(), jumpFactor, use), false};
}

}  // namespace

void correctCoordinates(CoordinateLevel& level, int passes, const CoordinateOptions& options,
                        const RunContext& ctx) {
    const std::vector<std::vector<std::uint32_t>> members = membersOf(siteClasses(level.sites));
    const float jumpFactor = 1 + float(options.coherence);
    std::vector<Corrected> now;
    SourceUse use(level, options.uniformity, options.histogram);
    Settled settled(level);
    // Where sites are many a class changes little of the counts.
    const bool often = level.sites.size() < kOftenCounted;
    for (int pass = 0; pass < passes; ++pass) {
        if (!often) use.count(level);
        for (const std::vector<std::uint32_t>& sites : members) {
            if (often) use.count(level);
            now.resize(sites.size());
            parallelFor(ctx, sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
                for (std::size_t m = begin; m < end; ++m)
                    now[m] = corrected(level, sites[m], settled, jumpFactor, use);
            });
            parallelFor(ctx, sites.size(), 16384, [&](std::size_t begin, std::size_t end) {
                for (std::size_t m = begin; m < end; ++m) {
                    level.coordinate[sites[m]] = now[m].placed.at;
                    level.tangent[sites[m]] = now[m].placed.tangent;
                    settled.set(sites[m], now[m].settled);
                }
            });
        }
    }
}

CoordinateLevelStats levelStats(const CoordinateLevel& level, const RunContext& ctx) {
    constexpr std::size_t kGrain = 4096;
    const std::size_t stride = 1 + level.sites.size() / kExamined;
    const std::size_t chunks = (level.sites.size() + kGrain - 1) / kGrain;
    std::vector<double> cost(chunks), coherent(chunks);
    std::vector<std::size_t> counted(chunks);
    parallelFor(ctx, level.sites.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::array<float, kFeature> feature;
        for (std::size_t i = begin; i < end; i += stride) {
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
    constexpr int kDraws = 64;  // where masks leave little
    Random random(seed, site, 0x7e0000u + level);
    const double m = double(sample.margin);
    Vec2f at;
    for (int draw = 0; draw < kDraws; ++draw) {
        const double x = random.uniform(m, double(sample.width) - m);
        const double y = random.uniform(m, double(sample.height) - m);
        at = {float(x * sample.stride), float(y * sample.stride)};
        if (sample.isSource(at)) return at;
    }
    const std::int32_t nodes = std::int32_t(sample.width * sample.height), drawn = sample.node(at);
    for (std::int32_t k = 1; k < nodes; ++k) {
        const Vec2f centre = sample.centre((drawn + k) % nodes);
        if (sample.isSource(centre)) return centre;
    }
    return at;
}

}  // namespace vdbsynth
