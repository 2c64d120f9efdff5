#include "libvdbsynth/patch/place_warp.h"

#include "libvdbsynth/base/random.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

Vec3d randomPlace(Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Vec3d applied(const std::array<Vec3d, 3>& jacobian, const Vec3d& v) {
    return jacobian[0] * v.x + jacobian[1] * v.y + jacobian[2] * v.z;
}

}  // namespace

TEST_CASE("determinant and warpedNormal: by hand") {
    const std::array<Vec3d, 3> stretched{Vec3d{2, 0, 0}, Vec3d{0, 3, 0}, Vec3d{0, 0, 4}};
    CHECK(determinant(stretched) == 24);
    // Stretched along x, the plane x + y = 0 turns toward y.
    const std::array<Vec3d, 3> wide{Vec3d{2, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
    const Vec3d turned = warpedNormal(wide, normalized(Vec3d{1, 1, 0}));
    CHECK(length(turned - normalized(Vec3d{1, 2, 0})) < 1e-15);
    CHECK(determinant({Vec3d{0, 1, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, 1}}) == -1);
    // Nothing is left of it: the normal stays.
    const std::array<Vec3d, 3> flat{Vec3d{1, 0, 0}, Vec3d{1, 0, 0}, Vec3d{1, 0, 0}};
    CHECK(warpedNormal(flat, {0, 0, 1}).z == 1);
}

TEST_CASE("warpedNormal: is the cross product of warped tangents, whichever they are") {
    for (std::uint64_t n = 0; n < 200; ++n) {
        Random random(5, n);
        const std::array<Vec3d, 3> jacobian{randomPlace(random), randomPlace(random), randomPlace(random)};
        const Vec3d normal = normalized(randomPlace(random));
        const Vec3d u = normalized(cross(normal, randomPlace(random))), v = cross(normal, u);
        const Vec3d wanted = normalized(cross(applied(jacobian, u), applied(jacobian, v)));
        REQUIRE(length(warpedNormal(jacobian, normal) - wanted) < 1e-9);
    }
}
