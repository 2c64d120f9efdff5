#include "libvdbsynth/procedural/primitives.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("Primitive: distances by hand", "[procedural][fast]") {
    CHECK(ball({0, 0, 0}, 2).distance({5, 0, 0}) == Approx(3));
    CHECK(capsule({0, 0, 0}, {10, 0, 0}, 1).distance({5, 3, 4}) == Approx(4));
    CHECK(capsule({0, 0, 0}, {10, 0, 0}, 1).distance({13, 4, 0}) == Approx(4));
    CHECK(torus({0, 0, 0}, {0, 0, 5}, 4, 1).distance({4, 0, 0}) == Approx(-1));
    CHECK(torus({0, 0, 0}, {0, 0, 1}, 4, 1).distance({0, 0, 0}) == Approx(3));
    CHECK(torus({0, 0, 0}, {0, 0, 1}, 4, 1).distance({0, 7, 4}) == Approx(4));
}

TEST_CASE("unionField: equals the least of all distances, clamped", "[procedural][oracle]") {
    std::vector<Primitive> primitives;
    for (std::uint64_t i = 0; i < 30; ++i) {
        Random random(2, i);
        const auto point = [&] {
            return Vec3d{random.uniform(-5, 70), random.uniform(-5, 50), random.uniform(-5, 60)};
        };
        if (i % 3 == 0) primitives.push_back(ball(point(), random.uniform(2, 8)));
        if (i % 3 == 1) primitives.push_back(capsule(point(), point(), random.uniform(1, 3)));
        if (i % 3 == 2) primitives.push_back(torus(point(), point(), random.uniform(4, 9), 1.5));
    }
    const IndexBox box{{-6, -6, -6}, {69, 50, 60}};
    const BrickField field = unionField(primitives, box, 4.f, {});
    const auto distance = unionDistance(primitives, box, 4);
    for (std::uint64_t i = 0; i < 4000; ++i) {
        Random random(3, i);
        const Index3 p{int(random.below(76)) - 6, int(random.below(57)) - 6, int(random.below(67)) - 6};
        double nearest = 4;
        for (const Primitive& primitive : primitives)
            nearest = std::min(nearest, primitive.distance({double(p.x), double(p.y), double(p.z)}));
        REQUIRE(double(field.at(p)) == Approx(std::max(nearest, -4.0)).margin(1e-5));
        REQUIRE(distance({double(p.x), double(p.y), double(p.z)}) == Approx(nearest));
    }
}

TEST_CASE("scaled: distances of the same shapes in finer voxels", "[procedural][property]") {
    for (const Primitive& shape :
         {ball({1, 2, 3}, 2), capsule({0, 1, 0}, {4, 0, 2}, 1), torus({3, 1, 1}, {0.2, 0.1, 1}, 4, 1)})
        for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{5, -2, 1}, Vec3d{2, 2, 2}})
            CHECK(scaled(shape, 3).distance(p * 3.0) == Approx(3 * shape.distance(p)));
}

TEST_CASE("unionDistance: between voxels and around its box", "[procedural]") {
    const auto distance =
        unionDistance({ball({10, 10, 10}, 3), ball({36, 10, 10}, 3)}, {{0, 0, 0}, {39, 20, 20}}, 4);
    CHECK(distance({13.25, 10, 10}) == Approx(0.25));
    CHECK(distance({31.9, 10, 10}) == Approx(1.1));  // beyond the edge of a cell
    CHECK(distance({42.5, 10, 10}) == Approx(3.5));
    CHECK(distance({-3, -3, 10}) == 4);
}
