#include "libvdbsynth/math/nearest_frame.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

namespace {
using Axes = std::array<Vec3d, 3>;
}

TEST_CASE("nearestFrame: a frame is its own, a reflection stays one", "[math]") {
    const Axes world{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const Axes same = nearestFrame(world);
    for (std::size_t i = 0; i < 3; ++i) CHECK(length(same[i] - world[i]) == 0);
    const Axes mirrored{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    CHECK(nearestFrame(mirrored)[0].x == -1);
}

TEST_CASE("nearestFrame: symmetric shear is removed evenly", "[math]") {
    const double c = std::sqrt(0.5);
    const Axes frame = nearestFrame({{{1, 0, 0}, {c, c, 0}, {0, 0, 1}}});
    CHECK(dot(frame[0], Vec3d{1, 0, 0}) == Approx(dot(frame[1], Vec3d{c, c, 0})));
    CHECK(dot(frame[0], frame[1]) == Approx(0).margin(1e-14));
}

TEST_CASE("nearestFrame: of a rotation and a stretch along its axes the rotation is left", "[math]") {
    const double c = 0.8, s = 0.6;
    const Axes turn{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    for (const double size : {1e-6, 1.0, 1e6}) {
        const Axes frame = nearestFrame({turn[0] * (3 * size), turn[1] * size, turn[2] * (0.2 * size)});
        for (std::size_t i = 0; i < 3; ++i) CHECK(length(frame[i] - turn[i]) < 1e-12);
    }
}
