#include "libvdbsynth/raster/volume_field.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/contexts.h"
#include "tests/support/raster_fields.h"

using namespace vdbsynth;
using test::crossing;
using test::rasterOf;

TEST_CASE("volumeField: a threshold's surface is that of linear interpolation, whatever the range",
          "[raster][oracle]") {
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
        // Values that change by one from sample to sample are distances.
        CHECK((result.distanceBand > 0) == (scale == 1));
    }
}

TEST_CASE("volumeField: below a value is above the opposite value of the opposite samples",
          "[raster][oracle]") {
    const auto distance = [](int x, int y, int z) {
        return float(std::sqrt((x - 9.3) * (x - 9.3) + (y - 10) * (y - 10) + (z - 10) * (z - 10)) - 6);
    };
    VolumeOptions below, above;
    below.below = 0.5;
    above.threshold = -0.5;
    const RasterField one = volumeField("a", rasterOf({20, 20, 20}, distance), below);
    const RasterField other = volumeField(
        "a", rasterOf({20, 20, 20}, [&](int x, int y, int z) { return -distance(x, y, z); }), above);
    CHECK(crossing(one.field, {9, 10, 10}, 0) == Approx(15.8).margin(0.01));
    bool same = true;
    forEachVoxel(one.domain, [&](const Index3& p) { same = same && one.field.at(p) == other.field.at(p); });
    CHECK(same);
    CHECK(one.distanceBand > 3.5f);
    CHECK(one.field.at({16, 10, 10}) == Approx(0.2).margin(0.01));
    below.below = -7;
    const test::Thrown none = test::thrownBy([&] {
        volumeField("a", rasterOf({20, 20, 20}, distance), below);
    });
    CHECK(none.code == int(ErrorCode::Unusable));
    CHECK(test::contains(none.message, "`below` -7: no surface there; the values of a range from -5.7 to"));
    below.labels = {{1, 2}};
    CHECK(test::thrownBy([&] { validate(below); }).message == "`below` and `labels`: give one of them");
    below.labels.clear();
    below.threshold = 1;
    CHECK(test::thrownBy([&] { validate(below); }).message == "`below` and `threshold`: give one of them");
    below.threshold.reset();
    below.below = std::nan("");
    CHECK(test::thrownBy([&] { validate(below); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("volumeField: cells that are no cubes are resampled to their smallest side", "[raster][oracle]") {
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

TEST_CASE(
    "volumeField: sheared cells are resampled to cubes at right angles, where there are none is outside",
    "[raster][oracle]") {
    // A ball in samples whose slices are shifted along x by half a sample each, as a tilted gantry does.
    const double c = std::sqrt(0.8), s = std::sqrt(0.2);
    Raster raster = rasterOf({40, 40, 40}, [&](int x, int y, int z) {
        const double wx = x + 0.5 * z - 30, wy = y - 20, wz = z - 20;
        return float(20 - std::sqrt(wx * wx + wy * wy + wz * wz));
    });
    raster.axes = {{{1, 0, 0}, {0, 1, 0}, {s, 0, c}}};
    raster.spacing = {1, 1, 1 / c};
    VolumeOptions options;
    options.threshold = 8;
    const RasterField result = volumeField("a", raster, options);
    CHECK(test::contains(result.description, "not at right angles"));
    CHECK(result.voxelSize == 1);
    double worst = 0;
    int inside = 0;
    forEachVoxel(result.domain, [&](const Index3& p) {
        const Vec3d at = result.axes[0] * double(p.x) + result.axes[1] * double(p.y) +
                         result.axes[2] * double(p.z) - Vec3d{30, 20, 20};
        const bool solid = result.field.at(p) < 0;
        inside += solid ? 1 : 0;
        if (solid != (length(at) < 12)) worst = std::max(worst, std::abs(length(at) - 12));
    });
    CHECK(worst < 0.1);
    CHECK(inside == Approx(4.0 / 3 * kPi * 12 * 12 * 12).epsilon(0.01));
    // A whole block of solid samples ends half a voxel beyond them, not at the box around them.
    options.threshold = -1000;
    raster.values[0] = -2000;
    CHECK(volumeField("a", raster, options).field.at(result.domain.min) > 0);
}

TEST_CASE("volumeField: smoothed labels keep every sample's side and make slopes of stairs",
          "[raster][property]") {
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

TEST_CASE("volumeField: the volume of samples of two sides is told", "[raster][hand]") {
    Raster flat = rasterOf({6, 6, 10}, [](int, int, int z) { return z < 4 ? 1.f : 0.f; });
    CHECK(volumeField("a", flat).solidVolume == 6 * 6 * 4);
    CHECK(test::contains(volumeField("a", flat).keepsMore, "`threshold` 0.5"));
    VolumeOptions half;
    half.threshold = 0.5;
    CHECK(volumeField("a", flat, half).solidVolume == 6 * 6 * 4);
    // At the edge of the domain half a voxel of the cell is left.
    flat.spacing = {1, 1, 2};
    CHECK(volumeField("a", flat).solidVolume == Approx(6 * 6 * 7.5));
    VolumeOptions labels;
    labels.labels = {{2, 3}};
    const Raster some = rasterOf({6, 6, 6}, [](int x, int, int) { return float(x); });
    CHECK(volumeField("a", some, labels).solidVolume == 6 * 6 * 2);
    CHECK(volumeField("a", some, half).solidVolume == 0);  // values between its samples are known
}

TEST_CASE("volumeField: of two values the larger is solid, of more one must be named", "[raster][error]") {
    const Raster two = rasterOf({8, 8, 8}, [](int x, int, int) { return x < 4 ? 0.f : 255.f; });
    const RasterField result = volumeField("a", two);
    CHECK(result.field.at({6, 4, 4}) < 0);
    CHECK(result.field.at({1, 4, 4}) > 0);
    CHECK(test::contains(result.description, "255 is solid"));
    CHECK(test::contains(result.description, "it names no spacing"));
    VolumeOptions given;
    given.pixelSize = 2;
    CHECK_FALSE(test::contains(volumeField("a", two, given).description, "spacing"));
    Raster placed = two;
    placed.knownSpacing = true;
    CHECK_FALSE(test::contains(volumeField("a", placed).description, "spacing"));
    const Raster many = rasterOf({8, 8, 8}, [](int x, int, int) { return float(x); });
    CHECK(test::contains(test::thrownBy([&] { volumeField("a.npy", many); }).message,
                         "a.npy: choose what is solid with `threshold`"));
    VolumeOptions none;
    none.threshold = 7;
    CHECK(test::contains(test::thrownBy([&] { volumeField("a", many, none); }).message,
                         "no surface there; the values of a range from 0 to 7"));
    none = {};
    none.labels = {{20, 30}};
    CHECK(test::contains(test::thrownBy([&] { volumeField("a", many, none); }).message,
                         "no sample of a has one of them"));
    Raster infinite = many;
    infinite.values[3] = INFINITY;
    CHECK(test::thrownBy([&] { volumeField("a", infinite); }).code == int(ErrorCode::BadData));
}

TEST_CASE("volumeField: sizes that no lattice holds and labels that floats merge are refused",
          "[raster][regression]") {
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
                         "cannot be distinguished"));
    RunContext small;
    small.maxMemory = 500;
    CHECK(test::thrownBy([&] { volumeField("a", ids, {}, small); }).code == int(ErrorCode::Memory));
}

TEST_CASE("volumeField: samples without data are outside, colours count by their luminance",
          "[raster][oracle]") {
    const Raster holes = rasterOf({12, 12, 12}, [](int x, int y, int z) {
        return x == 5 && y == 6 && z == 7 ? std::nanf("") : x < 9 ? 3.f : 1.f;
    });
    VolumeOptions options;
    options.threshold = 2;
    CHECK(volumeField("a", holes, options).field.at({5, 6, 7}) > 0);
    CHECK(volumeField("a", holes, options).field.at({5, 6, 6}) < 0);
    options = {};
    options.labels = {{3, 3}};
    CHECK(volumeField("a", holes, options).field.at({5, 6, 7}) > 0);
    Raster colour;
    colour.size = {2, 1, 1};
    colour.channels = 3;
    colour.values = {0, 200, 0, 0, 0, 200};  // green is brighter than blue
    options = {};
    options.threshold = 100;
    const BrickField field = volumeField("a", colour, options).field;
    CHECK(field.at({0, 0, 0}) < 0);
    CHECK(field.at({1, 0, 0}) > 0);
    CHECK(test::thrownBy([&] {
              volumeField("a", rasterOf({2, 2, 2}, [](int, int, int) { return std::nanf(""); }), options);
          }).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("volumeField: voxels are the file's in size and place, or as large as asked for",
          "[raster][oracle]") {
    Raster raster = rasterOf({6, 6, 6}, [](int x, int, int) { return float(x); });
    raster.spacing = {0.25, 0.25, 0.25};
    raster.origin = {5, 6, 7};
    VolumeOptions options;
    options.threshold = 2.5;
    const RasterField own = volumeField("a", raster, options);
    CHECK(own.voxelSize == 0.25);
    CHECK(own.origin.z == 7);
    CHECK(own.field.box() == own.domain.expanded(kRasterFieldMargin));
    options.pixelSize = 2;
    const RasterField asked = volumeField("a", raster, options);
    CHECK(asked.voxelSize == 2);
    CHECK(asked.origin.z == 0);
    CHECK(asked.field.at({3, 3, 3}) < 0);  // larger values are solid
    CHECK(asked.field.at({2, 3, 3}) == Approx(-asked.field.at({3, 3, 3})));
}

TEST_CASE("validate VolumeOptions: one way to choose, and numbers", "[raster][error]") {
    const auto refused = [](const VolumeOptions& options) {
        return test::thrownBy([&] { validate(options); });
    };
    VolumeOptions options;
    CHECK(refused(options).code == -1);
    options.threshold = 1;
    CHECK(refused(options).code == -1);
    options.labels = {{1, 2}};
    CHECK(refused(options).code == int(ErrorCode::InvalidOption));
    options.threshold.reset();
    CHECK(refused(options).code == -1);
    options.labels = {{2, 1}};
    CHECK(test::contains(refused(options).message, "`labels`"));
    options.labels = {{1, std::nan("")}};
    CHECK(refused(options).code == int(ErrorCode::InvalidOption));
    options.labels.clear();
    options.threshold = std::nan("");
    CHECK(test::contains(refused(options).message, "`threshold`"));
    options.threshold.reset();
    options.pixelSize = -1;
    CHECK(test::contains(refused(options).message, "`pixelSize`"));
}

TEST_CASE("volumeField: same bits for any number of threads, and cancel is heard",
          "[raster][threads][cancel]") {
    const Raster raster =
        rasterOf({40, 44, 48}, [](int x, int y, int z) { return float((x / 5 + y / 7 + z / 6) % 4); });
    VolumeOptions threshold, labels;
    threshold.threshold = 1.5;
    labels.labels = {{1, 2}};
    for (const VolumeOptions& options : {threshold, labels}) {
        const auto made = [&](const RunContext& ctx) { return volumeField("a", raster, options, ctx).field; };
        CHECK(test::samplesOf(made(test::onThreads(1))) == test::samplesOf(made(test::onThreads(4))));
        CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
    }
}
