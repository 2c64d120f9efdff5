#include "libvdbsynth/patch/onto/chart_surface.h"

#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// A difference quotient against the derivatives.
void requireDerivatives(const ChartSurface& chart, double x, double y) {
    constexpr double kStep = 1e-4;
    const auto here = chart.at(x, y);
    REQUIRE(here);
    for (int axis = 0; axis < 2; ++axis) {
        const double dx = axis == 0 ? kStep : 0, dy = axis == 1 ? kStep : 0;
        const auto low = chart.at(x - dx, y - dy), high = chart.at(x + dx, y + dy);
        REQUIRE(low);
        REQUIRE(high);
        const std::size_t a = std::size_t(axis);
        REQUIRE(length((high->point - low->point) * (0.5 / kStep) - here->alongPoint[a]) < 1e-3);
        REQUIRE(length((high->normal - low->normal) * (0.5 / kStep) - here->alongNormal[a]) < 1e-3);
    }
}

}  // namespace

TEST_CASE("ChartSurface: a plane is flat, and nothing is beyond the disk") {
    const OntoSurface surface = test::surfaceAlong(test::squareShape(40, 1), {1, 0, 0}, 1);
    const std::uint32_t centre = test::siteAt(surface, {20, 20, 0});
    const SurfaceDisk disk = SurfaceDisks(surface).around(centre, 14);
    const ChartSurface chart(surface.sites, disk, 1);
    const Vec3d middle = cast<double>(surface.sites.point[centre]);
    for (double x = -9; x < 9; x += 0.73)
        for (double y = -4; y < 4; y += 0.61) {
            const auto place = chart.at(x, y);
            REQUIRE(place);
            REQUIRE(length(place->point - middle - Vec3d{x, y, 0}) < 2e-3);
            REQUIRE(length(place->normal - Vec3d{0, 0, 1}) < 1e-6);
            REQUIRE(std::abs(place->curvatures()[0]) < 1e-4);
            REQUIRE(std::abs(place->curvatures()[1]) < 1e-4);
            const std::ptrdiff_t member =
                chart.nearestMember(surface.sites, disk, {float(x), float(y)}, place->point);
            REQUIRE(member >= 0);
            REQUIRE(length(disk.at[std::size_t(member)] - Vec2f{float(x), float(y)}) < 1.1f);
        }
    requireDerivatives(chart, 3.3, -2.2);
    CHECK(!chart.at(30, 0));
    CHECK(!chart.at(0, -1e9));
    CHECK(chart.nearestMember(surface.sites, disk, {1000, 0}, {0, 0, 0}) == -1);
}

TEST_CASE("ChartSurface: a tube and a ball have their curvatures") {
    const OntoSurface tube = test::surfaceAlong(test::tubeShape(15, 60, 1), {0, 0, 1}, 1);
    const SurfaceDisk round = SurfaceDisks(tube).around(test::siteAt(tube, {15, 0, 30}), 16);
    const ChartSurface unrolled(tube.sites, round, 1);
    const OntoSurface ball = test::surfaceAlong(test::spiralSphere(5000, 20), {0, 0, 1}, 1);
    const SurfaceDisk cap = SurfaceDisks(ball).around(test::siteAt(ball, {20, 0, 0}), 12);
    const ChartSurface bent(ball.sites, cap, 1);
    for (double x = -7; x < 7; x += 0.9)
        for (double y = -3; y < 3; y += 0.8) {
            const auto on = unrolled.at(x, y), over = bent.at(x, y);
            REQUIRE(on);
            REQUIRE(over);
            REQUIRE(std::abs(std::sqrt(on->point.x * on->point.x + on->point.y * on->point.y) - 15) < 0.01);
            REQUIRE(std::abs(on->curvatures()[0]) < 0.005);
            REQUIRE(std::abs(on->curvatures()[1] - 1 / 15.0) < 0.005);
            REQUIRE(std::abs(length(over->point) - 20) < 0.01);
            REQUIRE(std::abs(over->curvatures()[0] - 0.05) < 0.005);
            REQUIRE(std::abs(over->curvatures()[1] - 0.05) < 0.005);
            REQUIRE(dot(over->normal, normalized(over->point)) > 0.9999);
        }
    requireDerivatives(unrolled, 2.1, 1.7);
    requireDerivatives(bent, -3.4, 0.2);
}

TEST_CASE("ChartSurface: a few sites carry nothing") {
    const OntoSurface surface = test::surfaceAlong(test::squareShape(3, 1), {1, 0, 0}, 1);
    const SurfaceDisk disk = SurfaceDisks(surface).around(0, 10);
    CHECK(!ChartSurface(surface.sites, disk, 1).at(0, 0));
    CHECK(!ChartSurface(surface.sites, SurfaceDisk{}, 1).at(0, 0));
}
