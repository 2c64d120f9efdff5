#include "libvdbsynth/grid/field_sampling.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// A random place in and around a box of 20 voxels a side.
Vec3f placeAt(std::uint64_t i, double low, double high) {
    Random random(3, i);
    return {float(random.uniform(low, high)), float(random.uniform(low, high)),
            float(random.uniform(low, high))};
}

// The sum over eight corners, each weighted by what lies opposite.
double byCorners(const BrickField& field, const Vec3f& p) {
    double sum = 0;
    const Vec3d at = cast<double>(p);
    for (int i = 0; i < 8; ++i) {
        double weight = 1;
        Index3 corner;
        for (int axis = 0; axis < 3; ++axis) {
            const bool far = i >> axis & 1;
            const double below = std::floor(at[axis]), t = at[axis] - below;
            weight *= far ? t : 1 - t;
            corner[axis] = int(below) + (far ? 1 : 0);
        }
        sum += weight * double(field.at(corner));
    }
    return sum;
}

}  // namespace

TEST_CASE("sampleTrilinear: exact for a linear field, also across bricks, clamped outside",
          "[grid][oracle]") {
    const BrickField field = test::fieldFrom(
        {20, 20, 20}, [](const Index3& p) { return float(2 * p.x) - float(p.y) + 0.5f * float(p.z); });
    for (std::uint64_t i = 0; i < 100; ++i) {
        const Vec3f p = placeAt(i, 0, 19);
        CHECK(sampleTrilinear(field, p) == Approx(2 * p.x - p.y + 0.5f * p.z).margin(1e-4));
    }
    const Vec3f gradient = sampleGradient(field, {7.9f, 8.1f, 3});
    CHECK(gradient.x == Approx(2).margin(1e-4));
    CHECK(gradient.y == Approx(-1).margin(1e-4));
    CHECK(gradient.z == Approx(0.5).margin(1e-4));
    CHECK(sampleTrilinear(field, {-5, 3, 2}) == Approx(-2));
}

TEST_CASE("sampleTrilinear: is the weighted sum of eight voxels, in the box and around it",
          "[grid][oracle]") {
    BrickField field = test::noiseField({20, 20, 20}, 5);
    for (const Index3& by : {Index3{0, 0, 0}, Index3{-25, -3, -11}}) {
        field.translate(by);
        for (std::uint64_t i = 0; i < 500; ++i) {
            const Vec3f p = placeAt(i, -3, 22) + Vec3f{float(field.box().min.x), float(field.box().min.y),
                                                       float(field.box().min.z)};
            REQUIRE(double(sampleTrilinear(field, p)) == Approx(byCorners(field, p)).margin(1e-5));
        }
    }
}

TEST_CASE("sampleTrilinear: a voxel has its own value, and no value leaves the range of its voxels",
          "[grid][property]") {
    const BrickField field = test::noiseField({9, 10, 11}, 5);
    forEachVoxel(field.box(), [&](const Index3& p) {
        REQUIRE(sampleTrilinear(field, {float(p.x), float(p.y), float(p.z)}) == field.at(p));
    });
    for (std::uint64_t i = 0; i < 200; ++i) CHECK(std::abs(sampleTrilinear(field, placeAt(i, -3, 13))) <= 1);
    // Beyond the box it is the value of the nearest place on its faces.
    CHECK(sampleTrilinear(field, {-4.3f, 5.5f, 20}) == Approx(sampleTrilinear(field, {0, 5.5f, 10})));
}

TEST_CASE("sampleGradient: is the difference of samples half a voxel to either side", "[grid][oracle]") {
    const BrickField field = test::noiseField({20, 20, 20}, 9);
    for (std::uint64_t i = 0; i < 100; ++i) {
        const Vec3f p = placeAt(i, -1, 20), gradient = sampleGradient(field, p);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3f low = p, high = p;
            low[axis] -= 0.5f;
            high[axis] += 0.5f;
            REQUIRE(double(gradient[axis]) ==
                    Approx(byCorners(field, high) - byCorners(field, low)).margin(1e-5));
        }
    }
}

TEST_CASE("sampleTrilinear: of one voxel everywhere its value, without a gradient", "[grid][degenerate]") {
    const BrickField one({{5, 5, 5}, {5, 5, 5}}, 3.f);
    for (const Vec3f& p : {Vec3f{5, 5, 5}, Vec3f{-2.5f, 5.2f, 9}, Vec3f{4.5f, 5.5f, 5}}) {
        CHECK(sampleTrilinear(one, p) == 3.f);
        CHECK(length(sampleGradient(one, p)) == 0);
    }
}

TEST_CASE("sampleCubic: a voxel's own value at it, exact for a quadratic between", "[grid][oracle]") {
    const IndexBox box = IndexBox::cube({0, 0, 0}, 12);
    const auto square = [](double x, double y, double z) { return 0.1 * x * x - 0.2 * y * z + 0.3 * z - 1; };
    const BrickField field = BrickField::fromVoxels(
        box, {}, [&](const Index3& p) { return float(square(double(p.x), double(p.y), double(p.z))); });
    CHECK(sampleCubic(field, {5, 6, 7}) == field.at({5, 6, 7}));
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(4, i);
        const Vec3d p{random.uniform(2, 9), random.uniform(2, 9), random.uniform(2, 9)};
        REQUIRE(double(sampleCubic(field, cast<float>(p))) == Approx(square(p.x, p.y, p.z)).margin(1e-4));
    }
}
