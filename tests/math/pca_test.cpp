#include "libvdbsynth/math/pca.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"

#include <cmath>

using namespace vdbsynth;

TEST_CASE("principalAxes: points along a line have one axis, by hand", "[math]") {
    // (1,2,2)/3 times -3, 0, 3 around (1,1,1)
    const std::vector<float> points{0, -1, -1, 1, 1, 1, 2, 3, 3};
    const PrincipalAxes axes = principalAxes(points, 3, 3, 0.999);
    REQUIRE(axes.count == 1);
    CHECK(axes.mean == std::vector<float>{1, 1, 1});
    CHECK(axes.axes[0] == Approx(1.0 / 3));
    CHECK(axes.axes[1] == Approx(2.0 / 3));
    CHECK(axes.explained == Approx(1));
    float along = 0;
    axes.project(points.data() + 6, &along);
    CHECK(along == Approx(3));
}

TEST_CASE("principalAxes: axes are orthonormal, by falling variance, as many as asked for",
          "[math][property]") {
    constexpr std::size_t kLength = 12;
    std::vector<float> rows;
    for (std::uint64_t r = 0; r < 400; ++r) {
        Random random(5, r);
        for (std::size_t k = 0; k < kLength; ++k)
            rows.push_back(float(random.uniform(-1, 1) * double(k + 1)));
    }
    const PrincipalAxes all = principalAxes(rows, kLength, 100, 2), some = principalAxes(rows, kLength, 5, 2);
    REQUIRE(all.count == kLength);
    REQUIRE(some.count == 5);
    CHECK(all.explained == Approx(1));
    CHECK(some.explained < 1);
    for (std::size_t i = 0; i < kLength; ++i)
        for (std::size_t j = 0; j < kLength; ++j) {
            double product = 0;
            for (std::size_t k = 0; k < kLength; ++k)
                product += double(all.axes[i * kLength + k]) * double(all.axes[j * kLength + k]);
            CHECK(product == Approx(i == j ? 1 : 0).margin(1e-5));
        }
    // All axes together keep distances.
    std::vector<float> a(kLength), b(kLength);
    all.project(rows.data(), a.data());
    all.project(rows.data() + kLength, b.data());
    double before = 0, after = 0;
    for (std::size_t k = 0; k < kLength; ++k) {
        before += std::pow(double(rows[k] - rows[kLength + k]), 2);
        after += std::pow(double(a[k] - b[k]), 2);
    }
    CHECK(after == Approx(before).epsilon(1e-4));
}

TEST_CASE("principalAxes: rows that are all alike have an axis and no variance", "[math]") {
    const PrincipalAxes axes = principalAxes(std::vector<float>(30, 2.f), 3, 2, 0.9);
    CHECK(axes.count == 2);
    CHECK(axes.mean == std::vector<float>{2, 2, 2});
}

TEST_CASE("pointAxes: the axes of a box's corners, by hand") {
    PointSums sums;
    for (int i = 0; i < 8; ++i) sums.add({i & 1 ? 7.0 : 1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 4.0 : 0.0});
    const PointAxes axes = pointAxes(sums);
    CHECK(axes.mean.x == Approx(4));
    CHECK(axes.mean.z == Approx(2));
    CHECK(axes.variance[0] == Approx(1));
    CHECK(axes.variance[1] == Approx(4));
    CHECK(axes.variance[2] == Approx(9));
    CHECK(axes.axis[0].y == Approx(1));
    CHECK(axes.axis[1].z == Approx(1));
    CHECK(axes.axis[2].x == Approx(1));
    CHECK(axes.variation() == Approx(1.0 / 14));
    CHECK(pointAxes(sums, false).variance[2] > 9);  // about the origin
    CHECK(pointAxes({}).variation() == 0);
}
