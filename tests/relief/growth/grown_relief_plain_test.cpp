#include "libvdbsynth/relief/growth/grown_relief.h"
#include "tests/support/relief_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

constexpr int kSide = 36;

struct Case {
    test::SineRelief sine;
    ReliefSites sample = test::sineSample(sine, kSide);
    ReliefDistance distance = test::sineDistance(sine, kSide);
};

// The method as it is written, by linear scans; the best match only.
GrownRelief grownPlainly(const Case& c, const SurfaceSites& target, const std::vector<Vec3f>& tangent,
                         const GrownReliefOptions& o) {
    const std::vector<ReliefFrame> to = reliefFrames(c.sample.sites, c.sample.tangent);
    const std::vector<ReliefFrame> from = reliefFrames(target, tangent);
    const ReliefNeighbourhoods near = reliefNeighbourhoods(target, o.neighbourhood, o.weightFalloff);
    GrownRelief grown;
    grown.source.assign(target.size(), 0);
    grown.order.assign(target.size(), 0);
    grown.displacement.assign(target.size(), {});
    std::vector<char> done(target.size(), 0);
    std::uint32_t count = 0;
    const auto take = [&](std::size_t t, std::uint32_t s) {
        grown.source[t] = s;
        grown.displacement[t] = mapped(c.sample.displacement[s], to[s], from[t]);
        grown.order[t] = count++;
        done[t] = 1;
    };
    const std::uint32_t first = std::uint32_t(o.targetSite), seed = std::uint32_t(o.seedSite);
    take(first, seed);
    for (std::size_t k = near.begin[first]; k < near.begin[first + 1]; ++k) {
        const std::uint32_t v = near.member[k];
        const Vec3f place =
            to[seed].point + mapped(target.point[v] - target.point[first], from[first], to[seed]);
        std::uint32_t nearest = 0;
        for (std::uint32_t s = 0; s < to.size(); ++s)
            if (length(to[s].point - place) < length(to[nearest].point - place)) nearest = s;
        take(v, nearest);
    }
    while (count < target.size()) {
        std::size_t next = 0, most = 0;
        for (std::size_t t = 0; t < target.size(); ++t) {
            std::size_t textured = 0;
            for (std::size_t k = near.begin[t]; k < near.begin[t + 1]; ++k) textured += done[near.member[k]];
            if (done[t] || textured <= most) continue;
            most = textured;
            next = t;
        }
        std::uint32_t best = 0;
        float least = 1e30f;
        for (std::uint32_t s = 0; s < to.size(); ++s) {
            float sum = 0;
            for (std::size_t k = near.begin[next]; k < near.begin[next + 1]; ++k) {
                const std::uint32_t v = near.member[k];
                if (!done[v]) continue;
                const Vec3f place =
                    from[next].toLocal(target.point[v] - target.point[next] + grown.displacement[v]);
                sum += near.weight[k] *
                       c.distance.squared(c.distance.toVoxels(to[s].point) + to[s].toWorld(place));
            }
            if (sum < least) {
                least = sum;
                best = s;
            }
        }
        take(next, best);
    }
    return grown;
}

}  // namespace

TEST_CASE("growRelief: the same as the method written plainly, by linear scans") {
    const Case c;
    for (const test::PointShape& shape : {test::randomPlane(250, 16), test::spiralSphere(250, 10)}) {
        const SurfaceSites target = test::sitesOf(shape);
        const std::vector<Vec3f> tangent(target.size(), {0.8f, 0.6f, 0.1f});
        GrownReliefOptions o;
        o.neighbourhood = 3;
        o.top = 0;
        o.targetSite = 77;
        o.seedSite = 18 * kSide + 17;
        const GrownRelief grown = growRelief(c.sample, c.distance, target, tangent, o);
        const GrownRelief plain = grownPlainly(c, target, tangent, o);
        CHECK(grown.order == plain.order);
        CHECK(grown.source == plain.source);
        CHECK(grown.seeds == 1);
    }
}
