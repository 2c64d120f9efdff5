#include "libvdbsynth/vdb/convert/level_set_to_points.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/level_sets.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;
using test::ball;

namespace {

PointCloud pointsOf(const openvdb::FloatGrid& grid, double spacing, const RunContext& ctx = {}) {
    PointOptions options;
    options.spacing = spacing;
    return levelSetToPoints(grid, options, ctx);
}

bool same(const PointCloud& a, const PointCloud& b) {
    const auto equal = [](const Vec3f& p, const Vec3f& q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
    return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), equal) &&
           std::equal(a.normals.begin(), a.normals.end(), b.normals.begin(), b.normals.end(), equal);
}

}  // namespace

TEST_CASE("levelSetToPoints: even spacing, outward unit normals", "[vdb][property]") {
    const PointCloud cloud = pointsOf(*ball(), 2);
    REQUIRE(cloud.points.size() == cloud.normals.size());
    // Darts end at 0.547 of the area under disks of half the spacing's radius (random sequential adsorption).
    CHECK(double(cloud.points.size()) > 0.88 * 0.547 * 1256.6 / 0.7854);
    double farthest = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        CHECK(double(length(cloud.points[i])) == Approx(10).margin(0.05));
        CHECK(double(length(cloud.normals[i])) == Approx(1).margin(1e-4));
        CHECK(double(dot(cloud.normals[i], normalized(cloud.points[i]))) > 0.99);
        float nearest = 1e9f;
        for (std::size_t j = 0; j < cloud.points.size(); ++j)
            if (j != i) nearest = std::min(nearest, length(cloud.points[i] - cloud.points[j]));
        REQUIRE(nearest >= 0.999f);
        farthest = std::max(farthest, double(nearest));
    }
    CHECK(farthest < 2.0);
}

TEST_CASE("levelSetToPoints: in the world, by a spacing in voxels", "[vdb][property]") {
    const FloatGridPtr grid = ball();
    grid->transform().postScale(openvdb::Vec3d(-3, 3, 3));
    grid->transform().postTranslate(openvdb::Vec3d(100, 0, 0));
    const PointCloud cloud = pointsOf(*grid, 4);
    REQUIRE(cloud.points.size() > 180);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const Vec3f out = cloud.points[i] - Vec3f{100, 0, 0};
        REQUIRE(double(length(out)) == Approx(30).margin(0.15));
        REQUIRE(double(dot(cloud.normals[i], normalized(out))) > 0.99);
        for (std::size_t j = 0; j < i; ++j) REQUIRE(length(cloud.points[i] - cloud.points[j]) > 5.99f);
    }
}

TEST_CASE("levelSetToPoints: repeats by seed, same bits for any number of threads", "[vdb][determinism]") {
    const FloatGridPtr grid = ball();
    RunContext one, four, other;
    one.threads = 1;
    four.threads = 4;
    other.seed = 1;
    const PointCloud cloud = pointsOf(*grid, 2, one);
    CHECK(same(cloud, pointsOf(*grid, 2, four)));
    CHECK_FALSE(same(cloud, pointsOf(*grid, 2, other)));
}

TEST_CASE("levelSetToPoints: a surface under the spacing has one point", "[vdb][degenerate]") {
    CHECK(pointsOf(*ball(), 100).points.size() == 1);
}

TEST_CASE("levelSetToPoints: options out of their range, no surface, cancel", "[vdb][error][cancel]") {
    const FloatGridPtr grid = ball();
    for (double spacing : {0.1, 100.1, std::nan("")}) {
        const test::Thrown thrown = test::thrownBy([&] { pointsOf(*grid, spacing); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`spacing`"));
    }
    CHECK(test::thrownBy([&] { pointsOf(*openvdb::FloatGrid::create(3.f), 1); }).code ==
          int(ErrorCode::EmptyInput));
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { pointsOf(*grid, 1, ctx); }).code == int(ErrorCode::Cancelled));
}
