#include "libvdbsynth/math/affine.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

TEST_CASE("affine: a quarter turn about z takes x to y, volumes stay", "[math][oracle]") {
    const double half = std::sqrt(0.5);
    const Affine turn = rotation(0, 0, half, half);
    const Vec3d p = transformed(turn, {1, 0, 5});
    CHECK(p.x == Approx(0).margin(1e-12));
    CHECK(p.y == Approx(1));
    CHECK(p.z == Approx(5));
    CHECK(determinant(turn) == Approx(1));
    Affine moved = kIdentity;
    moved[12] = 3;
    // First moved, then turned.
    const Vec3d both = transformed(multiplied(turn, moved), {1, 0, 0});
    CHECK(both.x == Approx(0).margin(1e-12));
    CHECK(both.y == Approx(4));
    Affine mirrored = kIdentity;
    mirrored[0] = -2;
    CHECK(determinant(mirrored) == -2);
}
