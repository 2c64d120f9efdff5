#include "libvdbsynth/math/trigonometry.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far a value is from what the long one is.
double off(double value, long double exact) {
    return double(std::abs((long double)(value)-exact));
}

}  // namespace

TEST_CASE("sine, cosine: within what the header says of long doubles", "[math][oracle]") {
    double near = 0, far = 0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        Random random(1, i);
        const double small = random.uniform(-7, 7), large = random.uniform(-1e4, 1e4);
        near = std::max({near, off(sine(small), sinl(small)), off(cosine(small), cosl(small))});
        far = std::max({far, off(sine(large), sinl(large)), off(cosine(large), cosl(large))});
    }
    CHECK(near < 1e-15);
    CHECK(far < 1e-12);
    CHECK(sine(0) == 0);
    CHECK(cosine(0) == 1);
}

TEST_CASE("arcTangent: within 1e-15 of long doubles over the whole circle", "[math][oracle]") {
    double worst = 0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        Random random(2, i);
        const double scale = std::ldexp(1.0, int(random.uniform(-300, 300)));
        const double y = random.uniform(-1, 1) * scale, x = random.uniform(-1, 1) * scale;
        worst = std::max({worst, off(arcTangent(y, x), atan2l(y, x)),
                          off(arcTangent(y * 1e-6, x), atan2l(y * 1e-6, x)),
                          off(arcTangent(y, x * 1e-6), atan2l(y, x * 1e-6))});
    }
    CHECK(worst < 1e-15);
}

TEST_CASE("arcTangent: axes, diagonals, and what is no number", "[math][degenerate]") {
    CHECK(arcTangent(0, 0) == 0);
    CHECK(arcTangent(0, 3) == 0);
    CHECK(arcTangent(0, -1) == kPi);
    CHECK(arcTangent(-0.0, -1) == kPi);
    CHECK(arcTangent(2, 0) == kPi / 2);
    CHECK(arcTangent(-2, 0) == -kPi / 2);
    CHECK(arcTangent(5, 5) == kPi / 4);
    CHECK(arcTangent(-5, -5) == -(kPi - kPi / 4));
    CHECK(arcTangent(1e-320, 1) == 1e-320);
    CHECK(std::isnan(arcTangent(std::nan(""), 1)));
    CHECK(std::isnan(arcTangent(1, std::nan(""))));
}

TEST_CASE("exponential: within 1e-15 of long doubles, relative", "[math][oracle]") {
    double worst = 0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        Random random(3, i);
        for (double power : {random.uniform(-706, 709.7), random.uniform(-2, 2)}) {
            const long double exact = expl(power);
            worst = std::max(worst, off(exponential(power), exact) / double(exact));
        }
    }
    CHECK(worst < 1e-15);
    CHECK(exponential(0) == 1);
    CHECK(exponential(-0.0) == 1);
    CHECK(exponential(1000) == kInfinity);
    CHECK(exponential(kInfinity) == kInfinity);
    CHECK(exponential(709.785) == kInfinity);
    CHECK(exponential(-1000) == 0);
    CHECK(exponential(-kInfinity) == 0);
    CHECK(exponential(-745) == std::numeric_limits<double>::denorm_min());
    CHECK(std::isnan(exponential(std::nan(""))));
}

TEST_CASE("logarithm2: within 1e-15 of long doubles, exact for powers of two", "[math][oracle]") {
    double worst = 0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        Random random(4, i);
        for (double number :
             {std::ldexp(random.uniform(1, 2), int(random.uniform(-1000, 1000))), random.uniform(0.5, 2)}) {
            const long double exact = log2l(number);
            worst = std::max(worst, off(logarithm2(number), exact) / double(1 + std::abs(exact)));
        }
    }
    CHECK(worst < 1e-15);
    for (int power = -1074; power <= 1023; ++power) REQUIRE(logarithm2(std::ldexp(1.0, power)) == power);
}
