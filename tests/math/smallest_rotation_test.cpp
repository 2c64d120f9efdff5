#include "libvdbsynth/math/smallest_rotation.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("carried: the smallest rotation between normals, which keeps length and the axis") {
    const Vec3f carriedX = carried(Vec3f{1, 0, 0}, {0, 0, 1}, {1, 0, 0});  // about y, x goes to -z
    CHECK(carriedX.x == Approx(0).margin(1e-6));
    CHECK(carriedX.z == Approx(-1));
    const Vec3f axis = carried(Vec3f{0, 1, 0}, {0, 0, 1}, normalized(Vec3f{1, 0, 1}));
    CHECK(axis.y == Approx(1));
    const Vec3f same = carried(Vec3f{0.6f, 0.8f, 0}, {0, 0, 1}, {0, 0, 1});
    CHECK(same.x == Approx(0.6));
    CHECK(length(carried(Vec3d{1, 0, 0}, {0, 0, 1}, normalized(Vec3d{1, 2, 3}))) == Approx(1));
    CHECK(std::isfinite(carried(Vec3f{1, 0, 0}, {0, 0, 1}, {0, 0, -1}).x));
}
