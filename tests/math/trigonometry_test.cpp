#include "libvdbsynth/math/trigonometry.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

TEST_CASE("sine, cosine: close to the C library, as the header says", "[math][oracle]") {
    for (int i = -20000; i <= 20000; ++i) {
        const double angle = i * 0.3711;
        REQUIRE(sine(angle) == Approx(std::sin(angle)).margin(1e-12));
        REQUIRE(cosine(angle) == Approx(std::cos(angle)).margin(1e-12));
    }
    for (int i = -700; i <= 700; ++i) {
        const double angle = i * 0.01;
        REQUIRE(std::abs(sine(angle) - std::sin(angle)) < 1e-14);
        REQUIRE(std::abs(cosine(angle) - std::cos(angle)) < 1e-14);
    }
}
