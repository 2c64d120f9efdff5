#include "libvdbsynth/geometry/mesh_check.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

TEST_CASE("requireMesh: what a program may get wrong is an error that names it", "[geometry][error]") {
    const Mesh good = test::boxMesh({0, 0, 0}, {1, 1, 1});
    const auto refused = [](const Mesh& mesh) { return test::thrownBy([&] { requireMesh(mesh, "box"); }); };
    CHECK(refused(good).message.empty());
    CHECK(refused({}).code == int(ErrorCode::EmptyInput));
    Mesh bad = good;
    bad.quads[2][1] = 8;
    CHECK(test::contains(refused(bad).message, "box: face 2 uses point 8 of 8"));
    bad = good;
    bad.triangles.push_back({0, 1, 4000000000u});
    CHECK(refused(bad).code == int(ErrorCode::BadData));
    bad = good;
    bad.points[3].y = NAN;
    CHECK(test::contains(refused(bad).message, "point 3 is not finite"));
    bad = good;
    bad.attributes.push_back({"Cd", 3, std::vector<float>(8)});
    CHECK(test::contains(refused(bad).message, "\"Cd\""));
}
