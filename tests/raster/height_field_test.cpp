#include "libvdbsynth/raster/height_field.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include "tests/support/contexts.h"
#include "tests/support/raster_fields.h"

using namespace vdbsynth;
using test::crossing;
using test::rasterOf;

TEST_CASE("heightField: the zero level is at the heights, sizes are those asked for", "[raster][oracle]") {
    // 8 bits: 255 is the height.
    Raster raster = rasterOf({20, 12, 1}, [](int x, int y, int) { return float(5 * x + 3 * y); });
    raster.white = 255;
    HeightOptions options;
    options.height = 51;  // a fifth of a unit of height for each grey level
    options.base = 4.5;
    const RasterField result = heightField("a", raster, options);
    CHECK(result.voxelSize == 1);
    CHECK(result.domain.size().x == 20);
    CHECK(result.domain.size().y == 12);
    CHECK(result.domain.min.z == -4);  // whose lower side is at -4.5
    for (int x = 0; x < 20; x += 3)
        for (int y = 0; y < 12; y += 3)
            CHECK(crossing(result.field, {x, y, result.domain.min.z}, 2) ==
                  Approx((5 * x + 3 * y) / 5.0).margin(1e-4));
    // Beyond the domain the edge goes on.
    CHECK(crossing(result.field, {-3, 5, -3}, 2) == Approx(3).margin(1e-4));
}

TEST_CASE("heightField: real heights stay as they are, rows are turned, the plane may be another",
          "[raster][oracle]") {
    Raster raster = rasterOf({10, 8, 1}, [](int, int y, int) { return 20.f + float(y); });
    raster.rowsFromTop = true;
    raster.knownSpacing = true;
    raster.spacing = {2, 2, 1};
    HeightOptions options;
    options.plane = HeightPlane::ZX;
    const RasterField result = heightField("a", raster, options);
    CHECK(result.voxelSize == 2);
    CHECK(result.domain.size().z == 10);
    CHECK(result.domain.size().x == 8);
    // The last row of the file is the bottom one: row 0 of the field has the height 27.
    CHECK(crossing(result.field, {0, result.domain.min.y - 3, 4}, 1) == Approx(27 / 2.0).margin(1e-4));
    CHECK(crossing(result.field, {7, result.domain.min.y - 3, 4}, 1) == Approx(20 / 2.0).margin(1e-4));
}

TEST_CASE("heightField: at another resolution a ramp stays a ramp", "[raster][property]") {
    const Raster raster = rasterOf({40, 30, 1}, [](int x, int, int) { return 0.25f * (float(x) + 0.5f); });
    for (const double voxel : {0.5, 2.0, 3.0}) {
        HeightOptions options;
        options.voxelSize = voxel;
        options.base = 5;
        const RasterField result = heightField("a", raster, options);
        CAPTURE(voxel);
        CHECK(result.domain.size().x == int(std::lround(40 / voxel)));
        for (int x = int(6 / voxel); x < int(34 / voxel); ++x)
            CHECK(crossing(result.field, {x, 3, result.domain.min.z}, 2) * voxel ==
                  Approx(0.25 * (x + 0.5) * voxel).margin(0.02));
    }
}

TEST_CASE("heightField: pixels without data are holes through the slab", "[raster][property]") {
    const Raster raster = rasterOf({30, 30, 1}, [](int x, int y, int) {
        return x > 10 && x < 20 && y > 10 && y < 20 ? std::nanf("") : 6.f;
    });
    const RasterField result = heightField("a", raster, {});
    for (int z = result.domain.min.z; z <= result.domain.max.z; ++z) CHECK(result.field.at({15, 15, z}) > 0);
    CHECK(result.field.at({5, 5, 5}) < 0);
    CHECK(crossing(result.field, {8, 15, 2}, 0) == Approx(10.5).margin(0.01));
    CHECK(test::contains(result.description, "81 pixels without data"));
}

TEST_CASE("topHeights: a surface on a plane of voxels is where it is", "[raster][regression]") {
    const BrickField field = test::fieldFrom({4, 4, 12}, [](const Index3& p) { return float(p.z) - 5; });
    for (float height : topHeights(field, HeightPlane::XY).heights) CHECK(height == 5);
    const BrickField between =
        test::fieldFrom({4, 4, 12}, [](const Index3& p) { return float(p.z) - 5.25f; });
    for (float height : topHeights(between, HeightPlane::XY).heights) CHECK(height == 5.25f);
}

TEST_CASE("heightField: of one pixel a column, and a slab that ends at the domain's faces",
          "[raster][degenerate]") {
    HeightOptions options;
    options.base = 2.5;
    const RasterField one =
        heightField("a", rasterOf({1, 1, 1}, [](int, int, int) { return 3.25f; }), options);
    CHECK(one.domain.size().x == 1);
    CHECK(one.domain.size().y == 1);
    CHECK(crossing(one.field, {0, 0, one.domain.min.z}, 2) == Approx(3.25).margin(1e-4));
    CHECK(one.field.at({0, 0, one.domain.max.z}) > 0);
    CHECK(one.field.box() == one.domain.expanded(kRasterFieldMargin));
}

TEST_CASE("heightField: what cannot be a height field is refused", "[raster][error]") {
    const auto refused = [](const Raster& raster, const HeightOptions& options = {},
                            const RunContext& ctx = {}) {
        return test::thrownBy([&] { heightField("a", raster, options, ctx); }).code;
    };
    const Raster ramp = rasterOf({8, 8, 1}, [](int x, int, int) { return float(x); });
    CHECK(refused(ramp) == -1);
    CHECK(refused(rasterOf({8, 8, 8}, [](int x, int, int) { return float(x); })) ==
          int(ErrorCode::InvalidOption));
    CHECK(refused(rasterOf({2, 2, 1}, [](int, int, int) { return std::nanf(""); })) ==
          int(ErrorCode::EmptyInput));
    CHECK(refused(rasterOf({2, 2, 1}, [](int x, int, int) { return x ? INFINITY : 1; })) ==
          int(ErrorCode::BadData));
    for (float scale : {1e20f, 3e9f})  // heights that no lattice holds
        CHECK(refused(rasterOf({4, 4, 1}, [=](int x, int, int) { return scale * float(x + 1); })) ==
              int(ErrorCode::Unusable));
    HeightOptions tall;
    tall.height = 900000;
    RunContext small;
    small.maxMemory = 1000000000;
    CHECK(refused(rasterOf({33, 17, 1}, [](int x, int y, int) { return float(x * y); }), tall, small) ==
          int(ErrorCode::Memory));
}

TEST_CASE("validate HeightOptions: every field has its range", "[raster][error]") {
    const auto refused = [](const std::function<void(HeightOptions&)>& change) {
        HeightOptions options;
        change(options);
        return test::thrownBy([&] { validate(options); });
    };
    CHECK(refused([](HeightOptions&) {}).code == -1);
    CHECK(refused([](HeightOptions& o) { o.resolution = 2; }).code == -1);
    const std::pair<double HeightOptions::*, const char*> lengths[] = {
        {&HeightOptions::voxelSize, "`voxelSize`"},
        {&HeightOptions::pixelSize, "`pixelSize`"},
        {&HeightOptions::height, "`height`"},
        {&HeightOptions::base, "`base`"}};
    for (const auto& [field, name] : lengths)
        for (const double value : {-1.0, std::nan(""), double(INFINITY)}) {
            const test::Thrown thrown = refused([&, at = field](HeightOptions& o) { o.*at = value; });
            CHECK(thrown.code == int(ErrorCode::InvalidOption));
            CHECK(test::contains(thrown.message, name));
        }
    for (const int resolution : {-1, 1, 100001})
        CHECK(test::contains(refused([=](HeightOptions& o) { o.resolution = resolution; }).message,
                             "`resolution`"));
}

TEST_CASE("topHeights: is the inverse of heightField in every plane", "[raster][property]") {
    Raster raster = rasterOf(
        {13, 9, 1}, [](int x, int y, int) { return 4 + 0.37f * float(x) + 0.21f * float(y * y % 7); });
    raster.rowsFromTop = true;
    for (const HeightPlane plane : {HeightPlane::XY, HeightPlane::YZ, HeightPlane::ZX}) {
        HeightOptions options;
        options.plane = plane;
        const RasterField made = heightField("a", raster, options);
        const HeightImage image = topHeights(made.field, plane);
        // The field extends some voxels beyond the image.
        REQUIRE(image.columns == 13 + 2 * kRasterFieldMargin);
        REQUIRE(image.rows == 9 + 2 * kRasterFieldMargin);
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 13; ++x) {
                const int at = (y + kRasterFieldMargin) * image.columns + x + kRasterFieldMargin;
                CHECK(image.heights[std::size_t(at)] == Approx(raster.at(x, y, 0)).margin(1e-4));
            }
    }
}

TEST_CASE("topHeights: no surface, solid to the top, and the topmost of several", "[raster][degenerate]") {
    const IndexBox box{{2, 3, -4}, {4, 4, 7}};
    for (float height : topHeights(BrickField(box, 1.f), HeightPlane::XY).heights) CHECK(std::isnan(height));
    for (float height : topHeights(BrickField(box, -1.f), HeightPlane::XY).heights) CHECK(height == 7.5f);
    const BrickField two = test::fieldFrom({3, 2, 20}, [](const Index3& p) {
        return std::min(std::abs(float(p.z) - 4) - 1.5f, std::abs(float(p.z) - 12) - 2.25f);
    });
    for (float height : topHeights(two, HeightPlane::XY).heights) CHECK(height == 14.25f);
}

TEST_CASE("heightField, topHeights: same bits for any number of threads, and cancel is heard",
          "[raster][threads][cancel]") {
    const Raster raster = rasterOf({90, 70, 1}, [](int x, int y, int) {
        return x * y % 97 == 5 ? std::nanf("") : 9 + float(x * 7 % 13) + float(y * 5 % 11);
    });
    HeightOptions options;
    options.voxelSize = 1.3;
    const auto made = [&](const RunContext& ctx) { return heightField("a", raster, options, ctx).field; };
    const BrickField one = made(test::onThreads(1));
    CHECK(test::samplesOf(one) == test::samplesOf(made(test::onThreads(4))));
    const auto top = [&](const RunContext& ctx) { return topHeights(one, HeightPlane::XY, ctx).heights; };
    const std::vector<float> a = top(test::onThreads(1)), b = top(test::onThreads(4));
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
    CHECK(test::thrownWhenCancelled(top).code == int(ErrorCode::Cancelled));
}

TEST_CASE("heightField: details smaller than a voxel are counted as lost", "[raster][hand]") {
    // 64 x 64 pixels, a spike of 30 on each eighth pixel of every eighth row, or none.
    Raster raster;
    raster.size = {64, 64, 1};
    raster.values.assign(64 * 64, 1.f);
    HeightOptions options;
    options.voxelSize = 4;
    CHECK(heightField("flat", raster, options).lostShare == 0);
    for (int y = 4; y < 64; y += 8)
        for (int x = 4; x < 64; x += 8) raster.values[raster.index(x, y, 0)] = 30;
    CHECK(heightField("spikes", raster, options).lostShare == Approx(1.0 / 64));
    options.voxelSize = 1;
    CHECK(heightField("spikes", raster, options).lostShare == 0);
}
