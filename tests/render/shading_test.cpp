#include "libvdbsynth/render/shading.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

namespace {

// A camera from the front, a little above.
Camera front() {
    Camera camera;
    camera.forward = normalized(Vec3d{0, 1, -0.3});
    camera.right = {1, 0, 0};
    camera.up = cross(camera.right, camera.forward);
    return camera;
}

}  // namespace

TEST_CASE("shownByte, lightOf: sRGB below the knee, rising, and each other's inverse", "[render][oracle]") {
    CHECK(int(shownByte(0)) == 0);
    CHECK(int(shownByte(-1)) == 0);
    CHECK(int(shownByte(1e9f)) == 255);
    for (int byte = 0; byte < 256; ++byte) {
        const float light = lightOf(float(byte) / 255);
        const double exact =
            byte / 255.0 <= 0.04045 ? byte / 255.0 / 12.92 : std::pow((byte / 255.0 + 0.055) / 1.055, 2.4);
        CHECK(double(light) == Approx(exact).margin(2e-6));
        if (light < 0.69f) CHECK(int(shownByte(light)) == byte);
    }
    for (int i = 0; i < 3000; ++i) CHECK(shownByte(float(i) / 1000) <= shownByte(float(i + 1) / 1000));
}

TEST_CASE("Lighting: a ball hides the light from the ground behind it, and half the sky from below it",
          "[render]") {
    openvdb::initialize();
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(20, 4), 1, 3, "ball");
    const TracedSurface surface(*grid);
    const Lighting lighting(surface, front(), {0, 0, 1});
    const Vec3f middle = surface.middle();
    CHECK(lighting.sun().z > 0.5f);
    CHECK(lighting.sun().x < 0);  // from the left
    // Straight behind the ball, seen from the light; beside it; far away.
    CHECK(lighting.sunAt(middle - lighting.sun() * 30.f) == 0);
    CHECK(lighting.sunAt(middle + lighting.sun() * 30.f) == 1);
    CHECK(lighting.sunAt(middle + Vec3f{200, 0, -20}) > 0.99f);
    // Between is a soft edge: all values from dark to light, in order.
    const Vec3f across = normalized(cross(lighting.sun(), Vec3f{0, 0, 1}));
    float last = 0;
    int between = 0;
    for (float way = 0; way < 60; way += 0.5f) {
        const float light = lighting.sunAt(middle - lighting.sun() * 45.f + across * way);
        CHECK(light >= last - 0.03f);
        between += light > 0.05f && light < 0.95f;
        last = light;
    }
    CHECK(between > 6);
    CHECK(last > 0.99f);
    // The ground right under the ball gets less light than the ground far away.
    const Vec3f under = lighting.onGround(middle - Vec3f{0, 0, 20}),
                far = lighting.onGround(middle + Vec3f{300, 0, -20});
    CHECK(under.x < 0.25f);
    CHECK(far.x > 0.97f);
    CHECK(far.x <= 1.0001f);
}

TEST_CASE("Lighting: the floor of a groove sees less of the sky than the top beside it", "[render]") {
    // Two bars with a gap of 6, 30 deep.
    Mesh bars = test::boxMesh({0, 0, 0}, {60, 27, 30});
    const Mesh other = test::boxMesh({0, 33, 0}, {60, 60, 30});
    for (Quad q : other.quads) {
        for (std::uint32_t& i : q) i += 8;
        bars.quads.push_back(q);
    }
    bars.points.insert(bars.points.end(), other.points.begin(), other.points.end());
    const FloatGridPtr grid = meshToLevelSet(bars, 1, 3, "bars");
    const TracedSurface surface(*grid);
    const Lighting lighting(surface, front(), {0, 0, 1});
    const auto here = [&](const Vec3d& p) { return cast<float>(surface.placeHere(p)); };
    const float top = lighting.openAt(here({30, 15, 30}), {0, 0, 1});
    const float wall = lighting.openAt(here({30, 27, 6}), {0, 1, 0});
    CHECK(top > 0.9f);
    CHECK(wall < 0.35f);
    const Vec3f lit = lighting.shaded(here({30, 15, 30}), {0, 0, 1}, {0, 0, 1}, kClay,
                                      lighting.skyOver(here({30, 15, 30}), {0, 0, 1}));
    const Vec3f dark = lighting.shaded(here({30, 27, 6}), {0, 1, 0}, {0, 0, 1}, kClay,
                                       lighting.skyOver(here({30, 27, 6}), {0, 1, 0}));
    CHECK(lit.x > 2.5f * dark.x);
    CHECK(lit.x > lit.z);  // clay is warm
}

TEST_CASE("Background: plain is one colour, the studio is cool and lighter above", "[render]") {
    Background plain{Background::Kind::Plain, {1, 0.5f, 0}};
    CHECK(plain.at(0).y == lightOf(0.5f));
    CHECK(plain.at(1).x == 1);
    const Background studio{};
    CHECK(studio.at(1).x > studio.at(0).x);
    CHECK(studio.at(0.5f).z > studio.at(0.5f).x);
    CHECK(Background{Background::Kind::Transparent, {}}.at(0.5f).x == 0);
}
