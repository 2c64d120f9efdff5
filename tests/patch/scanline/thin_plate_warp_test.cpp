#include "libvdbsynth/patch/scanline/thin_plate_warp.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "tests/support/makers.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

std::vector<Vec3d> randomPlaces(std::size_t count, std::uint64_t seed, double side = 20) {
    std::vector<Vec3d> places;
    for (std::size_t n = 0; n < count; ++n) {
        Random random(seed, n);
        places.push_back({random.uniform(0, side), random.uniform(0, side), random.uniform(0, side / 4)});
    }
    return places;
}

Vec3d turned(const Vec3d& p) {
    return {0.8 * p.x - 0.6 * p.y + 3, 0.6 * p.x + 0.8 * p.y - 1, 1.2 * p.z + 0.1 * p.x};
}

std::vector<Vec3d> shaken(std::vector<Vec3d> places, double size, std::uint64_t seed) {
    for (std::size_t n = 0; n < places.size(); ++n) {
        Random random(seed, n);
        for (int axis = 0; axis < 3; ++axis) places[n][axis] += random.uniform(-size, size);
    }
    return places;
}

}  // namespace

TEST_CASE("ThinPlateWarp: what is affine is found as it is, everywhere") {
    const std::vector<Vec3d> from = randomPlaces(12, 1);
    std::vector<Vec3d> to;
    for (const Vec3d& p : from) to.push_back(turned(p));
    const ThinPlateWarp warp(from, to);
    for (const Vec3d& p : randomPlaces(50, 2, 60)) {
        const WarpedPlace warped = warp.at(p);
        CHECK(length(warped.place - turned(p)) < 1e-5);
        CHECK(determinant(warped.jacobian) == Approx(1.2).epsilon(1e-5));
    }
    // Four pairs are always affine.
    const ThinPlateWarp four({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                             {{0, 0, 1}, {2, 0, 1}, {0, 1, 1}, {0, 0, 2}});
    CHECK(length(four.at({1, 1, 1}).place - Vec3d{2, 1, 2}) < 1e-5);
}

TEST_CASE("ThinPlateWarp: a query cut from the exemplar, of pairs that are equal, moves nothing") {
    const std::vector<Vec3d> from = randomPlaces(200, 3);
    const ThinPlateWarp warp(from, from);
    for (const Vec3d& p : randomPlaces(50, 4)) CHECK(length(warp.at(p).place - p) < 1e-6);
}

TEST_CASE("ThinPlateWarp: goes through all pairs, and beside them with smoothing") {
    const std::vector<Vec3d> from = randomPlaces(60, 5), to = shaken(from, 0.5, 6);
    const ThinPlateWarp exact(from, to), smooth(from, to, 5), flat(from, to, 1e6);
    double worst = 0, beside = 0, far = 0;
    for (std::size_t n = 0; n < from.size(); ++n) {
        worst = std::max(worst, length(exact.at(from[n]).place - to[n]));
        beside += length(smooth.at(from[n]).place - to[n]);
        far += length(flat.at(from[n]).place - to[n]);
    }
    CHECK(worst < 1e-6);
    CHECK(beside > 1e-3);
    CHECK(beside < far);
    // Smoothed without end it is the affine map of least squares: its residuals sum to nothing.
    Vec3d sum;
    for (std::size_t n = 0; n < from.size(); ++n) sum = sum + flat.at(from[n]).place - to[n];
    CHECK(length(sum) < 1e-3);
}

TEST_CASE("ThinPlateWarp: the Jacobian is that of finite differences") {
    const std::vector<Vec3d> from = randomPlaces(60, 7);
    const ThinPlateWarp warp(from, shaken(from, 0.5, 8));
    constexpr double h = 1e-5;
    for (const Vec3d& place : randomPlaces(200, 9)) {
        const WarpedPlace warped = warp.at(place);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step;
            step[axis] = h;
            const Vec3d slope = (warp.at(place + step).place - warp.at(place - step).place) * (0.5 / h);
            REQUIRE(length(slope - warped.jacobian[std::size_t(axis)]) < 1e-4);
        }
    }
}

TEST_CASE("ThinPlateWarp: places on a plane or at one place still give finite moves") {
    std::vector<Vec3d> plane = randomPlaces(30, 10);
    for (Vec3d& p : plane) p.z = 0;
    std::vector<Vec3d> moved = plane;
    for (Vec3d& p : moved) p = p + Vec3d{1, 2, 3};
    const ThinPlateWarp warp(plane, moved);
    CHECK(length(warp.at({3, 4, 0}).place - Vec3d{4, 6, 3}) < 1e-4);
    CHECK(length(warp.at({3, 4, 2}).place - Vec3d{4, 6, 5}) < 1e-2);
    // Twice the same places, with two images: between them.
    std::vector<Vec3d> twice = plane, images = plane;
    twice.insert(twice.end(), plane.begin(), plane.end());
    images.insert(images.end(), moved.begin(), moved.end());
    const ThinPlateWarp between(twice, images);
    CHECK(length(between.at(plane[4]).place - plane[4] - Vec3d{0.5, 1, 1.5}) < 0.01);
}

TEST_CASE("ThinPlateWarp: what is refused") {
    const auto code = [](std::size_t from, std::size_t to) {
        return test::thrownBy([&] { ThinPlateWarp(std::vector<Vec3d>(from), std::vector<Vec3d>(to)); }).code;
    };
    CHECK(code(5, 4) == int(ErrorCode::ShapeMismatch));
    CHECK(code(3, 3) == int(ErrorCode::InvalidOption));
    CHECK(code(ThinPlateWarp::kMostPairs + 1, ThinPlateWarp::kMostPairs + 1) ==
          int(ErrorCode::InvalidOption));
}
