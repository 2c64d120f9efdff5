#include "libvdbsynth/raster/raster.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "tests/support/makers.h"

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

TEST_CASE("requirePixelSize: one size or one for each axis", "[raster][error]") {
    const auto refused = [](double size, const Vec3d& sides) {
        return test::thrownBy([&] { requirePixelSize(size, sides); });
    };
    CHECK(refused(0, {0, 0, 0}).code == -1);
    CHECK(refused(2, {0, 0, 0}).code == -1);
    CHECK(refused(0, {1, 2, 0}).code == -1);
    CHECK(refused(0, {1, 2, 3}).code == -1);
    for (const Vec3d& sides : {Vec3d{1, 0, 0},
                               {0, 1, 0},
                               {0, 0, 1},
                               {1, 0, 1},
                               {-1, 1, 1},
                               {1, 1, -1},
                               {1, 1e31, 1},
                               {std::nan(""), 1, 1}}) {
        const test::Thrown thrown = refused(0, sides);
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`pixelSize`"));
    }
    CHECK(test::contains(refused(2, {1, 1, 1}).message, "not both"));
}

TEST_CASE("cellSides: the file's, by the smallest side, or each as given", "[raster][oracle]") {
    Raster raster;
    raster.spacing = {2, 4, 1};
    CHECK(length(cellSides("a", raster, false, 0, {}) - Vec3d{2, 4, 1}) == 0);
    CHECK(length(cellSides("a", raster, false, 3, {}) - Vec3d{6, 12, 3}) == 0);
    CHECK(length(cellSides("a", raster, false, 0, {10, 10, 30}) - Vec3d{10, 10, 30}) == 0);
    CHECK(length(cellSides("a", raster, true, 3, {}) - Vec3d{3, 6, 1}) == 0);
    CHECK(length(cellSides("a", raster, true, 0, {5, 7, 0}) - Vec3d{5, 7, 1}) == 0);
    for (const bool image : {true, false}) {
        const test::Thrown thrown = test::thrownBy([&] {
            cellSides("a", raster, image, 0, {1, 1, image ? 1.0 : 0.0});
        });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, image ? "a is an image" : "a is a volume"));
    }
}
