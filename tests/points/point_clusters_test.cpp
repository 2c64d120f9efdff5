#include "libvdbsynth/points/point_clusters.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/pca.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

std::vector<std::vector<std::uint32_t>> membersOf(const PointClusters& clusters) {
    std::vector<std::vector<std::uint32_t>> members(clusters.representative.size());
    for (std::size_t i = 0; i < clusters.label.size(); ++i) {
        REQUIRE(clusters.label[i] < members.size());
        members[clusters.label[i]].push_back(std::uint32_t(i));
    }
    return members;
}

double variationOf(const std::vector<Vec3f>& points, const std::vector<std::uint32_t>& members) {
    PointSums sums;
    for (std::uint32_t i : members) sums.add(cast<double>(points[i]));
    return pointAxes(sums).variation();
}

}  // namespace

TEST_CASE("clusterPoints: six points in a row in two clusters, by hand") {
    const std::vector<Vec3f> row{{0, 0, 0}, {5, 0, 0}, {1, 0, 0}, {6, 0, 0}, {2, 0, 0}, {7, 0, 0}};
    PointClusterOptions options;
    options.most = 3;
    const PointClusters clusters = clusterPoints(row, {}, options);
    CHECK(clusters.label == std::vector<std::uint32_t>{0, 1, 0, 1, 0, 1});
    CHECK(clusters.representative == std::vector<std::uint32_t>{2, 3});
}

TEST_CASE("clusterPoints: no cluster is too large or too curved, and each has a point of its own for it") {
    const test::PointShape sphere = test::spiralSphere(3000, 15);
    PointClusterOptions options;
    options.most = 100;
    options.variation = 0.01;
    const PointClusters clusters = clusterPoints(sphere.point, sphere.normal, options);
    const auto members = membersOf(clusters);
    for (std::size_t c = 0; c < members.size(); ++c) {
        REQUIRE(!members[c].empty());
        REQUIRE(members[c].size() <= 100);
        REQUIRE(variationOf(sphere.point, members[c]) <= 0.01 + 1e-9);
        REQUIRE(std::count(members[c].begin(), members[c].end(), clusters.representative[c]) == 1);
    }
    CHECK(members.size() < 300);
    // Where it is flat, a few large ones do.
    const test::PointShape plane = test::latticePlane(40);
    CHECK(clusterPoints(plane.point, {}, options).representative.size() == 16);
}

TEST_CASE("clusterPoints: the more curved, the more clusters") {
    PointClusterOptions options;
    options.most = 1000000;
    options.variation = 0.01;
    std::size_t last = 0;
    for (const double radius : {40.0, 20.0, 10.0, 5.0}) {
        // Caps of the same size.
        test::PointShape cap;
        const test::PointShape sphere = test::spiralSphere(std::size_t(4 * kPi * radius * radius), radius);
        for (std::size_t i = 0; i < sphere.point.size(); ++i)
            if (sphere.normal[i].z > 1 - 50 / float(2 * radius * radius))
                cap.point.push_back(sphere.point[i]);
        const std::size_t count = clusterPoints(cap.point, {}, options).representative.size();
        CHECK(count >= last);
        last = count;
    }
    CHECK(last > 8);
}

TEST_CASE("clusterPoints: opposite sheets share no cluster if normals are given") {
    test::PointShape sheets = test::latticePlane(20), under = sheets;
    for (Vec3f& p : under.point) p.z = -0.1f;
    for (Vec3f& n : under.normal) n.z = -1;
    sheets = test::joined(sheets, under);
    for (const auto& members : membersOf(clusterPoints(sheets.point, sheets.normal)))
        for (std::uint32_t i : members) REQUIRE(sheets.normal[i].z == sheets.normal[members[0]].z);
}

TEST_CASE("clusterPoints: none, one and coinciding points, and what is refused") {
    CHECK(clusterPoints({}).representative.empty());
    CHECK(clusterPoints({{1, 2, 3}}).representative == std::vector<std::uint32_t>{0});
    PointClusterOptions options;
    options.most = 10;
    const PointClusters clump = clusterPoints(std::vector<Vec3f>(100, {1, 2, 3}), {}, options);
    for (const auto& members : membersOf(clump)) CHECK(members.size() <= 10);
    const std::vector<Vec3f> some(10);
    CHECK(test::thrownBy([&] { clusterPoints(some, std::vector<Vec3f>(9)); }).code ==
          int(ErrorCode::ShapeMismatch));
    options.most = 0;
    CHECK(test::thrownBy([&] { clusterPoints(some, {}, options); }).message.find("`most` 0") == 0);
    options = {};
    options.variation = 0.5;
    CHECK(test::thrownBy([&] { clusterPoints(some, {}, options); }).message.find("`variation` 0.5") == 0);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { clusterPoints(some, {}, {}, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
