#include "libvdbsynth/raster/raster.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace vdbsynth;

namespace {

Raster grey(const Index3& size, std::vector<float> values) {
    Raster raster;
    raster.size = size;
    raster.values = std::move(values);
    return raster;
}

}  // namespace

TEST_CASE("Raster: samples lie columns first, then rows, then slices", "[raster]") {
    const Raster raster = grey({3, 2, 2}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
    CHECK(raster.sampleCount() == 12);
    CHECK(raster.at(2, 0, 0) == 2);
    CHECK(raster.at(0, 1, 0) == 3);
    CHECK(raster.at(1, 1, 1) == 10);
}

TEST_CASE("luminance: weights of red, green and blue, grey as it is", "[raster][oracle]") {
    Raster colour = grey({2, 1, 1}, {1, 0, 0, 100, 200, 50});
    colour.channels = 3;
    const Raster grew = luminance(colour);
    REQUIRE(grew.channels == 1);
    REQUIRE(grew.values.size() == 2);
    CHECK(grew.values[0] == Approx(0.2126));
    CHECK(grew.values[1] == Approx(21.26 + 143.04 + 3.61));
    const Raster same = luminance(grey({2, 1, 1}, {3, 4}));
    CHECK(same.values == std::vector<float>{3, 4});
}

TEST_CASE("rangeOf: extremes without what is missing or infinite, and which values there are",
          "[raster][oracle]") {
    const float missing = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    const RasterRange range = rangeOf(grey({3, 2, 1}, {4, missing, -2, 7, infinite, -2}));
    CHECK(range.minimum == -2);
    CHECK(range.maximum == 7);
    CHECK(range.missing == 1);
    CHECK(range.infinite == 1);
    CHECK(range.whole);
    CHECK(range.distinct == std::vector<float>{-2, 4, 7});
    CHECK_FALSE(rangeOf(grey({2, 1, 1}, {1, 1.5f})).whole);
}

TEST_CASE("rangeOf: more than 256 values are not listed, and nothing but missing ones has no extremes",
          "[raster][degenerate]") {
    std::vector<float> many(257);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = float(i);
    CHECK(rangeOf(grey({257, 1, 1}, many)).distinct.empty());
    many.pop_back();
    CHECK(rangeOf(grey({256, 1, 1}, many)).distinct.size() == 256);
    const RasterRange none = rangeOf(grey({2, 1, 1}, {std::nanf(""), std::nanf("")}));
    CHECK(none.missing == 2);
    CHECK(none.distinct.empty());
}
