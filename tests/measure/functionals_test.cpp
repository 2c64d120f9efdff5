#include "libvdbsynth/measure/functionals.h"

#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/math/trigonometry.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/solids.h"

using namespace vdbsynth;
using test::inBall;
using test::solidFrom;

namespace {}  // namespace

TEST_CASE("eulerCharacteristic: ball 1, two balls 2, shell 2, ring 0, none 0", "[measure][oracle]") {
    const Index3 size{40, 40, 80};
    const auto euler = [&](const std::function<bool(const Index3&)>& inside) {
        return eulerCharacteristic(solidFrom(size, inside), Beyond::Void);
    };
    CHECK(euler([](const Index3& p) { return inBall(p, 20, 20, 20, 9.3); }) == 1);
    CHECK(euler([](const Index3& p) { return inBall(p, 20, 20, 20, 9.3) || inBall(p, 20, 20, 60, 9); }) == 2);
    CHECK(euler([](const Index3& p) { return inBall(p, 20, 20, 20, 9) && !inBall(p, 20, 20, 20, 5); }) == 2);
    CHECK(euler([](const Index3& p) {
              const double ring = std::hypot(p.x - 20.0, p.y - 20.0) - 12;
              return ring * ring + (p.z - 40.0) * (p.z - 40.0) < 16;
          }) == 0);
    CHECK(euler([](const Index3&) { return false; }) == 0);
    CHECK(euler([](const Index3&) { return true; }) == 1);
    // Two voxels that touch by a corner only are one part, and one void.
    CHECK(euler([](const Index3& p) { return p == Index3{3, 3, 3} || p == Index3{4, 4, 4}; }) == 1);
}

TEST_CASE("eulerCharacteristic: a lattice of bars has -2 a node, whatever the window", "[measure][oracle]") {
    // Bars along three axes: a node's share is 1 node less 3 bars.
    const Occupancy solid = solidFrom({128, 128, 128}, [](const Index3& p) {
        const bool x = p.x % 16 < 5, y = p.y % 16 < 5, z = p.z % 16 < 5;
        return (x && y) || (y && z) || (x && z);
    });
    const Occupancy cell = solid.window({{0, 0, 0}, {112, 112, 112}});  // 112 corners a side: 7 periods
    CHECK(eulerCharacteristic(cell, Beyond::Unknown) / eulerVolume(cell.size(), Beyond::Unknown) ==
          Approx(-2.0 / (16 * 16 * 16)));
    const Occupancy moved = solid.window({{9, 5, 7}, {121, 117, 119}});
    CHECK(eulerCharacteristic(moved, Beyond::Unknown) == Approx(-2 * 343.0));
    CHECK(eulerVolume({113, 113, 113}, Beyond::Unknown) == 112.0 * 112 * 112);
    CHECK(eulerVolume({10, 10, 10}, Beyond::Void) == 11.0 * 11 * 11);
}

TEST_CASE("surfaceFunctionals: a box has its area and 3 pi a, a notch turns the other way",
          "[measure][oracle]") {
    Mesh box = test::boxMesh({2, 2, 2}, {12, 12, 12});
    REQUIRE(summarize(box).closedManifold());
    REQUIRE(summarize(box).signedVolume > 0);
    const SurfaceElements elements = surfaceElements(box);
    const SurfaceFunctionals all = surfaceFunctionals(elements, {{0, 0, 0}, {20, 20, 20}});
    CHECK(all.area == Approx(600));
    CHECK(all.meanCurvature == Approx(3 * kPi * 10).epsilon(1e-6));
    CHECK(surfaceFunctionals(elements, {{30, 0, 0}, {40, 20, 20}}).area == 0);
    // Turned inside out everything is concave.
    for (Quad& quad : box.quads) std::reverse(quad.begin(), quad.end());
    CHECK(surfaceFunctionals(surfaceElements(box), {{0, 0, 0}, {20, 20, 20}}).meanCurvature ==
          Approx(-3 * kPi * 10).epsilon(1e-6));
    CHECK(surfaceElements(Mesh{}).areas.elements.empty());
    CHECK(surfaceFunctionals(surfaceElements(Mesh{}), {{0, 0, 0}, {20, 20, 20}}).area == 0);
}

TEST_CASE("surfaceFunctionals: the boxes of any partition sum to the whole", "[measure][property]") {
    Mesh ball = test::sphereMesh(25.3, 4);
    for (Vec3f& p : ball.points) p = p + Vec3f{-3, 20, 9};
    const SurfaceElements elements = surfaceElements(ball);
    const IndexBox around{{-40, -20, -30}, {37, 57, 49}};
    const SurfaceFunctionals all = surfaceFunctionals(elements, around);
    CHECK(all.area == Approx(4 * kPi * 25.3 * 25.3).epsilon(0.01));
    for (int side : {5, 16, 23}) {
        SurfaceFunctionals sum;
        for (int x = around.min.x; x <= around.max.x; x += side)
            for (int y = around.min.y; y <= around.max.y; y += side)
                for (int z = around.min.z; z <= around.max.z; z += side) {
                    const SurfaceFunctionals part =
                        surfaceFunctionals(elements, IndexBox::cube({x, y, z}, side).intersection(around));
                    sum.area += part.area;
                    sum.meanCurvature += part.meanCurvature;
                }
        CHECK(sum.area == Approx(all.area));
        CHECK(sum.meanCurvature == Approx(all.meanCurvature));
    }
}
