#include "libvdbsynth/distance/winding_number.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// Faces of a box but for its top.
Mesh openBox() {
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 1, 1});
    Mesh open;
    open.points = mesh.points;
    for (const Triangle& t : triangulated(mesh)) {
        bool top = true;
        for (std::uint32_t corner : t) top = top && mesh.points[corner].z == 1;
        if (!top) open.triangles.push_back(t);
    }
    return open;
}

}  // namespace

TEST_CASE("WindingNumber: one inside, zero outside a closed mesh, far clusters summed up",
          "[geometry][oracle]") {
    const Mesh mesh = test::sphereMesh(1, 4);
    const WindingNumber winding(mesh);
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{0.9, 0, 0}, Vec3d{0.3, -0.5, 0.6}})
        CHECK(winding.at(p) == Approx(1).margin(0.02));
    for (const Vec3d& p : {Vec3d{1.1, 0, 0}, Vec3d{2, 3, -1}, Vec3d{100, 0, 0}})
        CHECK(winding.at(p) == Approx(0).margin(0.02));
}

TEST_CASE("WindingNumber: of a box without its top, by hand", "[geometry][oracle]") {
    const WindingNumber winding(openBox());
    // The missing face is a sixth of all directions from the middle.
    CHECK(winding.at({0.5, 0.5, 0.5}) == Approx(5.0 / 6).margin(1e-6));
    CHECK(winding.at({0.5, 0.5, -0.5}) < 0.2);
    // Just above the opening it is nearly half of all directions that see faces from behind.
    CHECK(winding.at({0.5, 0.5, 1}) == Approx(0.5).margin(1e-6));
}

TEST_CASE("WindingNumber: sheets around a place add up, one way and the other", "[geometry][oracle]") {
    for (int sheets = 1; sheets <= 5; ++sheets)
        for (bool inverted : {false, true}) {
            Mesh mesh;
            for (int k = 0; k < sheets; ++k) {
                const float low = -float(k), high = 1 + float(k);
                const Mesh box = test::boxMesh({low, low, low}, {high, high, high});
                const std::uint32_t first = std::uint32_t(mesh.points.size());
                mesh.points.insert(mesh.points.end(), box.points.begin(), box.points.end());
                for (const Triangle& t : triangulated(box))
                    mesh.triangles.push_back(inverted ? Triangle{t[0] + first, t[2] + first, t[1] + first}
                                                      : Triangle{t[0] + first, t[1] + first, t[2] + first});
            }
            const WindingNumber winding(mesh);
            const double expected = inverted ? -sheets : sheets;
            for (const Vec3d& p : {Vec3d{0.5, 0.5, 0.5}, Vec3d{0.1, 0.7, 0.3}})
                CHECK(winding.at(p) == Approx(expected).margin(1e-6));
            // In the plane of one of the innermost box's faces.
            CHECK(winding.at({1, 0.5, 0.5}) == Approx(expected - (inverted ? -0.5 : 0.5)).margin(1e-6));
        }
}

TEST_CASE("WindingNumber: no faces, and faces without area", "[geometry][degenerate]") {
    CHECK(WindingNumber(Mesh{}).at({0, 0, 0}) == 0);
    Mesh line;
    line.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.triangles = {{0, 1, 2}};
    CHECK(WindingNumber(line).at({0.5, 1, 0}) == Approx(0).margin(1e-12));
}

TEST_CASE("solidShare: all of a closed mesh, nothing of a flat sheet", "[geometry][property]") {
    const Mesh ball = test::sphereMesh(1, 3);
    CHECK(solidShare(ball, WindingNumber(ball)) == Approx(1));
    const Mesh box = openBox();
    CHECK(solidShare(box, WindingNumber(box)) > 0.9);
    Mesh sheet;
    sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    sheet.quads = {{0, 1, 2, 3}};
    CHECK(solidShare(sheet, WindingNumber(sheet)) == 0);
}
