#include "libvdbsynth/analogy/analogy_features.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("Features: samples lie one voxel apart along the frame's axes, by hand", "[analogy]") {
    const BrickField x = test::fieldFrom({24, 24, 24}, [](const Index3& p) { return float(p.x); });
    FeatureShape shape;
    shape.half = 1;
    shape.coarse = false;
    REQUIRE(shape.made() == 26);
    REQUIRE(shape.rest() == 27);
    const Frame frame = frameFrom({0, 1, 0}, {1, 0, 0});  // t = x, n = y, b = z
    std::vector<float> made(26), rest(27);
    sampleMade(shape, x, {10.5f, 11, 12}, frame, {}, made.data());
    for (int i = 0; i < 26; ++i) {
        const int k = i < 13 ? i : i + 1;  // the middle is left out
        CHECK(made[std::size_t(i)] == Approx(10.5 + (k / 9 - 1)));
    }
    sampleRest(shape, {&x, nullptr, nullptr}, {10.5f, 11, 12}, frame, {}, rest.data());
    for (int k = 0; k < 27; ++k) CHECK(rest[std::size_t(k)] == Approx(10.5 + (k / 9 - 1)));
    shape.causal = true;
    REQUIRE(shape.made() == 9);
    sampleMade(shape, x, {10.5f, 11, 12}, frame, {}, made.data());
    for (int k = 0; k < 9; ++k) CHECK(made[std::size_t(k)] == Approx(9.5));
}

TEST_CASE("Features: turning the field and the frame together changes nothing", "[analogy][property]") {
    const auto wavy = [](double x, double y, double z) {
        return std::sin(0.3 * x) + 0.2 * y + std::cos(0.25 * z);
    };
    const BrickField a = test::fieldFrom(
        {32, 32, 32}, [&](const Index3& p) { return float(wavy(p.x - 15, p.y - 15, p.z - 15)); });
    // A quarter turn about z: (x, y) is where (y, -x) was.
    const BrickField b = test::fieldFrom(
        {32, 32, 32}, [&](const Index3& p) { return float(wavy(p.y - 15, -(p.x - 15), p.z - 15)); });
    FeatureShape shape;
    shape.coarse = false;
    std::vector<float> of(shape.rest()), turned(shape.rest());
    const Frame frame = frameFrom({0.6f, 0, 0.8f}, {0.3f, 1, 0.1f});
    const auto turn = [](const Vec3f& v) { return Vec3f{-v.y, v.x, v.z}; };
    const Frame other = frameFrom(turn(frame.n), turn(frame.t));
    sampleRest(shape, {&a, nullptr, nullptr}, {17, 12, 15}, frame, {}, of.data());
    sampleRest(shape, {&b, nullptr, nullptr}, {18, 17, 15}, other, {}, turned.data());
    for (std::size_t i = 0; i < of.size(); ++i) CHECK(of[i] == Approx(turned[i]).margin(1e-4));
}

TEST_CASE("ReducedFeatures: the two parts together are the projection, and the depth", "[analogy]") {
    FeatureShape shape;
    shape.half = 1;
    shape.coarse = false;
    std::vector<float> rows;
    for (std::uint64_t r = 0; r < 200; ++r) {
        Random random(1, r);
        for (std::size_t k = 0; k < shape.size(); ++k) rows.push_back(float(random.uniform()));
    }
    const PrincipalAxes axes = principalAxes(rows, shape.size(), 7, 2);
    const ReducedFeatures reduced(shape, axes);
    REQUIRE(reduced.count() == 8);
    std::vector<float> expected(7), rest(8), out(8);
    axes.project(rows.data(), expected.data());
    reduced.ofRest(rows.data() + shape.made(), -2.5f, rest.data());
    reduced.addMade(rows.data(), rest.data(), out.data());
    for (std::size_t i = 0; i < 7; ++i) CHECK(out[i] == Approx(expected[i]).margin(1e-4));
    CHECK(out[7] == Approx(-2.5));
}

TEST_CASE("Features: bent along a ball they are those of a plane, straight ones are not",
          "[analogy][property]") {
    constexpr double kRadius = 8;
    const BrickField ball = test::fieldFrom({32, 32, 32}, [&](const Index3& p) {
        return float(std::hypot(p.x - 16, p.y - 16, p.z - 16) - kRadius);
    });
    const BrickField plane = test::fieldFrom({32, 32, 32}, [&](const Index3& p) { return float(p.z - 16); });
    FeatureShape shape;
    shape.coarse = false;
    std::vector<float> flat(shape.rest()), straight(shape.rest()), bent(shape.rest());
    const Vec3f out{0.6f, 0, 0.8f};
    const Frame frame = frameFrom(out, {0, 1, 0});
    const Vec3f at = Vec3f{16, 16, 16} + out * float(kRadius);
    const float bend = float(1 / kRadius);
    sampleRest(shape, {&plane, nullptr, nullptr}, {16, 16, 16}, frameFrom({0, 0, 1}, {1, 0, 0}), {},
               flat.data());
    sampleRest(shape, {&ball, nullptr, nullptr}, at, frame, {}, straight.data());
    sampleRest(shape, {&ball, nullptr, nullptr}, at, frame, {bend, 0, bend}, bent.data());
    double far = 0, near = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        far += std::pow(double(straight[i] - flat[i]), 2);
        near += std::pow(double(bent[i] - flat[i]), 2);
    }
    CAPTURE(far, near);
    CHECK(near < 0.05 * far);
}
