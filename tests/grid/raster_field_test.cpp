#include "libvdbsynth/grid/raster_field.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

Raster rasterOf(const Index3& size, const std::function<float(int, int, int)>& value) {
    Raster raster;
    raster.size = size;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) raster.values.push_back(value(x, y, z));
    return raster;
}

// Where the zero level crosses a line of voxels upwards, by linear interpolation; NaN if nowhere.
double crossing(const BrickField& field, Index3 p, int axis) {
    for (; p[axis] < field.box().max[axis]; ++p[axis]) {
        Index3 next = p;
        ++next[axis];
        const double a = double(field.at(p)), b = double(field.at(next));
        if (a < 0 && b >= 0) return p[axis] + a / (a - b);
    }
    return std::nan("");
}

}  // namespace

TEST_CASE("heightField: the zero level is at the heights, sizes are those asked for", "[grid][oracle]") {
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
          "[grid][oracle]") {
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

TEST_CASE("heightField: at another resolution a ramp stays a ramp", "[grid][property]") {
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

TEST_CASE("heightField: pixels without data are holes through the slab", "[grid][property]") {
    const Raster raster = rasterOf({30, 30, 1}, [](int x, int y, int) {
        return x > 10 && x < 20 && y > 10 && y < 20 ? std::nanf("") : 6.f;
    });
    const RasterField result = heightField("a", raster, {});
    for (int z = result.domain.min.z; z <= result.domain.max.z; ++z) CHECK(result.field.at({15, 15, z}) > 0);
    CHECK(result.field.at({5, 5, 5}) < 0);
    CHECK(crossing(result.field, {8, 15, 2}, 0) == Approx(10.5).margin(0.01));
    CHECK(test::contains(result.description, "81 pixels without data"));
}

TEST_CASE("volumeField: a threshold's surface is that of linear interpolation, whatever the range",
          "[grid][oracle]") {
    for (const double scale : {0.001, 1.0, 5000.0}) {
        const Raster raster = rasterOf({40, 40, 40}, [&](int x, int y, int z) {
            return float(scale * (20 - std::sqrt((x - 19.3) * (x - 19.3) + (y - 20) * (y - 20) +
                                                 (z - 20) * (z - 20))));
        });
        VolumeOptions options;
        options.threshold = 8 * scale;
        const RasterField result = volumeField("a", raster, options);
        CHECK(crossing(result.field, {19, 20, 20}, 0) == Approx(31.3).margin(0.01));
        CHECK(result.domain == IndexBox::fromSize({40, 40, 40}));
    }
}

TEST_CASE("volumeField: cells that are no cubes are resampled to their smallest side", "[grid][oracle]") {
    Raster raster = rasterOf({20, 20, 11}, [](int x, int y, int z) {
        return float(12 - std::sqrt((x - 10) * (x - 10) + (y - 10) * (y - 10) + (2 * z - 10) * (2 * z - 10)));
    });
    raster.spacing = {0.5, 0.5, 1};
    VolumeOptions options;
    options.threshold = 6;
    const RasterField result = volumeField("a", raster, options);
    CHECK(result.voxelSize == 0.5);
    CHECK(result.domain.size() == Index3{20, 20, 21});
    CHECK(crossing(result.field, {10, 10, 10}, 2) == Approx(16).margin(0.15));
    CHECK(crossing(result.field, {10, 10, 10}, 0) == Approx(16).margin(0.01));
}

TEST_CASE("volumeField: smoothed labels keep every sample's side and make slopes of stairs",
          "[grid][property]") {
    const Index3 size{48, 48, 48};
    const auto ball = [](int x, int y, int z) {
        return std::sqrt((x - 23.7) * (x - 23.7) + (y - 24) * (y - 24) + (z - 23) * (z - 23)) - 15;
    };
    const Raster raster = rasterOf(size, [&](int x, int y, int z) {
        const bool thread = y == 3 && z == 5;  // one voxel thick
        return ball(x, y, z) < 0 || thread ? 7.f : float((x * 7 + y * 3 + z) % 5);
    });
    VolumeOptions options;
    options.labels = {{6, 8}};
    const RasterField result = volumeField("a", raster, options);
    double worst = 0, sum = 0;
    int edges = 0;
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < size.z; ++z) {
                const bool inside = raster.at(x, y, z) == 7;
                if ((result.field.at({x, y, z}) < 0) != inside) FAIL("a sample changed its side");
            }
    for (int y = 15; y < 33; ++y)
        for (int z = 14; z < 32; ++z) {
            const double at = crossing(result.field, {24, y, z}, 0);
            const double truth = 23.7 + std::sqrt(15 * 15 - (y - 24) * (y - 24) - (z - 23) * (z - 23));
            worst = std::max(worst, std::abs(at - truth));
            sum += std::abs(at - truth);
            ++edges;
        }
    CHECK(sum / edges < 0.2);  // the stairs alone are a quarter of a voxel off on average
    CHECK(worst < 0.7);
    CHECK(crossing(result.field, {20, 3, 5}, 2) == Approx(5.4).margin(0.15));
}

TEST_CASE("volumeField: of two values the larger is solid, of more one must be named", "[grid][error]") {
    const Raster two = rasterOf({8, 8, 8}, [](int x, int, int) { return x < 4 ? 0.f : 255.f; });
    const RasterField result = volumeField("a", two);
    CHECK(result.field.at({6, 4, 4}) < 0);
    CHECK(result.field.at({1, 4, 4}) > 0);
    CHECK(test::contains(result.description, "255 is solid"));
    const Raster many = rasterOf({8, 8, 8}, [](int x, int, int) { return float(x); });
    CHECK(test::contains(test::thrownBy([&] { volumeField("a.npy", many); }).message,
                         "a.npy: say what of it is solid with `threshold`"));
    VolumeOptions none;
    none.threshold = 7;
    CHECK(test::contains(test::thrownBy([&] { volumeField("a", many, none); }).message,
                         "no surface there; the values of a run from 0 to 7"));
    none = {};
    none.labels = {{20, 30}};
    CHECK(test::contains(test::thrownBy([&] { volumeField("a", many, none); }).message,
                         "no sample of a has one of them"));
    Raster infinite = many;
    infinite.values[3] = INFINITY;
    CHECK(test::thrownBy([&] { volumeField("a", infinite); }).code == int(ErrorCode::BadData));
    CHECK(test::thrownBy([&] {
              heightField("a", rasterOf({2, 2, 1}, [](int, int, int) { return std::nanf(""); }));
          }).code == int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] { heightField("a", many); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] {
              heightField("a", rasterOf({2, 2, 1}, [](int x, int, int) { return 1e20f * float(x); }));
          }).code == int(ErrorCode::Unusable));
}

TEST_CASE("topHeights: a surface on a plane of voxels is where it is", "[grid][regression]") {
    const BrickField field = test::fieldFrom({4, 4, 12}, [](const Index3& p) { return float(p.z) - 5; });
    for (float height : topHeights(field, HeightPlane::XY).heights) CHECK(height == 5);
    const BrickField between =
        test::fieldFrom({4, 4, 12}, [](const Index3& p) { return float(p.z) - 5.25f; });
    for (float height : topHeights(between, HeightPlane::XY).heights) CHECK(height == 5.25f);
}

TEST_CASE("heightField, volumeField: sizes that no lattice holds and labels that floats merge are refused",
          "[grid][regression]") {
    CHECK(test::thrownBy([&] {
              heightField("a", rasterOf({4, 4, 1}, [](int, int, int) { return 3e9f; }));
          }).code == int(ErrorCode::Unusable));
    Raster thin = rasterOf({4, 4, 4}, [](int x, int, int) { return float(x); });
    thin.spacing = {1, 1, 1e-9};
    VolumeOptions options;
    options.threshold = 1.5;
    CHECK(test::contains(test::thrownBy([&] { volumeField("a", thin, options); }).message,
                         "times as long as wide"));
    options = {};
    options.labels = {{16777217, 16777217}};
    const Raster ids = rasterOf({4, 4, 4}, [](int x, int, int) { return 16777216.f + 2 * float(x); });
    CHECK(test::contains(test::thrownBy([&] { volumeField("a", ids, options); }).message,
                         "cannot be told apart"));
    RunContext ctx;
    ctx.maxMemory = 1000000000;
    HeightOptions tall;
    tall.height = 900000;
    Raster small = rasterOf({33, 17, 1}, [](int x, int y, int) { return float(x * y); });
    CHECK(test::thrownBy([&] { heightField("a", small, tall, ctx); }).code == int(ErrorCode::Memory));
}
