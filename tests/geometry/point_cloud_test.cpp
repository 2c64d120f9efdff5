#include "libvdbsynth/geometry/point_cloud.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

PointCloud ball(float radius) {
    PointCloud cloud;
    for (const Vec3f& p : test::sphereMesh(double(radius), 4).points) cloud.points.push_back(p);
    return cloud;
}

}  // namespace

TEST_CASE("pointSpacing: about the step of a square lattice", "[geometry][oracle]") {
    PointCloud plane;
    for (int x = 0; x < 20; ++x)
        for (int y = 0; y < 20; ++y) plane.points.push_back({float(x) * 0.5f, float(y) * 0.5f, 1});
    const std::vector<float> spacing = pointSpacing(plane);
    // Four neighbours at the step, two at root two of it: root of (4 + 4) / 6 / 2.
    CHECK(spacing[10 * 20 + 10] == Approx(0.5 * std::sqrt(8.0 / 12)));
}

TEST_CASE("dropOutliers: repeats and far points go, the rest stays in order", "[geometry][property]") {
    PointCloud cloud = ball(10);
    const std::vector<Vec3f> before = cloud.points;
    cloud.points.push_back({100, 0, 0});
    cloud.points.push_back(before[5]);
    cloud.points.push_back({0, -300, 7});
    CHECK(dropOutliers(cloud).points == 2);
    REQUIRE(cloud.points.size() == before.size());
    for (std::size_t i = 0; i < before.size(); ++i) CHECK(length(cloud.points[i] - before[i]) == 0);
    CHECK(dropOutliers(cloud).points == 0);
}

TEST_CASE("dropOutliers: small groups away from the others go, larger ones and near ones stay") {
    PointCloud cloud;
    for (const Vec3f& p : test::sphereMesh(40, 5).points) cloud.points.push_back(p);
    const std::size_t ofBall = cloud.points.size();
    const float spacing = pointSpacing(cloud)[0];
    const auto addPatch = [&](int side, const Vec3f& corner) {
        for (int x = 0; x < side; ++x)
            for (int y = 0; y < side; ++y)
                cloud.points.push_back(corner + Vec3f{float(x), float(y), 0} * spacing);
    };
    const float top = 40 + 4 * spacing;
    addPatch(5, {300, 0, 0});
    addPatch(4, {0, 400, 0});
    addPatch(4, {0, 0, top});    // no gap
    addPatch(11, {0, 0, -300});  // too large
    const Outliers outliers = dropOutliers(cloud);
    REQUIRE(ofBall > 2500);
    CHECK(outliers.points == 25 + 16);
    CHECK(outliers.grouped == 25 + 16);
    CHECK(outliers.groups == 2);
    CHECK(cloud.points.size() == ofBall + 16 + 121);
}

TEST_CASE("estimateNormals: of a ball they look outward", "[geometry][property]") {
    PointCloud cloud = ball(10);
    estimateNormals(cloud);
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
        REQUIRE(dot(cloud.normals[i], normalized(cloud.points[i])) > 0.98f);
    RunContext one;
    one.threads = 1;
    PointCloud again = ball(10);
    estimateNormals(again, one);
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
        REQUIRE(length(again.normals[i] - cloud.normals[i]) == 0);
}

TEST_CASE("estimateNormals: fewer points than a plane wants, and all on a line", "[geometry][degenerate]") {
    PointCloud few;
    few.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    estimateNormals(few);
    for (const Vec3f& n : few.normals) CHECK(std::abs(n.z) == Approx(1));
    PointCloud line;
    for (int i = 0; i < 30; ++i) line.points.push_back({float(i), 0, 0});
    estimateNormals(line);
    for (const Vec3f& n : line.normals) CHECK(length(n) == Approx(1));
}

TEST_CASE("dropOutliers: points whose squared distance exceeds floats", "[geometry][regression]") {
    const std::vector<std::vector<Vec3f>> cases{{{1e30f, 0, 0}},
                                                {{1e20f, 1e20f, 1e20f}},
                                                {{3e38f, 3e38f, 3e38f}, {-3e38f, -3e38f, -3e38f}},
                                                {{1e30f, 0, 0}, {1.0001e30f, 0, 0}, {1e30f, 1e26f, 0}},
                                                {{1e30f, 0, 0}, {0, -1e38f, 0}, {0, 0, 1e20f}},
                                                {{0, 0, 1e12f}, {0, 0, 1e10f}}};
    for (const std::vector<Vec3f>& far : cases) {
        PointCloud cloud = ball(10);
        const std::vector<Vec3f> before = cloud.points;
        cloud.points.insert(cloud.points.begin() + 3, far.begin(), far.end());
        CAPTURE(far.size(), far[0].x);
        CHECK(dropOutliers(cloud).points == far.size());
        REQUIRE(cloud.points.size() == before.size());
        for (std::size_t i = 0; i < before.size(); ++i) REQUIRE(length(cloud.points[i] - before[i]) == 0);
    }
}

TEST_CASE("dropOutliers, estimateNormals: clouds of any size", "[geometry][property]") {
    PointCloud plain = ball(8);
    estimateNormals(plain);
    for (const int power : {-110, -60, 60, 120}) {
        CAPTURE(power);
        PointCloud cloud = ball(8);
        for (Vec3f& p : cloud.points) p = p * std::ldexp(1.f, power);
        estimateNormals(cloud);
        for (std::size_t i = 0; i < cloud.points.size(); ++i)
            REQUIRE(length(cloud.normals[i] - plain.normals[i]) < 1e-3f);
        cloud.points.push_back({std::ldexp(100.f, power), 0, 0});
        cloud.normals.emplace_back();
        CHECK(dropOutliers(cloud).points == 1);
    }
}
