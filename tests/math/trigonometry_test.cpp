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

TEST_CASE("arcTangent: the C library's within 1e-13 over the half circle", "[math][oracle]") {
    double worst = 0;
    for (int i = 0; i <= 20000; ++i) {
        const double angle = kPi * i / 20000, y = std::sin(angle) * 3, x = std::cos(angle) * 3;
        worst = std::max(worst, std::abs(arcTangent(std::max(0.0, y), x) - std::atan2(std::max(0.0, y), x)));
    }
    CHECK(worst < 1e-13);
    CHECK(arcTangent(0, 0) == 0);
    CHECK(arcTangent(0, -1) == kPi);
}
