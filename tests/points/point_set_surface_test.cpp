#include "libvdbsynth/points/point_set_surface.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/point_file.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace vdbsynth;

namespace {

PointSetSurface surfaceOf(const test::PointShape& shape, PointSetKind kind = PointSetKind::Apss) {
    PointSetSurfaceOptions options;
    options.kind = kind;
    return PointSetSurface(shape.point, shape.normal, options);
}

Vec3d randomDirection(std::uint64_t i) {
    Random random(7, i);
    return normalized(Vec3d{random.normal(), random.normal(), random.normal()});
}

// Mean and largest deviation from a sphere of the feet of places around it, in units of length.
struct Deviation {
    double mean = 0, largest = 0;
};
Deviation fromSphere(const PointSetSurface& surface, double radius, double around) {
    constexpr int kCount = 4000;
    Deviation deviation;
    for (int i = 0; i < kCount; ++i) {
        const Vec3d place = randomDirection(std::uint64_t(i)) *
                            (radius + Random(8, std::uint64_t(i)).uniform(-around, around));
        const auto foot = surface.project(place);
        REQUIRE(foot);
        const double off = length(foot->point) - radius;
        deviation.mean += off / kCount;
        deviation.largest = std::max(deviation.largest, std::abs(off));
        REQUIRE(length(foot->normal) == Approx(1));
        REQUIRE(dot(foot->normal, foot->point) > 0.999 * length(foot->point));
    }
    return deviation;
}

// Distance of a place from the surface of the solid x < 0, z < 0.
double fromWedge(const Vec3d& p) {
    if (p.x <= 0 && p.z <= 0) return std::min(-p.x, -p.z);
    return p.x <= 0 ? p.z : p.z <= 0 ? p.x : std::sqrt(p.x * p.x + p.z * p.z);
}

}  // namespace

TEST_CASE("PointSetSurface: on a plane every kind projects straight down") {
    const test::PointShape plane = test::latticePlane(30);
    for (const auto kind : {PointSetKind::Apss, PointSetKind::Rimls, PointSetKind::AdamsonAlexa}) {
        const PointSetSurface surface = surfaceOf(plane, kind);
        CHECK(surface.spacing() == Approx(1.05).margin(0.01));
        const auto foot = surface.project({14.3, 15.2, 2.5});
        REQUIRE(foot);
        CHECK(length(foot->point - Vec3d{14.3, 15.2, 0}) < 1e-5);
        CHECK(length(foot->normal - Vec3d{0, 0, 1}) < 1e-5);
        CHECK(length(surface.project({14.3, 15.2, -2.5})->point - Vec3d{14.3, 15.2, 0}) < 1e-5);
    }
}

TEST_CASE("PointSetSurface: a sphere of 40 spacings is right to 0.005, by the paper's surface to 0.1") {
    const test::PointShape sphere = test::spiralSphere(20106, 40);
    const Deviation apss = fromSphere(surfaceOf(sphere), 40, 3);
    CHECK(std::abs(apss.mean) < 1e-4);  // measured: 2e-6
    CHECK(apss.largest < 1e-3);
    // h^2 / r too small, and with a signed mean of the planes as much too large.
    CHECK(fromSphere(surfaceOf(sphere, PointSetKind::AdamsonAlexa), 40, 3).mean ==
          Approx(-0.1).margin(0.005));
    CHECK(fromSphere(surfaceOf(sphere, PointSetKind::Rimls), 40, 3).mean == Approx(0.1).margin(0.005));
}

TEST_CASE("PointSetSurface: a sphere is right whatever its curvature, size and density") {
    for (const double radius : {2.0, 3.0, 6.0}) {
        const auto count = std::size_t(4 * kPi * radius * radius);
        CHECK(fromSphere(surfaceOf(test::spiralSphere(count, radius)), radius, 0.4 * radius).largest < 1e-3);
    }
    for (const double size : {1e-20, 1e-6, 1e9}) {
        test::PointShape sphere = test::spiralSphere(2000, 1);
        for (Vec3f& p : sphere.point) p = cast<float>(cast<double>(p) * size);
        const PointSetSurface surface = surfaceOf(sphere);
        const auto foot = surface.project(Vec3d{0.6, 0.5, 0.7} * size);
        REQUIRE(foot);
        CHECK(length(foot->point) == Approx(size).epsilon(1e-4));
    }
    // From one pole to the other the density falls to a 25th.
    test::PointShape uneven;
    const test::PointShape dense = test::spiralSphere(60000, 40);
    for (std::size_t i = 0; i < dense.point.size(); ++i) {
        const double share = 0.52 + 0.48 * double(dense.normal[i].z);
        if (Random(3, i).uniform() > share * share) continue;
        uneven.point.push_back(dense.point[i]);
        uneven.normal.push_back(dense.normal[i]);
    }
    CHECK(fromSphere(surfaceOf(uneven), 40, 1).largest < 2e-3);
}

TEST_CASE("PointSetSurface: 99 of 100 feet on a torus are right to 0.02") {
    const PointSetSurface surface = surfaceOf(test::ringTorus(20, 6));
    std::vector<double> off;
    for (std::uint64_t i = 0; i < 5000; ++i) {
        Random random(3, i);
        const double a = random.uniform(0, 2 * kPi), b = random.uniform(0, 2 * kPi);
        const Vec3d n{cosine(a) * cosine(b), sine(a) * cosine(b), sine(b)};
        const auto foot =
            surface.project(Vec3d{20 * cosine(a), 20 * sine(a), 0} + n * (6 + random.uniform(-1, 1)));
        REQUIRE(foot);
        const double across = std::sqrt(foot->point.x * foot->point.x + foot->point.y * foot->point.y) - 20;
        off.push_back(std::abs(std::sqrt(across * across + foot->point.z * foot->point.z) - 6));
    }
    std::sort(off.begin(), off.end());
    CHECK(off[4950] < 0.02);  // measured: 0.013
}

TEST_CASE("PointSetSurface: a right angle keeps its edge to 0.05 kernels unless told otherwise") {
    const test::PointShape shape = test::latticeWedge(30);
    const auto worst = [&](PointSetKind kind, bool sharp) {
        PointSetSurfaceOptions options;
        options.kind = kind;
        options.sharp = sharp;
        const PointSetSurface surface(shape.point, shape.normal, options);
        double largest = 0;
        for (std::uint64_t i = 0; i < 20000; ++i) {
            Random random(3, i);
            const Vec3d place{random.uniform(-8, 2), random.uniform(20, 40), random.uniform(-8, 2)};
            if (fromWedge(place) > 2) continue;
            const auto foot = surface.project(place);
            REQUIRE(foot);
            largest = std::max(largest, fromWedge(foot->point));
        }
        return largest / (2 * surface.spacing());
    };
    CHECK(worst(PointSetKind::Apss, true) < 0.05);  // measured: 0.039
    CHECK(worst(PointSetKind::Rimls, true) < 0.05);
    CHECK(worst(PointSetKind::Apss, false) == Approx(0.24).margin(0.03));
    CHECK(worst(PointSetKind::AdamsonAlexa, true) == Approx(0.52).margin(0.05));
}

TEST_CASE("PointSetSurface: of opposite sheets two spacings apart the nearer one is met") {
    test::PointShape sheets = test::latticePlane(60), under = sheets;
    for (Vec3f& p : under.point) p.z = -2;
    for (Vec3f& n : under.normal) n.z = -1;
    const PointSetSurface surface = surfaceOf(test::joined(sheets, under));
    std::size_t wrong = 0, wrongByFacing = 0;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(5, i);
        const Vec3d place{random.uniform(5, 54), random.uniform(5, 54), random.uniform(-3, 1)};
        const auto foot = surface.project(place);
        REQUIRE(foot);
        const double sheet = place.z > -1 ? 0 : -2;
        wrong += std::abs(foot->point.z - sheet) > 0.01 && std::abs(place.z + 1) > 0.01;
        // Whatever is nearer: the sheet that faces up.
        const auto up = surface.project(place, {0, 0.3, 1});
        wrongByFacing += !up || std::abs(up->point.z) > 0.01;
    }
    CHECK(wrong == 0);
    CHECK(wrongByFacing == 0);
}

TEST_CASE("PointSetSurface: where no point is near there is nothing") {
    const PointSetSurface surface = surfaceOf(test::latticePlane(20));
    CHECK_FALSE(surface.project({10, 10, 8}));
    CHECK_FALSE(surface.project({1e30, 0, 0}));
    CHECK_FALSE(surface.project({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
    CHECK_FALSE(surface.project({10, 10, 0.1}, {0, 0, -1}));
    CHECK(surface.project({10, 10, 5}));
}

TEST_CASE("PointSetSurface: a point far from the others changes nothing near them") {
    test::PointShape plane = test::latticePlane(30);
    const auto before = surfaceOf(plane).project({12.3, 14.2, 1});
    plane.point.push_back({12, 14, 1e6f});
    plane.normal.push_back({1, 0, 0});
    const auto after = surfaceOf(plane).project({12.3, 14.2, 1});
    REQUIRE(after);
    CHECK(length(after->point - before->point) < 1e-5);
    // An outlier twelve spacings off has a kernel like theirs.
    plane.point.back() = {12, 14, 12};
    CHECK(std::abs(surfaceOf(plane).project({12.3, 14.2, 1})->point.z) < 1e-3);
}

TEST_CASE("PointSetSurface: one point, or many at one place, are no surface, and repeats count once") {
    const PointSetSurface one({{1, 2, 3}}, {{0, 0, 1}});
    CHECK(one.spacing() == 0);
    CHECK_FALSE(one.project({1, 2, 3}));
    CHECK_FALSE(one.intersect({1, 2, 4}, {0, 0, -1}, 10));
    const std::size_t many = 5000;
    const PointSetSurface clump(std::vector<Vec3f>(many, {1, 2, 3}), std::vector<Vec3f>(many, {0, 0, 1}));
    CHECK(clump.spacing() == 0);

    const test::PointShape sphere = test::spiralSphere(3000, 15);
    test::PointShape repeated = sphere;
    for (int i = 0; i < 2000; ++i) {
        repeated.point.push_back(sphere.point[7]);
        repeated.normal.push_back(sphere.normal[7] * 3.f);  // of any length
    }
    const PointSetSurface plain = surfaceOf(sphere), twice = surfaceOf(repeated);
    const Vec3d place = cast<double>(sphere.point[7]) * 1.05;
    CHECK(twice.spacing() == plain.spacing());
    CHECK(length(twice.project(place)->point - plain.project(place)->point) < 1e-6);
}

TEST_CASE("PointSetSurface: wrong input is refused") {
    const std::vector<Vec3f> points(3, {1, 2, 3}), up(3, {0, 0, 1});
    const auto codeOf = [](std::vector<Vec3f> p, std::vector<Vec3f> n, PointSetSurfaceOptions options = {}) {
        return test::thrownBy([&] { PointSetSurface(std::move(p), std::move(n), options); }).code;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(codeOf({}, {}) == int(ErrorCode::EmptyInput));
    CHECK(codeOf(points, {}) == int(ErrorCode::ShapeMismatch));
    CHECK(codeOf({{0, 0, 0}, {nan, 0, 0}, {1, 0, 0}}, up) == int(ErrorCode::BadData));
    CHECK(codeOf(points, {{0, 0, 1}, {0, 0, 0}, {0, 0, 1}}) == int(ErrorCode::BadData));
    CHECK(codeOf(points, {{0, 0, 1}, {0, nan, 0}, {0, 0, 1}}) == int(ErrorCode::BadData));
    PointSetSurfaceOptions options;
    options.kernel = 0.5;
    const auto thrown = test::thrownBy([&] { PointSetSurface(points, up, options); });
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    CHECK(thrown.message.find("`kernel` 0.5: must be 1 to 8") != std::string::npos);
    options = {};
    options.normalWidth = 3;
    CHECK(codeOf(points, up, options) == int(ErrorCode::InvalidOption));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              PointSetSurface(points, up, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("PointSetSurface: same bits for any number of threads", "[points][tsan]") {
    const test::PointShape sphere = test::spiralSphere(20000, 40);
    const PointSetSurface one(sphere.point, sphere.normal, {}, test::onThreads(1)),
        eight(sphere.point, sphere.normal, {}, test::onThreads(8));
    std::vector<Vec3d> feet(2000);
    parallelFor(test::onThreads(8), feet.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) feet[i] = eight.project(randomDirection(i) * 41.0)->point;
    });
    bool same = true;
    for (std::size_t i = 0; i < feet.size(); ++i) {
        const Vec3d foot = one.project(randomDirection(i) * 41.0)->point;
        same = same && foot.x == feet[i].x && foot.y == feet[i].y && foot.z == feet[i].z;
    }
    CHECK(same);
}

TEST_CASE("PointSetSurface: a foot on a scan is its own foot", "[points][property]") {
    const std::string path = test::sample("points/kitten.xyz");
    if (path.empty()) return;
    const PointCloud cloud = readPoints(path).cloud;
    PointSetSurfaceOptions options;
    options.sharp = false;  // robust planes are not exactly so
    const PointSetSurface surface(cloud.points, cloud.normals, options);
    std::size_t moved = 0;
    double farthest = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        Random random(4, i);
        const Vec3d aside{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const auto foot = surface.project(cast<double>(cloud.points[i]) + aside * surface.spacing());
        REQUIRE(foot);
        const auto again = surface.project(foot->point);
        REQUIRE(again);
        moved += length(again->point - foot->point) > 1e-3 * surface.spacing();
        const auto near = surface.project(cast<double>(cloud.points[i]));
        farthest = std::max(farthest, length(near->point - cast<double>(cloud.points[i])));
    }
    CHECK(moved < cloud.points.size() / 100);
    CHECK(farthest < 0.8 * surface.spacing());
}
