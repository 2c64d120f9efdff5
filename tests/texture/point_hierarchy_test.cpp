#include "libvdbsynth/texture/point_hierarchy.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/texture/point_surface.h"
#include "tests/support/contexts.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

std::vector<std::size_t> membersOf(const CoarserSites& coarser) {
    std::vector<std::size_t> members(coarser.point.size());
    for (const std::uint32_t parent : coarser.parent) ++members[parent];
    return members;
}

}  // namespace

TEST_CASE("mergedByFours: five points on a line by hand") {
    // The first takes its three nearest; the last is left.
    const SurfaceSites sites = sitesOfPoints({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4.5f, 0, 0}},
                                             std::vector<Vec3f>(5, {0, 0, 1}), 4);
    const CoarserSites coarser = mergedByFours(sites);
    CHECK(coarser.parent == std::vector<std::uint32_t>{0, 0, 0, 0, 1});
    REQUIRE(coarser.point.size() == 2);
    CHECK(coarser.point[0].x == Approx(1.5));
    CHECK(coarser.point[1].x == Approx(4.5));
    CHECK(coarser.normal[0].z == 1);
}

TEST_CASE("mergedByFours: nearly all clusters have four members, and those are near each other") {
    const PointSurface surface = pointSurface(test::targetOf(test::spiralSphere(20000, 1)), 25);
    const CoarserSites coarser = mergedByFours(surface.sites);
    std::size_t four = 0;
    for (const std::size_t members : membersOf(coarser)) {
        REQUIRE((members >= 1 && members <= 4));
        if (members == 4) ++four;
    }
    CHECK(double(four) > 0.97 * double(coarser.point.size()));
    CHECK(double(coarser.point.size()) < 0.26 * 20000);
    double farthest = 0;
    for (std::size_t i = 0; i < coarser.parent.size(); ++i)
        farthest =
            std::max(farthest, double(length(surface.sites.point[i] - coarser.point[coarser.parent[i]])));
    CHECK(farthest < 6 * surface.spacing);
}

TEST_CASE("mergedByFours: two sides of a thin wall stay apart") {
    test::PointShape wall = test::latticePlane(16);
    for (std::size_t i = 0; i < 256; ++i) {
        wall.point.push_back(wall.point[i] + Vec3f{0, 0, -0.1f});
        wall.normal.push_back({0, 0, -1});
    }
    const SurfaceSites sites = sitesOfPoints(wall.point, wall.normal, 12);
    const CoarserSites coarser = mergedByFours(sites);
    for (std::size_t i = 0; i < sites.size(); ++i)
        REQUIRE(dot(coarser.normal[coarser.parent[i]], sites.normal[i]) > 0.9f);
}

TEST_CASE("mergedByFours: degenerate sets, cancel") {
    CHECK(mergedByFours({}).point.empty());
    const std::vector<Vec3f> up(5, {0, 0, 1});
    CHECK(mergedByFours(sitesOfPoints(std::vector<Vec3f>(5, {1, 1, 1}), up, 4)).point.size() == 5);
    const SurfaceSites sites = sitesOfPoints(test::latticePlane(40).point, test::latticePlane(40).normal, 8);
    const auto thrown = test::thrownWhenCancelled([&](const RunContext& ctx) { mergedByFours(sites, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
