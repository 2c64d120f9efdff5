#include "libvdbsynth/patch/onto/surface_disk.h"

#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

std::uint32_t middleSite(const OntoSurface& surface, float side) {
    return test::siteAt(surface, {side / 2, side / 2, 0});
}

}  // namespace

TEST_CASE("SurfaceDisks: on a plane a disk is the plane") {
    const OntoSurface surface = test::surfaceAlong(test::squareShape(40, 1), {1, 0, 0}, 1);
    SurfaceDisks disks(surface);
    const std::uint32_t centre = middleSite(surface, 40);
    const SurfaceDisk disk = disks.around(centre, 12);
    CHECK(disk.centre == centre);
    REQUIRE(std::is_sorted(disk.site.begin(), disk.site.end()));
    std::size_t within = 0;
    for (const Vec3f& p : surface.sites.point)
        within += length(p - surface.sites.point[centre]) <= 12 ? 1 : 0;
    CHECK(disk.size() == within);
    for (std::size_t m = 0; m < disk.size(); ++m) {
        const Vec3f away = surface.sites.point[disk.site[m]] - surface.sites.point[centre];
        REQUIRE(length(disk.at[m] - Vec2f{away.x, away.y}) < 1e-3f);
        REQUIRE(length(disk.turn[m] - Vec2f{1, 0}) < 1e-3f);
        CHECK(disk.find(disk.site[m]) == std::ptrdiff_t(m));
    }
    CHECK(disk.find(0) == -1);
    // The next one does not remember this one.
    CHECK(disks.around(0, 3).size() < 30);
    CHECK(disks.around(centre, 12).site == disk.site);
    CHECK(disks.around(centre, 1e-3).size() == 1);
}

TEST_CASE("SurfaceDisks: a tube is unrolled, and a disk turns with its centre's tangent") {
    const double radius = 15;
    const test::PointShape tube = test::tubeShape(radius, 60, 1);
    const OntoSurface surface = test::surfaceAlong(tube, {0, 0, 1}, 1);
    const std::uint32_t centre = test::siteAt(surface, {15, 0, 30});
    const SurfaceDisk disk = SurfaceDisks(surface).around(centre, 20);
    const Vec3f c = surface.sites.point[centre];
    const double own = arcTangent(double(c.y), double(c.x));
    for (std::size_t m = 0; m < disk.size(); ++m) {
        const Vec3f p = surface.sites.point[disk.site[m]];
        double angle = arcTangent(double(p.y), double(p.x)) - own;
        angle -= 2 * kPi * std::round(angle / (2 * kPi));
        // +x along z; +y is normal x tangent, against the angle.
        const Vec2f wanted{p.z - c.z, float(-radius * angle)};
        REQUIRE(length(disk.at[m] - wanted) < 0.1f);
        REQUIRE(length(disk.turn[m] - Vec2f{1, 0}) < 0.01f);
    }
}

TEST_CASE("SurfaceDisks: on a ball distances from the centre are those along great circles") {
    const double radius = 20;
    const OntoSurface surface = test::surfaceAlong(test::spiralSphere(5000, radius), {0, 0, 1}, 1);
    const std::uint32_t centre = test::siteAt(surface, {20, 0, 0});
    const SurfaceDisk disk = SurfaceDisks(surface).around(centre, 15);
    CHECK(disk.size() > 600);
    for (std::size_t m = 0; m < disk.size(); ++m) {
        const double chord =
            double(length(surface.sites.point[disk.site[m]] - surface.sites.point[centre])) / (2 * radius);
        const double arc = 2 * radius * arcTangent(chord, std::sqrt(1 - chord * chord));
        REQUIRE(std::abs(double(length(disk.at[m])) - arc) < 0.02 * arc + 0.05);
    }
}
