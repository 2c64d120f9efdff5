#include "libvdbsynth/points/even_sampling.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

PointSetSurface surfaceOf(const test::PointShape& shape) {
    return PointSetSurface(shape.point, shape.normal);
}

// Distances to the nearest other point: their mean, standard deviation over it, and the least.
struct Spread {
    double mean = 0, variation = 0, least = 1e300;
};
Spread spreadOf(const std::vector<Vec3f>& points) {
    const PointNeighbours tree(points);
    Spread spread;
    double squares = 0;
    for (const Vec3f& p : points) {
        std::uint32_t numbers[2];
        float squared[2];
        tree.nearest(p, 2, numbers, squared);
        const double far = std::sqrt(double(squared[1]));
        spread.mean += far / double(points.size());
        squares += far * far / double(points.size());
        spread.least = std::min(spread.least, far);
    }
    spread.variation = std::sqrt(std::max(squares - spread.mean * spread.mean, 0.0)) / spread.mean;
    return spread;
}

test::PointShape randomSphere(std::size_t count, double radius) {
    test::PointShape shape;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(11, i);
        const Vec3d n = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
        shape.point.push_back(cast<float>(n * radius));
        shape.normal.push_back(cast<float>(n));
    }
    return shape;
}

}  // namespace

TEST_CASE("evenSampling: a point too near goes, one that is missing comes back, by hand") {
    test::PointShape plane = test::latticePlane(12);
    const PointSetSurface surface = surfaceOf(plane);
    const std::size_t gone = 5 * 12 + 6;
    plane.point.erase(plane.point.begin() + gone);
    plane.normal.erase(plane.normal.begin() + gone);
    plane.point.push_back({3.2f, 3.1f, 0});
    plane.normal.push_back({0, 0, 1});
    EvenSamplingOptions options;
    options.spacing = 1;
    options.rounds = 0;
    const EvenSampling even = evenSampling(surface, plane.point, plane.normal, {}, options);
    CHECK(even.dropped == 1);
    CHECK(even.added == 1);
    REQUIRE(even.points.size() == 144);
    CHECK(length(even.points.back() - Vec3f{6, 5, 0}) < 1e-4f);
    CHECK(length(even.normals.back() - Vec3f{0, 0, 1}) < 1e-4f);
    const Vec3f beside = plane.point[even.source.back()] - Vec3f{6, 5, 0};
    CHECK(dot(beside, beside) <= 2.0001f);
}

TEST_CASE("evenSampling: two points at one place count as one, one a little above the other too") {
    test::PointShape plane = test::latticePlane(12);
    plane.point.push_back({5.001f, 5, 0.02f});
    plane.normal.push_back({0, 0, 1});
    plane.point.push_back({7, 7, -0.03f});
    plane.normal.push_back({0, 0, 1});
    const PointSetSurface surface(plane.point, plane.normal);
    EvenSamplingOptions options;
    options.spacing = 1;
    const EvenSampling even = evenSampling(surface, plane.point, plane.normal, {}, options);
    CHECK(even.dropped == 2);
    CHECK(even.points.size() == 144);
}

TEST_CASE("evenSampling: points at random on a sphere become even and stay on it") {
    const test::PointShape sphere = randomSphere(5000, 20);
    EvenSamplingOptions options;
    options.spacing = 1;
    const EvenSampling even = evenSampling(surfaceOf(sphere), sphere.point, sphere.normal, {}, options);
    const Spread before = spreadOf(sphere.point), after = spreadOf(even.points);
    CHECK(before.variation > 0.5);
    CHECK(after.variation < 0.1);
    CHECK(after.least > 0.6);
    CHECK(after.mean == Approx(0.9).margin(0.15));
    double largest = 0;
    for (const Vec3f& p : even.points) largest = std::max(largest, std::abs(double(length(p)) - 20));
    CHECK(largest < 0.01);
    CHECK(double(even.points.size()) == Approx(4 * kPi * 400).epsilon(0.15));
}

TEST_CASE("evenSampling: nothing is pushed over the border of an open surface") {
    const test::PointShape plane = test::randomPlane(2000, 40);
    EvenSamplingOptions options;
    options.spacing = 0.9;
    options.rounds = 30;
    const EvenSampling even = evenSampling(surfaceOf(plane), plane.point, plane.normal, {}, options);
    float low = 0, high = 40;
    for (const Vec3f& p : even.points) {
        low = std::min({low, p.x, p.y});
        high = std::max({high, p.x, p.y});
    }
    CHECK(low > -0.3f);
    CHECK(high < 40.3f);
    CHECK(spreadOf(even.points).variation < 0.5 * spreadOf(plane.point).variation);
}

TEST_CASE("evenSampling: wide holes and borders stay, narrow holes are filled") {
    const test::PointShape whole = test::latticePlane(40);
    const auto fill = [&](float radius) {
        test::PointShape plane;
        for (const Vec3f& p : whole.point)
            if (length(p - Vec3f{20, 20, 0}) > radius) {
                plane.point.push_back(p);
                plane.normal.push_back({0, 0, 1});
            }
        EvenSamplingOptions options;
        options.spacing = 1;
        return evenSampling(surfaceOf(plane), plane.point, plane.normal, {}, options).added;
    };
    CHECK(fill(-1) == 0);
    CHECK(fill(1.1f) >= 3);  // five are missing
    CHECK(fill(10) == 0);
}

TEST_CASE("evenSampling: fixed points keep their bits, and opposite sheets do not see each other") {
    const test::PointShape above = test::randomPlane(800, 28, 5);
    test::PointShape under = test::randomPlane(800, 28, 6);
    for (Vec3f& p : under.point) p.z = -0.2f;
    for (Vec3f& n : under.normal) n.z = -1;
    const test::PointShape both = test::joined(above, under);
    EvenSamplingOptions options;
    options.spacing = 1;
    std::vector<char> fixed(both.point.size(), 0);
    for (std::size_t i = 0; i < fixed.size(); i += 3) fixed[i] = 1;
    const EvenSampling even = evenSampling(surfaceOf(both), both.point, both.normal, fixed, options);
    std::size_t moved = 0, crossed = 0, found = 0;
    for (std::size_t k = 0; k < even.points.size() - even.added; ++k) {
        const std::uint32_t i = even.source[k];
        found += fixed[i];
        moved += fixed[i] && length(even.points[k] - both.point[i]) > 0;
        crossed += std::abs(even.points[k].z - both.point[i].z) > 0.01f;
    }
    CHECK(found == (fixed.size() + 2) / 3);
    CHECK(moved == 0);
    CHECK(crossed == 0);
    // As many as the sheet has by itself.
    const EvenSampling alone = evenSampling(surfaceOf(above), above.point, above.normal,
                                            std::vector<char>(fixed.begin(), fixed.begin() + 800), options);
    std::size_t ofAbove = 0;
    for (std::uint32_t i : even.source) ofAbove += i < 800;
    CHECK(double(ofAbove) == Approx(double(alone.points.size())).epsilon(0.03));
}

TEST_CASE("evenSampling: of any size it is the same") {
    const test::PointShape sphere = randomSphere(600, 6);
    const EvenSampling plain = evenSampling(surfaceOf(sphere), sphere.point, sphere.normal);
    for (const int power : {-100, 100}) {
        test::PointShape scaled = sphere;
        for (Vec3f& p : scaled.point) p = p * std::ldexp(1.f, power);
        const EvenSampling even = evenSampling(surfaceOf(scaled), scaled.point, scaled.normal);
        REQUIRE(even.source == plain.source);
        float farthest = 0;
        for (std::size_t i = 0; i < even.points.size(); ++i)
            farthest = std::max(farthest, length(even.points[i] * std::ldexp(1.f, -power) - plain.points[i]));
        CHECK(farthest == 0);
    }
}

TEST_CASE("evenSampling: without points or a surface nothing happens, and what is refused") {
    const test::PointShape plane = test::latticePlane(5);
    const PointSetSurface surface = surfaceOf(plane), none({{0, 0, 0}}, {{0, 0, 1}});
    CHECK(evenSampling(surface, {}, {}).points.empty());
    CHECK(evenSampling(none, plane.point, plane.normal).points.size() == 25);
    const auto codeOf = [&](const std::vector<Vec3f>& normals, const std::vector<char>& fixed) {
        return test::thrownBy([&] { evenSampling(surface, plane.point, normals, fixed); }).code;
    };
    CHECK(codeOf({}, {}) == int(ErrorCode::ShapeMismatch));
    CHECK(codeOf(plane.normal, {1, 0}) == int(ErrorCode::ShapeMismatch));
    const auto refused = [&](auto change, const char* start) {
        EvenSamplingOptions options;
        change(options);
        return test::thrownBy([&] {
                   evenSampling(surface, plane.point, plane.normal, {}, options);
               }).message.find(start) == 0;
    };
    CHECK(refused([](EvenSamplingOptions& o) { o.spacing = -1; }, "`spacing` -1: must be"));
    CHECK(refused([](EvenSamplingOptions& o) { o.rounds = 101; }, "`rounds` 101: must be"));
    CHECK(refused([](EvenSamplingOptions& o) { o.tooNear = 0.9; }, "`tooNear` 0.9: must be"));
    CHECK(refused([](EvenSamplingOptions& o) { o.tooWide = 0.5; }, "`tooWide` 0.5: must be"));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              evenSampling(surface, plane.point, plane.normal, {}, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("evenSampling: same bits for any number of threads", "[points][tsan]") {
    const test::PointShape sphere = randomSphere(1500, 10);
    const PointSetSurface surface = surfaceOf(sphere);
    const EvenSampling one = evenSampling(surface, sphere.point, sphere.normal, {}, {}, test::onThreads(1)),
                       eight = evenSampling(surface, sphere.point, sphere.normal, {}, {}, test::onThreads(8));
    CHECK(one.source == eight.source);
    bool same = one.points.size() == eight.points.size();
    for (std::size_t i = 0; same && i < one.points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) same = same && one.points[i][axis] == eight.points[i][axis];
    CHECK(same);
}
