#include "libvdbsynth/coordinates/source_use.h"

#include "tests/support/sample_images.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// Sites that are nowhere in particular: only their coordinates count.
CoordinateLevel levelOf(std::vector<Vec2f> coordinates) {
    CoordinateLevel level;
    level.label.assign(coordinates.size(), 0);
    level.coordinate = std::move(coordinates);
    SampleImage ramp{64, 64, 1, true, {}};
    for (int i = 0; i < 64 * 64; ++i) ramp.values.push_back(float(i % 64));
    level.samples.push_back(sampleLevel(ramp, 4, 0));
    return level;
}

}  // namespace

TEST_CASE("SourceUse: even use costs nothing, more than its share costs, less is below zero") {
    std::vector<Vec2f> even, uneven;
    for (int i = 0; i < 64 * 64; ++i) {
        const Vec2f at{float(i % 64) + 0.5f, float(i / 64) + 0.5f};
        even.push_back(at);
        uneven.push_back({at.x / 2, at.y});  // the left half, twice as often
    }
    CoordinateLevel level = levelOf(even);
    const std::int32_t left = level.samples[0].node({10, 32}), right = level.samples[0].node({50, 32});
    SourceUse use(level, 1, 0);
    use.count(level);
    CHECK(double(use.cost(0, left)) == Approx(0).margin(0.05 * level.samples[0].spread));
    level.coordinate = uneven;
    use.count(level);
    CHECK(use.cost(0, left) > 0);
    CHECK(use.cost(0, right) < 0);
    // Twice the share and none of it: opposite.
    CHECK(use.cost(0, left) == Approx(-use.cost(0, right)).epsilon(0.1));
    SourceUse values(level, 0, 1);
    values.count(level);
    CHECK(values.cost(0, left) > 0);
    CHECK(values.cost(0, right) < 0);
}

TEST_CASE("SourceUse: without weights nothing costs anything") {
    const CoordinateLevel level = levelOf({{1, 1}, {1, 1}});
    SourceUse use(level, 0, 0);
    use.count(level);
    for (std::int32_t node = 0; node < 16 * 16; ++node) REQUIRE(use.cost(0, node) == 0);
}
