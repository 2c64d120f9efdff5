#include "libvdbsynth/patch/sheet/compact_warp.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "tests/support/makers.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace vdbsynth;

namespace {

Vec3d randomPlace(Random& random, double side) {
    return {random.uniform(0, side), random.uniform(0, side), random.uniform(0, side)};
}

struct Moves {
    std::vector<Vec3d> centres, moves;
};

Moves randomMoves(std::size_t count, double side, double size, std::uint64_t seed) {
    Moves made;
    for (std::size_t n = 0; n < count; ++n) {
        Random random(seed, n);
        made.centres.push_back(randomPlace(random, side));
        made.moves.push_back((randomPlace(random, 2) - Vec3d{1, 1, 1}) * size);
    }
    return made;
}

CompactWarp randomWarp(double size, std::uint64_t seed) {
    const Moves made = randomMoves(40, 20, size, seed);
    return CompactWarp(made.centres, made.moves, 6);
}

std::vector<Vec3d> manyPlaces(std::size_t count) {
    std::vector<Vec3d> places;
    for (std::size_t n = 0; n < count; ++n) {
        Random random(99, n);
        places.push_back(randomPlace(random, 20));
    }
    return places;
}

bool isIdentity(const WarpedPlace& warped, const Vec3d& place) {
    return length(warped.place - place) == 0 && length(warped.jacobian[0] - Vec3d{1, 0, 0}) == 0 &&
           length(warped.jacobian[1] - Vec3d{0, 1, 0}) == 0 &&
           length(warped.jacobian[2] - Vec3d{0, 0, 1}) == 0;
}

}  // namespace

TEST_CASE("CompactWarp: one centre, by hand") {
    const CompactWarp warp({{1, 2, 3}}, {{0.51, 0, -1.02}}, 4);
    const WarpedPlace there = warp.at({1, 2, 3});
    CHECK(length(there.place - Vec3d{1.5, 2, 2}) < 1e-12);  // by 1 / 1.02
    CHECK(determinant(there.jacobian) == Approx(1));
    // Half the radius away phi is 0.5^4 * 3 and phi' -20 * 0.5 * 0.5^3.
    const WarpedPlace half = warp.at({1, 4, 3});
    CHECK(length(half.place - Vec3d{1 + 0.1875 * 0.5, 4, 3 - 0.1875}) < 1e-12);
    CHECK(length(half.jacobian[1] - Vec3d{-1.25 / 4 * 0.5, 1, 1.25 / 4}) < 1e-12);
    CHECK(length(half.jacobian[0] - Vec3d{1, 0, 0}) < 1e-12);
    CHECK(isIdentity(warp.at({1, 2, 7}), {1, 2, 7}));
}

TEST_CASE("CompactWarp: without centres, or moves, nothing moves") {
    CompactWarp none({}, {}, 1);
    CHECK(none.empty());
    CHECK(isIdentity(none.at({1, 2, 3}), {1, 2, 3}));
    CHECK(none.unfold({{1, 2, 3}}).factor == 1);
    const Moves made = randomMoves(20, 20, 0, 1);
    const CompactWarp still(made.centres, made.moves, 6);
    for (const Vec3d& place : manyPlaces(50)) CHECK(isIdentity(still.at(place), place));
}

TEST_CASE("CompactWarp: nothing moves beyond the radius, and centres go nearly where they should") {
    const Moves made = randomMoves(30, 20, 0.3, 2);
    const CompactWarp warp(made.centres, made.moves, 3);
    std::size_t beyond = 0;
    for (const Vec3d& place : manyPlaces(3000)) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3d& centre : made.centres) nearest = std::min(nearest, length(place - centre));
        if (nearest < 3) continue;
        ++beyond;
        REQUIRE(isIdentity(warp.at(place), place));
    }
    CHECK(beyond > 300);
    double worst = 0;
    for (std::size_t c = 0; c < made.centres.size(); ++c)
        worst = std::max(worst, length(warp.at(made.centres[c]).place - made.centres[c] - made.moves[c]));
    CHECK(worst < 0.05);
}

TEST_CASE("CompactWarp: the Jacobian is that of finite differences") {
    const CompactWarp warp = randomWarp(0.4, 3);
    constexpr double h = 1e-5;
    for (const Vec3d& place : manyPlaces(300)) {
        const WarpedPlace warped = warp.at(place);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step;
            step[axis] = h;
            const Vec3d slope = (warp.at(place + step).place - warp.at(place - step).place) * (0.5 / h);
            REQUIRE(length(slope - warped.jacobian[std::size_t(axis)]) < 1e-6);
        }
    }
}

TEST_CASE("CompactWarp: unfolded, det J is above the least everywhere asked") {
    const std::vector<Vec3d> places = manyPlaces(2000);
    for (const double size : {0.01, 0.5, 2.0, 10.0, 50.0}) {
        CAPTURE(size);
        CompactWarp warp = randomWarp(size, 4);
        const CompactWarp before = warp;
        const CompactWarp::Unfolded unfolded = warp.unfold(places);
        const double factor = unfolded.factor;
        CHECK((size > 0.1 || factor == 1));
        CHECK((size < 5 || factor < 1));
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < places.size(); ++p) {
            const Vec3d& place = places[p];
            const WarpedPlace warped = warp.at(place), &said = unfolded.places[p];
            REQUIRE(length(warped.place - said.place) < 1e-9);
            REQUIRE(std::abs(determinant(warped.jacobian) - determinant(said.jacobian)) < 1e-9);
            least = std::min(least, determinant(warped.jacobian));
            // Shrunk, not changed.
            REQUIRE(length(warped.place - place - (before.at(place).place - place) * factor) < 1e-9);
        }
        CHECK(least > 0.2);
    }
}

TEST_CASE("CompactWarp: one that folds however small is given up") {
    CompactWarp warp = randomWarp(1e6, 5);
    const std::vector<Vec3d> places = manyPlaces(200);
    const CompactWarp::Unfolded unfolded = warp.unfold(places);
    CHECK(unfolded.factor == 0);
    for (std::size_t p = 0; p < places.size(); ++p) REQUIRE(isIdentity(unfolded.places[p], places[p]));
    CHECK(warp.empty());
    CHECK(isIdentity(warp.at({1, 2, 3}), {1, 2, 3}));
}

TEST_CASE("CompactWarp: centres that coincide share their moves") {
    const CompactWarp warp({{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {0, 1, 0}}, 2);
    const Vec3d moved = warp.at({0, 0, 0}).place;
    CHECK(moved.x == Approx(1 / 2.02));
    CHECK(moved.y == Approx(1 / 2.02));
}

TEST_CASE("CompactWarp: what is refused") {
    const auto code = [](std::size_t centres, std::size_t moves, double radius) {
        return test::thrownBy(
                   [&] { CompactWarp(std::vector<Vec3d>(centres), std::vector<Vec3d>(moves), radius); })
            .code;
    };
    CHECK(code(2, 1, 1) == int(ErrorCode::ShapeMismatch));
    CHECK(code(1, 1, 0) == int(ErrorCode::InvalidOption));
    CHECK(code(1, 1, std::nan("")) == int(ErrorCode::InvalidOption));
    CHECK(code(CompactWarp::kMostCentres + 1, CompactWarp::kMostCentres + 1, 1) ==
          int(ErrorCode::InvalidOption));
    CHECK(code(1, 1, 1) == -1);
}
