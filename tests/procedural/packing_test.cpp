#include "libvdbsynth/procedural/packing.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("packBalls: no two balls overlap or touch, and they fill the box", "[procedural][property]") {
    for (std::uint64_t seed : {0, 1, 2}) {
        const std::vector<PackedBall> balls = packBalls({0, 0, 0}, {80, 80, 80}, 6, 8, 0.55, seed);
        double volume = 0;
        for (std::size_t i = 0; i < balls.size(); ++i) {
            volume += 4.18879 * balls[i].radius * balls[i].radius * balls[i].radius;
            for (std::size_t j = 0; j < i; ++j)
                REQUIRE(length(balls[i].centre - balls[j].centre) > balls[i].radius + balls[j].radius + 0.01);
        }
        CHECK(volume > 0.4 * 80 * 80 * 80);
    }
}
