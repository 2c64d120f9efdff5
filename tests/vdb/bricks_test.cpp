#include "libvdbsynth/vdb/bricks.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("scatterBricks, gatherBricks: there and back is the identity, at any alignment",
          "[vdb][property]") {
    openvdb::initialize();
    const BrickField field = test::ballsField({37, 41, 30}, 1, 3.f);
    for (const Index3& corner : {Index3{0, 0, 0}, Index3{-13, 5, 127}, Index3{3, -8, -1}}) {
        const FloatGridPtr grid = scatterBricks(field, corner, 0.5f, 3.f);
        CHECK(grid->background() == 1.5f);
        const IndexBox box{corner, corner + Index3{36, 40, 29}};
        CHECK(test::samplesOf(gatherBricks(*grid, box, 2.f, 3.f)) == test::samplesOf(field));
        // Only the band is active; the deep inside is inactive and negative.
        for (auto it = grid->cbeginValueOn(); it; ++it) REQUIRE(std::abs(*it) < 1.5f);
    }
}

TEST_CASE("gatherBricks: a million-voxel box of nothing stores nothing", "[vdb][degenerate]") {
    const auto grid = openvdb::FloatGrid::create(3.f);
    const BrickField field = gatherBricks(*grid, IndexBox::fromSize({800, 700, 900}), 1.f, 3.f);
    CHECK(field.storedBricks() == 0);
    CHECK(field.at({5, 5, 5}) == 3.f);
}

TEST_CASE("scatterBricks: the same tree for any number of threads", "[vdb][determinism]") {
    const BrickField field = test::ballsField({60, 60, 60}, 2, 3.f);
    RunContext one, two;
    one.threads = 1;
    two.threads = 2;
    CHECK(levelSetHash(*scatterBricks(field, {1, 2, 3}, 1.f, 3.f, one)) ==
          levelSetHash(*scatterBricks(field, {1, 2, 3}, 1.f, 3.f, two)));
}

TEST_CASE("gatherWideBand: distances in voxels of a level set in the world, its box moved to 0",
          "[vdb][oracle]") {
    const BrickField ball = test::fieldFrom({64, 64, 64}, [](const Index3& p) {
        const double d = length(Vec3d{p.x - 31.5, p.y - 31.5, p.z - 31.5}) - 18;
        return float(std::clamp(d, -3.0, 3.0));
    });
    const FloatGridPtr grid = scatterBricks(ball, {-5, 0, 7}, 0.25f, 3.f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    const BrickField wide = gatherWideBand(*grid, {{-5, 0, 7}, {58, 63, 70}}, {}, 8.f);
    for (int i = 0; i < 64; ++i) {
        const double d = std::clamp(std::abs(i - 31.5) - 18.0, -8.0, 8.0);
        CHECK(double(wide.at({i, 31, 32})) == Approx(d).margin(0.06));
    }
}

TEST_CASE("gatherKnownBand, gatherWideBand: caps of a clipped model do not count", "[vdb][property]") {
    // A rod along x, clipped at both ends; without its caps it goes on for ever.
    const BrickField rod = test::fieldFrom({40, 40, 40}, [](const Index3& p) {
        return float(std::clamp(std::hypot(p.y - 19.5, p.z - 19.5) - 9, -3.0, 3.0));
    });
    const IndexBox domain = rod.box();
    const FloatGridPtr grid = scatterBricks(closeField(rod, domain, kAllCut, 3.f), {0, 0, 0}, 1.f, 3.f);
    REQUIRE(grid->tree().getValue({0, 19, 19}) == -0.5f);
    const BrickField wide = gatherWideBand(*grid, domain, kAllCut, 8.f);
    for (int x = 0; x < 40; ++x) CHECK(double(wide.at({x, 19, 19})) == Approx(-8).margin(0.6));
    const BrickField capped = gatherWideBand(*grid, domain, {}, 8.f);
    CHECK(double(capped.at({0, 19, 19})) == Approx(-0.5).margin(0.05));
    CHECK(gatherKnownBand(*grid, domain, {}, 4).domain == IndexBox{{4, 4, 4}, {43, 43, 43}});
    CHECK(gatherKnownBand(*grid, domain, kAllCut, 4).domain == domain);
}
