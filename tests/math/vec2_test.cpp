#include "libvdbsynth/math/vec2.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("Vec2f: sums, differences, multiples and lengths by hand") {
    const Vec2f a{3, 4}, b{1, -2};
    CHECK((a + b).x == 4);
    CHECK((a + b).y == 2);
    CHECK((a - b).x == 2);
    CHECK((a - b).y == 6);
    CHECK((a * 2).y == 8);
    CHECK(dot(a, b) == -5);
    CHECK(length(a) == 5);
}
