#include "libvdbsynth/geometry/quadric.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("Quadric: one plane projects, two meet in an edge, three in a corner", "[geometry][oracle]") {
    const auto at = [](const Quadric::Minimum& m, double x, double y, double z) {
        return m.point.x == Approx(x).margin(1e-9) && m.point.y == Approx(y).margin(1e-9) &&
               m.point.z == Approx(z).margin(1e-9);
    };
    Quadric sum;
    CHECK(sum.empty());
    CHECK(at(sum.minimum({1, 2, 3}), 1, 2, 3));
    sum.add({0, 0, 1}, {5, 5, 2});
    CHECK(at(sum.minimum({1, 2, 3}), 1, 2, 2));
    CHECK(sum.minimum({1, 2, 3}).rank == 1);
    sum.add({0, 1, 0}, {0, 7, 0}, 0.5);
    CHECK(at(sum.minimum({1, 2, 3}), 1, 7, 2));
    CHECK(sum.minimum({1, 2, 3}).rank == 2);
    sum.add({0.6, 0.8, 0}, {0, 7, 0});
    CHECK(at(sum.minimum({1, 2, 3}), 0, 7, 2));
    CHECK(sum.minimum({1, 2, 3}).rank == 3);
}

TEST_CASE("Quadric: planes that nearly agree are one", "[geometry][property]") {
    Quadric sum;
    sum.add(normalized(Vec3d{0.03, 0, 1}), {0, 0, 1});
    sum.add(normalized(Vec3d{-0.03, 0, 1}), {0, 0, 1.1});
    const Quadric::Minimum best = sum.minimum({4, 4, 0});
    CHECK(best.rank == 1);
    CHECK(best.point.x == Approx(4).margin(0.01));
    CHECK(best.point.z == Approx(1.05).margin(0.01));
}
