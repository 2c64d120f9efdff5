#include "libvdbsynth/math/vec3.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

namespace {

bool equal(const Vec3d& a, const Vec3d& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

Vec3d place(std::uint64_t i, std::uint32_t which) {
    Random random(2, i, which);
    return {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
}

}  // namespace

TEST_CASE("Vec3: sums, products and lengths by hand", "[math][oracle]") {
    const Vec3d a{1, 2, 3}, b{-4, 0.5, 2};
    CHECK(equal(a + b, {-3, 2.5, 5}));
    CHECK(equal(a - b, {5, 1.5, 1}));
    CHECK(equal(-a, {-1, -2, -3}));
    CHECK(equal(a * 2.0, {2, 4, 6}));
    CHECK(equal(2.0 * a, {2, 4, 6}));
    CHECK(dot(a, b) == 3);
    CHECK(equal(cross(Vec3d{1, 0, 0}, Vec3d{0, 1, 0}), {0, 0, 1}));
    CHECK(equal(cross(a, b), {2.5, -14, 8.5}));
    CHECK(length(Vec3d{2, -3, 6}) == 7);
    CHECK(equal(normalized(Vec3d{0, -8, 0}), {0, -1, 0}));
    CHECK(equal(Vec3d{}, {0, 0, 0}));
}

TEST_CASE("Vec3: axes by number, to read and to write", "[math][oracle]") {
    Vec3f a{1, 2, 3};
    const Vec3f& fixed = a;
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(fixed[axis] == float(axis + 1));
        a[axis] = float(10 * axis);
    }
    CHECK(a.x == 0);
    CHECK(a.y == 10);
    CHECK(a.z == 20);
    CHECK(equal(cast<double>(Vec3f{0.5f, -2, 4}), {0.5, -2, 4}));
    const Vec3<int> whole = cast<int>(Vec3d{1.9, -1.9, 3});
    CHECK(whole.x == 1);
    CHECK(whole.y == -1);
    CHECK(whole.z == 3);
}

TEST_CASE("Vec3: a cross product is square to both, as long as their area, and turns with its order",
          "[math][property]") {
    for (std::uint64_t i = 0; i < 100; ++i) {
        const Vec3d a = place(i, 0), b = place(i, 1), c = cross(a, b);
        CHECK(dot(a, c) == Approx(0).margin(1e-12));
        CHECK(dot(b, c) == Approx(0).margin(1e-12));
        CHECK(dot(c, c) + dot(a, b) * dot(a, b) == Approx(dot(a, a) * dot(b, b)));
        CHECK(equal(cross(b, a), -c));
        CHECK(length(normalized(a)) == Approx(1));
        CHECK(length(cross(normalized(a), a)) == Approx(0).margin(1e-12));
        CHECK(dot(normalized(a), a) > 0);
    }
}

TEST_CASE("Vec3: zero has no direction and stays zero", "[math][degenerate]") {
    CHECK(equal(normalized(Vec3d{0, 0, 0}), {0, 0, 0}));
    CHECK(length(normalized(Vec3f{0, 0, 0})) == 0);
    CHECK(length(Vec3d{}) == 0);
    CHECK(equal(cross(Vec3d{1, 2, 3}, Vec3d{2, 4, 6}), {0, 0, 0}));
}
