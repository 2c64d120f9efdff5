#include "libvdbsynth/coordinates/coordinate_charts.h"

#include "tests/support/contexts.h"
#include "tests/support/coordinate_levels.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("layCharts: a tileable sample covers a plane in one piece") {
    SampleImage tile = test::noiseSample(32, 32);
    tile.tileable = true;
    CoordinateLevel level = test::planeLevel(50, tile, 0);
    layCharts(level, 0);
    const Vec2f origin = level.coordinate[0];
    for (std::size_t i = 0; i < level.sites.size(); ++i) {
        const Vec2f expected = origin + Vec2f{level.sites.point[i].x, level.sites.point[i].y};
        REQUIRE(length(level.coordinate[i] - expected) < 1e-3f);
    }
}

TEST_CASE("layCharts: of a sample that ends, every site gets a source, most continue a neighbour") {
    CoordinateLevel level = test::planeLevel(60, test::noiseSample(32, 32), 0);
    layCharts(level, 0);
    for (const Vec2f& u : level.coordinate) REQUIRE(level.samples[0].isSource(u));
    CHECK(levelStats(level).coherent > 0.95);
}

TEST_CASE("layCharts: sites without neighbours, cancel") {
    CoordinateLevel level = test::planeLevel(1, test::noiseSample(8, 8), 0);
    layCharts(level, 0);
    CHECK(level.samples[0].isSource(level.coordinate[0]));
    const auto thrown = test::thrownWhenCancelled([&](const RunContext& ctx) { layCharts(level, 0, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
