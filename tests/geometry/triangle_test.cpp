#include "libvdbsynth/geometry/triangle.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

namespace {

bool is(const Vec3d& w, double x, double y, double z) {
    return w.x == Approx(x).margin(1e-12) && w.y == Approx(y).margin(1e-12) && w.z == Approx(z).margin(1e-12);
}

Vec3d place(Random& random) {
    return {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
}

// Small whole numbers: products of them are exact, so areas of zero are zero.
Vec3d wholePlace(Random& random) {
    return {double(random.below(7)) - 3, double(random.below(7)) - 3, double(random.below(7)) - 3};
}

double leastOf(const Vec3d& w) {
    return std::min({w.x, w.y, w.z});
}

Vec3d at(const Vec3d& w, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return a * w.x + b * w.y + c * w.z;
}

}  // namespace

TEST_CASE("nearestInTriangle: face, edges and corners by hand", "[geometry][oracle]") {
    const Vec3d a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    CHECK(is(nearestInTriangle({1, 1, 5}, a, b, c), 0.5, 0.25, 0.25));
    CHECK(is(nearestInTriangle({-1, -1, 0}, a, b, c), 1, 0, 0));
    CHECK(is(nearestInTriangle({9, -1, 0}, a, b, c), 0, 1, 0));
    CHECK(is(nearestInTriangle({0, 7, 0}, a, b, c), 0, 0, 1));
    CHECK(is(nearestInTriangle({1, -3, 0}, a, b, c), 0.75, 0.25, 0));
    CHECK(is(nearestInTriangle({-3, 2, 0}, a, b, c), 0.5, 0, 0.5));
    CHECK(is(nearestInTriangle({3, 3, 0}, a, b, c), 0, 0.5, 0.5));
}

TEST_CASE("nearestInTriangle: no point of the triangle is nearer", "[geometry][oracle]") {
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(4, i);
        const Vec3d a = place(random), b = place(random), c = place(random), p = place(random) * 2.0;
        const Vec3d w = nearestInTriangle(p, a, b, c);
        CHECK(w.x + w.y + w.z == Approx(1));
        CHECK(leastOf(w) >= -1e-12);
        double nearest = 1e9;
        for (int u = 0; u <= 40; ++u)
            for (int v = 0; u + v <= 40; ++v)
                nearest =
                    std::min(nearest, length(p - at({(40 - u - v) / 40.0, u / 40.0, v / 40.0}, a, b, c)));
        const double found = length(p - at(w, a, b, c));
        CHECK(found <= nearest + 1e-12);
        CHECK(found >= nearest - 0.12);  // samples are a fortieth of a side of up to 7 apart
    }
}

TEST_CASE("nearestInTriangle: a point of the triangle is its own nearest, whatever the order of corners",
          "[geometry][property]") {
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(5, i);
        const Vec3d a = place(random), b = place(random), c = place(random);
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const Vec3d inside = at({1 - u - v, u, v}, a, b, c), p = place(random) * 2.0;
        CHECK(length(at(nearestInTriangle(inside, a, b, c), a, b, c) - inside) < 1e-12);
        const Vec3d one = at(nearestInTriangle(p, a, b, c), a, b, c);
        const Vec3d other = at(nearestInTriangle(p, c, a, b), c, a, b);
        const Vec3d flipped = at(nearestInTriangle(p, b, a, c), b, a, c);
        CHECK(length(one - other) < 1e-10);
        CHECK(length(one - flipped) < 1e-10);
    }
}

TEST_CASE("nearestInTriangle: without an area it is a point on an edge", "[geometry][degenerate]") {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Random random(6, i);
        const Vec3d a = wholePlace(random), step = wholePlace(random), p = wholePlace(random) * 1.5;
        const double k = double(random.below(7)) - 3;
        const Vec3d b = a + step, c = a + step * k;  // corners on a line, some of them equal
        const Vec3d w = nearestInTriangle(p, a, b, c);
        CAPTURE(i, w.x, w.y, w.z);
        REQUIRE(w.x + w.y + w.z == Approx(1));
        REQUIRE(leastOf(w) == 0);
    }
}
