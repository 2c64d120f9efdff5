#include "libvdbsynth/surface/surface_shell.h"

#include <catch2/catch.hpp>

#include "tests/support/shapes.h"

using namespace vdbsynth;

TEST_CASE("surfaceShell: of a sphere, points lie on it and normals point away", "[surface]") {
    const SurfaceShell shell = surfaceShell(*test::sphereField(40, 14));
    REQUIRE(shell.size() > 3000);
    const Vec3f middle{19.5f, 19.5f, 19.5f};
    for (std::size_t i = 0; i < shell.size(); ++i) {
        CHECK(length(shell.point[i] - middle) == Approx(14).margin(0.05));
        CHECK(dot(shell.normal[i], normalized(shell.point[i] - middle)) > 0.995f);
        CHECK(shell.begin[i + 1] > shell.begin[i]);
    }
}

TEST_CASE("surfaceShell: neighbours are mutual, and never across a thin wall", "[surface][property]") {
    const auto wall =
        test::shapeField({24, 24, 24}, [](const Vec3d& p) { return std::abs(p.z - 11.5) - 0.6; });
    const SurfaceShell shell = surfaceShell(*wall);
    REQUIRE(shell.size() > 0);
    for (std::uint32_t i = 0; i < shell.size(); ++i)
        for (std::uint32_t k = shell.begin[i]; k < shell.begin[i + 1]; ++k) {
            const std::uint32_t j = shell.neighbours[k];
            CHECK(shell.normal[i].z * shell.normal[j].z > 0);
            CHECK(std::count(shell.neighbours.begin() + shell.begin[j],
                             shell.neighbours.begin() + shell.begin[j + 1], i) == 1);
        }
}

TEST_CASE("surfaceShell: no surface is an error, threads change nothing", "[surface]") {
    const BrickField nothing(IndexBox::fromSize({16, 16, 16}), 5.f);
    CHECK(test::thrownBy([&] { surfaceShell(nothing); }).code == int(ErrorCode::EmptyInput));
    RunContext one;
    one.threads = 1;
    const auto field = test::sphereField(32, 10);
    CHECK(surfaceShell(*field).neighbours == surfaceShell(*field, one).neighbours);
}
