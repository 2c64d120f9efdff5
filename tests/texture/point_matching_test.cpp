#include "libvdbsynth/texture/point_matching.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "tests/support/contexts.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

#include <limits>
#include <set>

using namespace vdbsynth;

namespace {

MatchLevel levelOf(const TextureTarget& target, int neighbours, int channels) {
    const PointSurface surface = pointSurface(target, neighbours);
    MatchLevel level;
    level.sites = surface.sites;
    level.tangent = siteTangents(surface, {});
    level.texel = surface.spacing;
    level.coloured.assign(level.sites.size(), 0);
    level.coordinate.assign(level.sites.size(), {});
    level.values.assign(level.sites.size() * std::size_t(channels), 0.f);
    return level;
}

// All but one site coloured at random, so that only its own match is left.
void colourAllBut(MatchLevel& level, std::size_t site, int channels) {
    for (std::size_t i = 0; i < level.sites.size(); ++i) {
        level.coloured[i] = i != site && i % 5 != 0;
        for (int c = 0; c < channels; ++c)
            level.values[i * std::size_t(channels) + std::size_t(c)] =
                float(Random(6, i * 4 + std::size_t(c)).uniform());
    }
}

// A neighbour as the oracle sees it: where it is compared, in which image, with what.
struct Compared {
    Vec2f by;
    const SampleImage* image;
    const float* colour;
};

std::vector<Compared> neighbourhood(const MatchLevel& level, std::size_t i, const SampleImage& sample,
                                    const MatchLevel* coarser, const SampleImage* enlarged) {
    const SiteFrame frame = siteFrame(level.sites.normal[i], level.tangent[i]);
    const auto place = [&](const Vec3f& point) {
        const Vec2f by = flattened(frame, point - level.sites.point[i]) * float(1 / level.texel);
        return Vec2f{std::floor(by.x * 8 + 0.5f) / 8, std::floor(by.y * 8 + 0.5f) / 8};
    };
    const std::size_t channels = std::size_t(sample.channels);
    std::vector<Compared> all;
    std::set<std::uint32_t> parents;
    if (coarser) parents.insert(level.parent[i]);
    for (std::size_t k = level.sites.begin[i]; k < level.sites.begin[i + 1]; ++k) {
        const std::uint32_t j = level.sites.neighbours[k];
        if (coarser) parents.insert(level.parent[j]);
        if (level.coloured[j])
            all.push_back({place(level.sites.point[j]), &sample, level.values.data() + j * channels});
    }
    for (const std::uint32_t p : parents)
        all.push_back({place(coarser->sites.point[p]), enlarged, coarser->values.data() + p * channels});
    return all;
}

// The oracle: the best of all texels, read one by one.
int bestTexel(const std::vector<Compared>& all, const SampleImage& sample) {
    double best = std::numeric_limits<double>::infinity();
    int texel = -1;
    for (int t = 0; t < int(sample.texels()); ++t) {
        double cost = 0;
        bool inside = true;
        for (const Compared& one : all) {
            const float x = float(t % sample.width) + one.by.x, y = float(t / sample.width) + one.by.y;
            if (!sample.tileable &&
                (x < 0 || y < 0 || x > float(sample.width - 1) || y > float(sample.height - 1)))
                inside = false;
            float read[4];
            readLinear(*one.image, {x + 0.5f, y + 0.5f}, read);
            for (int c = 0; c < sample.channels; ++c) {
                const double d = double(read[c]) - double(one.colour[c]);
                cost += d * d;
            }
        }
        if (inside && cost < best) {
            best = cost;
            texel = t;
        }
    }
    return texel;
}

// Takes the sites that have no colour out of the graph, but one, and calls them coloured.
void leaveOnly(MatchLevel& level, std::size_t site) {
    std::vector<std::uint32_t> begin{0}, neighbours;
    for (std::size_t i = 0; i < level.sites.size(); ++i) {
        for (std::size_t k = level.sites.begin[i]; k < level.sites.begin[i + 1]; ++k) {
            const std::uint32_t j = level.sites.neighbours[k];
            if (level.coloured[j] || j == site) neighbours.push_back(j);
        }
        begin.push_back(std::uint32_t(neighbours.size()));
    }
    level.sites.begin = begin;
    level.sites.neighbours = neighbours;
    for (std::size_t i = 0; i < level.sites.size(); ++i) level.coloured[i] = i != site;
}

void checkAgainstOracle(const SampleImage& sample, bool twoLevels, const RunContext& ctx = {}) {
    const TextureTarget target = test::targetOf(test::spiralSphere(900, 1));
    PointMatchingOptions options;
    options.neighbours = 16;
    const SampleImage half = halved(sample);
    SampleImage enlarged = sample;
    for (int t = 0; t < int(sample.texels()); ++t)
        readLinear(half, {(float(t % sample.width) + 0.5f) * 0.5f, (float(t / sample.width) + 0.5f) * 0.5f},
                   enlarged.values.data() + t * sample.channels);
    for (const std::size_t site : {0u, 100u, 355u, 700u, 899u}) {
        MatchLevel level = levelOf(target, 16, sample.channels);
        colourAllBut(level, site, sample.channels);
        MatchLevel coarser = coarserLevel(level, 16);
        leaveOnly(level, site);
        const int expected =
            bestTexel(neighbourhood(level, site, sample, twoLevels ? &coarser : nullptr, &enlarged), sample);
        matchLevel(level, sample, twoLevels ? &coarser : nullptr, twoLevels ? &half : nullptr, options, ctx);
        CHECK(level.coordinate[site].x == float(expected % sample.width) + 0.5f);
        CHECK(level.coordinate[site].y == float(expected / sample.width) + 0.5f);
        CHECK(level.values[site * std::size_t(sample.channels)] ==
              sample.texel(expected % sample.width, expected / sample.width)[0]);
    }
}

// A lattice of points with a block coloured from the sample, and what colours all have in the end.
void checkContinues(bool coherent) {
    const SampleImage sample = test::noiseSample(40, 3, true);
    const TextureTarget target = test::targetOf(test::latticePlane(40));
    MatchLevel level = levelOf(target, 24, 3);
    const auto texelOf = [&](std::size_t i) {
        return sample.texel((int(level.sites.point[i].x) + 7) % 40, (int(level.sites.point[i].y) + 11) % 40);
    };
    for (std::size_t i = 0; i < level.sites.size(); ++i) {
        const Vec3f& p = level.sites.point[i];
        if (p.x < 8 || p.x >= 14 || p.y < 8 || p.y >= 14) continue;
        level.coloured[i] = 1;
        level.coordinate[i] = {std::fmod(p.x + 7.5f, 40.f), std::fmod(p.y + 11.5f, 40.f)};
        std::copy_n(texelOf(i), 3, level.values.begin() + std::ptrdiff_t(3 * i));
    }
    PointMatchingOptions options;
    options.neighbours = 24;
    options.coherent = coherent;
    const double compared = matchLevel(level, sample, nullptr, nullptr, options);
    if (coherent) CHECK(compared / 1600 < 25);
    for (std::size_t i = 0; i < level.sites.size(); ++i) REQUIRE(level.values[3 * i + 1] == texelOf(i)[1]);
}

}  // namespace

TEST_CASE("matchLevel: the best of all texels, as a plain search finds it") {
    for (const bool twoLevels : {false, true}) {
        checkAgainstOracle(test::noiseSample(24, 3, true), twoLevels);
        checkAgainstOracle(test::noiseSample(24, 3, false), twoLevels);
        checkAgainstOracle(test::cloudSample(41, 1, false), twoLevels);
        checkAgainstOracle({50, 18, 1, true, test::noiseSample(30, 1, true).values}, twoLevels);
    }
}

TEST_CASE("matchLevel: reading between texels as it goes finds the same") {
    RunContext little;
    little.maxMemory = 2000000;  // too little for all phases
    checkAgainstOracle(test::noiseSample(24, 3, false), true, little);
    const TextureTarget target = test::targetOf(test::spiralSphere(500, 1));
    const SampleImage sample = test::cloudSample(20, 3, false);
    PointMatchingOptions options;
    options.levels = 2;
    CHECK(matchPoints(target, sample, options).sites.values ==
          matchPoints(target, sample, options, little).sites.values);
}

TEST_CASE("matchLevel: on a lattice it continues what it is given") {
    checkContinues(false);
    checkContinues(true);
}

TEST_CASE("matchLevel: of equal texels the first is taken") {
    const SampleImage flat{16, 16, 1, true, std::vector<float>(256, 0.5f)};
    MatchLevel level = levelOf(test::targetOf(test::latticePlane(6)), 8, 1);
    level.coloured[0] = 1;
    level.values[0] = 0.5f;
    level.coordinate[0] = {0.5f, 0.5f};
    matchLevel(level, flat, nullptr, nullptr, {});
    for (std::size_t i = 0; i < level.sites.size(); ++i) {
        CHECK(level.coordinate[i].x == 0.5f);
        CHECK(level.coordinate[i].y == 0.5f);
    }
}

TEST_CASE("matchPoints: colours are the sample's, on all levels, and levels shrink by four") {
    const SampleImage sample = test::cloudSample(32, 3, false);
    const TextureTarget target = test::targetOf(test::spiralSphere(3000, 1));
    for (const int levels : {1, 3})
        for (const bool coherent : {false, true}) {
            PointMatchingOptions options;
            options.levels = levels;
            options.coherent = coherent;
            const PointMatchingResult result = matchPoints(target, sample, options);
            REQUIRE(result.levelSites.size() == std::size_t(levels));
            CHECK(result.levelSites.back() == 3000);
            if (levels > 1) {
                CHECK(result.levelSites[1] > 730);
                CHECK(result.levelSites[1] < 800);
            }
            if (coherent) CHECK(result.tried < 60);
            for (std::size_t i = 0; i < 3000; ++i) {
                const float* texel = nearestTexel(sample, result.sites.coordinate[i]);
                REQUIRE(result.sites.values[3 * i + 2] == texel[2]);
                REQUIRE(result.sites.sample[i] == 0);
                REQUIRE_FALSE(result.sites.blended[i]);
            }
            const double ratio =
                test::contrast(result.sites.values, 3, 0) / test::contrast(sample.values, 3, 0);
            CHECK(ratio > 0.5);
            CHECK(ratio < 1.5);
        }
}

TEST_CASE("halved: means of two by two, odd sides rounded up") {
    const SampleImage half = halved({3, 2, 1, false, {1, 2, 3, 5, 6, 7}});
    CHECK(half.width == 2);
    CHECK(half.height == 1);
    CHECK(half.values == std::vector<float>{3.5f, 5});
}

TEST_CASE("coarserLevel: coloured where all members are, with their mean") {
    MatchLevel level = levelOf({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4.5f, 0, 0}},
                                std::vector<Vec3f>(5, {0, 0, 1}),
                                {},
                                {}},
                               4, 1);
    level.values = {1, 2, 3, 4, 7};
    level.coloured = {1, 1, 1, 1, 0};
    level.coordinate[0] = {8, 6};
    const MatchLevel coarser = coarserLevel(level, 4);
    REQUIRE(coarser.sites.size() == 2);
    const std::size_t four = level.parent[0], one = level.parent[4];
    CHECK(coarser.values[four] == 2.5f);
    CHECK(coarser.coloured[four] == 1);
    CHECK(coarser.coloured[one] == 0);
    CHECK(coarser.coordinate[four].x == 4);
    CHECK(coarser.texel == Approx(2 * level.texel));
}

TEST_CASE("matchPoints: degenerate targets and samples are coloured") {
    const std::vector<Vec3f> up(3, {0, 0, 1});
    std::vector<TextureTarget> targets;
    targets.push_back({{{0, 0, 0}}, {{0, 0, 1}}, {}, {}});
    targets.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up, {}, {}});
    targets.push_back({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, up, {}, {}});
    targets.push_back({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, up, {}, {}});
    targets.push_back({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, up, {}, {}});
    targets.push_back({{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 0, -1}}, {}, {}});
    targets.push_back(test::targetOf(test::spiralSphere(200, 1)));
    for (const TextureTarget& target : targets)
        for (const SampleImage& sample :
             {SampleImage{1, 1, 1, false, {0.3f}}, test::noiseSample(3, 1, false)})
            for (const int levels : {1, 4}) {
                PointMatchingOptions options;
                options.levels = levels;
                const PointMatchingResult result = matchPoints(target, sample, options);
                for (std::size_t i = 0; i < target.point.size(); ++i)
                    REQUIRE(result.sites.values[i] == nearestTexel(sample, result.sites.coordinate[i])[0]);
            }
}

TEST_CASE("matchPoints: bad arguments, cancel, threads") {
    const TextureTarget target = test::targetOf(test::spiralSphere(3000, 1));
    const SampleImage sample = test::cloudSample(24, 3, false);
    const auto call = [&](const PointMatchingOptions& options) { matchPoints(target, sample, options); };
    const auto refused = [&](const char* field, const auto& change) {
        test::requireRefused<PointMatchingOptions>(call, field, change);
    };
    refused("neighbours", [](PointMatchingOptions& o) { o.neighbours = 1; });
    refused("scale", [](PointMatchingOptions& o) { o.scale = -1; });
    refused("levels", [](PointMatchingOptions& o) { o.levels = 9; });
    refused("up", [](PointMatchingOptions& o) { o.orientation.up = {0, 0, 0}; });
    PointMatchingOptions two;
    two.levels = 2;
    CHECK(matchPoints(target, sample, two, test::onThreads(1)).sites.values ==
          matchPoints(target, sample, two, test::onThreads(4)).sites.values);
    const auto thrown =
        test::thrownWhenCancelled([&](const RunContext& ctx) { matchPoints(target, sample, two, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
