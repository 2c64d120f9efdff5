#include "libvdbsynth/relief/growth/relief_match.h"

#include "libvdbsynth/grid/field_sampling.h"
#include "tests/support/contexts.h"
#include "tests/support/relief_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

constexpr int kSide = 32;

struct Case {
    test::SineRelief sine;
    ReliefSites sample = test::sineSample(sine, kSide);
    BrickField band = test::sineBand(sine, kSide, 6, 6);
    ReliefDistance distance{band, {0, 0, -6}, 1, 6};
    ReliefNeighbourhoods neighbourhoods = reliefNeighbourhoods(sample.sites, 4, 0.5);
    ReliefMatcher matcher{reliefFrames(sample.sites, sample.tangent), distance};

    std::vector<ReliefTerm> termsOf(std::size_t t) const {
        std::vector<ReliefTerm> terms;
        matcher.terms(reliefFrames(sample.sites, sample.tangent)[t], sample.sites, sample.displacement,
                      neighbourhoods, t, nullptr, terms);
        return terms;
    }
};

// The oracle of one sum: eq. 1 as it is written, by the plain reader of fields, nothing left early.
double plainCost(const Case& c, std::size_t t, std::size_t s, double* insideMean = nullptr) {
    double sum = 0, insideSum = 0, weights = 0;
    const SurfaceSites& sites = c.sample.sites;
    for (std::size_t k = c.neighbourhoods.begin[t]; k < c.neighbourhoods.begin[t + 1]; ++k) {
        const std::uint32_t v = c.neighbourhoods.member[k];
        const Vec3f place =
            sites.point[v] + c.sample.displacement[v] - sites.point[t] + sites.point[s] + Vec3f{0, 0, 6};
        const bool inside = place.x >= 0 && place.x < kSide && place.y >= 0 && place.y < kSide &&
                            place.z >= 0 && place.z < 12;
        const double d = inside ? double(sampleTrilinear(c.band, place)) : 6;
        const double w = double(c.neighbourhoods.weight[k]);
        sum += w * std::min(d * d, 36.0);
        insideSum += inside ? w * std::min(d * d, 36.0) : 0;
        weights += inside ? w : 0;
    }
    if (insideMean) *insideMean = weights > 0 ? insideSum / weights : -1;
    return sum;
}

}  // namespace

TEST_CASE("ReliefMatcher: a site with itself costs about nothing, half a wave off twice the height") {
    const Case c;
    const std::uint32_t t = 16 * kSide + 15;
    CHECK(plainCost(c, t, t) < 0.02);
    const ReliefFrame& frame = c.matcher.frame(t);
    CHECK(c.matcher.cost(frame, c.termsOf(t), 1e9f) == Approx(plainCost(c, t, t)).margin(1e-3));
    CHECK(plainCost(c, t, t + 6) > 10);
}

TEST_CASE("ReliefMatcher: best is the same as a linear scan, whatever is looked at first") {
    const Case c;
    for (std::uint32_t t : {5u, 200u, 527u, 1000u}) {
        const std::vector<ReliefTerm> terms = c.termsOf(t);
        std::vector<ReliefMatch> scan;
        for (std::uint32_t s = 0; s < c.matcher.size(); ++s) {
            const float cost = c.matcher.cost(c.matcher.frame(s), terms, 1e30f);
            REQUIRE(cost == Approx(plainCost(c, t, s)).margin(2e-3).epsilon(1e-3));
            scan.push_back({cost, s});
        }
        std::sort(scan.begin(), scan.end());
        for (std::size_t count : {std::size_t(1), std::size_t(7), std::size_t(100), c.matcher.size() + 5})
            for (const std::vector<std::uint32_t>& likely :
                 {std::vector<std::uint32_t>{}, {t}, {t, t, t, 3, 3, 4, 5, 9, 900, t + 1, t + 2}}) {
                const auto best = c.matcher.best(terms, count, likely);
                REQUIRE(best.size() == std::min(count, c.matcher.size()));
                for (std::size_t k = 0; k < best.size(); ++k) {
                    REQUIRE(best[k].site == scan[k].site);
                    REQUIRE(best[k].cost == scan[k].cost);
                }
            }
    }
}

TEST_CASE("assignedMismatch: the sample onto itself, and against a plain sum") {
    const Case c;
    const std::vector<ReliefFrame> own = reliefFrames(c.sample.sites, c.sample.tangent);
    const ReliefMismatch self = assignedMismatch(c.sample, own, c.distance, c.neighbourhoods);
    CHECK(self.sites == c.sample.sites.size());
    CHECK(self.mean < 0.001);
    CHECK(self.capped < 0.01);
    // Any other assignment.
    std::vector<ReliefFrame> shifted = own;
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t t = 0; t < own.size(); ++t) {
        const std::size_t s = (t * 7 + 11) % own.size();
        shifted[t] = own[s];
        double mean = 0;
        plainCost(c, t, s, &mean);
        if (mean < 0) continue;
        sum += mean;
        ++counted;
    }
    const ReliefMismatch other = assignedMismatch(c.sample, shifted, c.distance, c.neighbourhoods);
    CHECK(other.mean == Approx(sum / double(counted)).epsilon(1e-3));
    CHECK(other.outside > 0.01);
    CHECK(other.capped < 0.5);
    CHECK(bestMismatch(c.sample, c.sample, c.distance, c.neighbourhoods).mean <= self.mean);
}

TEST_CASE("assignedMismatch: world units, no neighbours, errors, threads, cancel") {
    const Case c;
    const std::vector<ReliefFrame> own = reliefFrames(c.sample.sites, c.sample.tangent);
    // Everything half as large: a quarter of the mean square.
    ReliefSites half = c.sample;
    for (std::size_t i = 0; i < own.size(); ++i) {
        half.sites.point[i] = half.sites.point[i] * 0.5f;
        half.displacement[i] = half.displacement[i] * 0.25f;  // and half the amplitude wrong
    }
    const ReliefDistance halved(c.band, {0, 0, -3}, 0.5, 6);
    ReliefSites wrong = c.sample;
    for (Vec3f& d : wrong.displacement) d = d * 0.5f;
    CHECK(assignedMismatch(half, reliefFrames(half.sites, half.tangent), halved,
                           reliefNeighbourhoods(half.sites, 2, 0.5))
              .mean ==
          Approx(assignedMismatch(wrong, own, c.distance, c.neighbourhoods).mean / 4).epsilon(0.02));

    const ReliefSites single{sitesOfPoints({{3, 3, 0}}, {{0, 0, 1}}, 8), {{1, 0, 0}}, {{0, 0, 0}}};
    CHECK(assignedMismatch(single, {own[0]}, c.distance, reliefNeighbourhoods(single.sites, 1, 0.5)).sites ==
          0);
    CHECK(test::thrownBy([&] { assignedMismatch(c.sample, {}, c.distance, c.neighbourhoods); }).code ==
          int(ErrorCode::ShapeMismatch));
    const auto on = [&](int threads) {
        return assignedMismatch(wrong, own, c.distance, c.neighbourhoods, test::onThreads(threads)).mean;
    };
    CHECK(on(1) == on(4));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              bestMismatch(c.sample, c.sample, c.distance, c.neighbourhoods, ctx);
          }).code == int(ErrorCode::Cancelled));
}
