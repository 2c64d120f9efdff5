#include "libvdbsynth/render/traced_surface.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

namespace {

FloatGridPtr ball(double radius, double voxel) {
    openvdb::initialize();
    return meshToLevelSet(test::sphereMesh(radius, 5), voxel, 3, "ball");
}

}  // namespace

TEST_CASE("TracedSurface: rays meet a ball where it is, and pass beside it", "[render][oracle]") {
    const FloatGridPtr grid = ball(20, 0.5);
    const TracedSurface surface(*grid);
    std::size_t met = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Random random(1, i);
        // From outside in any direction that comes near.
        const Vec3d from =
            normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}) * 70.0;
        const Vec3d aim{random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-30, 30)};
        const Vec3d way = normalized(aim - from);
        const double b = dot(from, way), c = dot(from, from) - 400, d = b * b - c;
        float along = 0;
        const bool hit = surface.meets(cast<float>(surface.placeHere(from)),
                                       normalized(cast<float>(surface.directionHere(way))), along);
        if (std::abs(d) < 30) continue;  // grazing
        CHECK(hit == (d > 0));
        if (!hit || d < 0) continue;
        ++met;
        CHECK(double(along) * 0.5 == Approx(-b - std::sqrt(d)).margin(0.08));
        const Vec3d place = from + way * (double(along) * 0.5);
        const Vec3f normal = surface.normalAt(cast<float>(surface.placeHere(place)));
        CHECK(dot(cast<double>(normal), normalized(place)) > 0.999);
    }
    CHECK(met > 400);
}

TEST_CASE("TracedSurface: distances to a ball everywhere", "[render][oracle]") {
    const FloatGridPtr grid = ball(20, 1);
    const TracedSurface surface(*grid);
    CHECK(surface.coarseness() >= 2);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Random random(2, i);
        const Vec3d p{random.uniform(-80, 80), random.uniform(-80, 80), random.uniform(-80, 80)};
        const double exact = length(p) - 20;
        const double found = double(surface.farDistance(cast<float>(surface.placeHere(p))));
        CHECK(found >= 0);
        if (exact < 0) {
            CHECK(found < 0.05);
            continue;
        }
        // Beyond the voxels it is never more than it is, and a right angle is the worst that the bound meets.
        CHECK(found <= exact + 0.6);
        CHECK(found >= exact / 1.415 - 1);
        if (exact < 3) CHECK(found == Approx(exact).margin(0.35));
    }
}

TEST_CASE("TracedSurface: the outline holds the ball and hardly more", "[render]") {
    const FloatGridPtr grid = ball(20, 1);
    const TracedSurface surface(*grid);
    double most = 0;
    for (const Vec3d& p : surface.outline())
        most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    CHECK((most >= 19.9 && most <= 21));
    const Vec3d down = normalized(surface.directionHere(Vec3d{0, 0, 1}));
    const double lowest = surface.lowest(down);
    CHECK(lowest == Approx(dot(down, surface.placeHere({0, 0, -20}))).margin(0.1));
}

TEST_CASE("TracedSurface: a turned, mirrored and far grid is where it is", "[render]") {
    const FloatGridPtr grid = ball(8, 0.5)->deepCopy();
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    matrix.setToRotation(openvdb::Vec3d(1, 2, 3), 0.7);
    matrix.preScale(openvdb::Vec3d(-0.5, 0.5, 0.5));
    matrix.postTranslate(openvdb::Vec3d(1e5, -2e5, 10));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    const TracedSurface surface(*grid);
    const Vec3d middle{1e5, -2e5, 10};
    for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, normalized(Vec3d{1, 1, 1})}) {
        float along = 0;
        REQUIRE(surface.meets(cast<float>(surface.placeHere(middle - way * 30.0)),
                              normalized(cast<float>(surface.directionHere(way))), along));
        CHECK(double(along) * 0.5 == Approx(22).margin(0.1));
    }
    const Vec3d back = transformed(surface.toWorld(), surface.placeHere({1e5 + 1, -2e5 + 2, 3}));
    CHECK(length(back - Vec3d{1e5 + 1, -2e5 + 2, 3}) < 1e-6);
}

TEST_CASE("TracedSurface: nothing inside is an error", "[render][error]") {
    const auto empty = openvdb::FloatGrid::create(3.f);
    empty->setGridClass(openvdb::GRID_LEVEL_SET);
    CHECK(test::thrownBy([&] { TracedSurface{*empty}; }).code == int(ErrorCode::EmptyInput));
}
