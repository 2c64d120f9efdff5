#include "libvdbsynth/points/site_regions.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

using namespace vdbsynth;

namespace {

void add(test::PointShape& shape, const Vec3f& point, const Vec3f& normal) {
    shape.point.push_back(point);
    shape.normal.push_back(normalized(normal));
}

// A cube of the given number of points along an edge; those on edges and corners have their faces' mean
// normal, as vertices of a mesh do.
test::PointShape cube(int side) {
    test::PointShape shape;
    const auto outward = [&](int i) { return float(i == side - 1) - float(i == 0); };
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const Vec3f normal{outward(x), outward(y), outward(z)};
                if (length(normal) > 0) add(shape, {float(x), float(y), float(z)}, normal);
            }
    return shape;
}

// A closed cylinder along z, its points on the rims apart from those of the caps.
test::PointShape cylinder(float radius, int high) {
    test::PointShape shape;
    const int around = int(2 * kPi * double(radius));
    for (int z = 0; z <= high; ++z)
        for (int k = 0; k < around; ++k) {
            const double a = 2 * kPi * (k + 0.5 * (z % 2)) / around;
            const Vec3f out{float(cosine(a)), float(sine(a)), 0};
            add(shape, out * radius + Vec3f{0, 0, float(z)}, out);
        }
    for (int z : {0, high})
        for (float y = -radius; y <= radius; ++y)
            for (float x = -radius; x <= radius; ++x)
                if (x * x + y * y < (radius - 0.5f) * (radius - 0.5f))
                    add(shape, {x, y, float(z)}, {0, 0, z == 0 ? -1.f : 1.f});
    return shape;
}

void append(test::PointShape& shape, const test::PointShape& other, const Vec3f& by) {
    for (std::size_t i = 0; i < other.point.size(); ++i) add(shape, other.point[i] + by, other.normal[i]);
}

SiteRegions divided(const test::PointShape& shape, std::size_t count, const RunContext& ctx = {}) {
    return siteRegions(sitesAcrossCreases(shape.point, shape.normal), count, ctx);
}

std::vector<std::size_t> sizes(const SiteRegions& regions) {
    std::vector<std::size_t> counts(regions.labels, 0);
    for (std::int32_t label : regions.label) ++counts.at(std::size_t(label));
    return counts;
}

// The labels of points that face a direction.
std::set<std::int32_t> facing(const test::PointShape& shape, const SiteRegions& regions, const Vec3f& way) {
    std::set<std::int32_t> labels;
    for (std::size_t i = 0; i < shape.normal.size(); ++i)
        if (dot(shape.normal[i], way) > 0.99f) labels.insert(regions.label[i]);
    return labels;
}

}  // namespace

TEST_CASE("siteRegions: a cube has a region per face") {
    const test::PointShape shape = cube(20);
    const SiteRegions regions = divided(shape, 6);
    CHECK(regions.labels == 6);
    CHECK(regions.found == 6);
    CHECK(regions.halved == 0);
    std::set<std::int32_t> all;
    for (int axis = 0; axis < 3; ++axis)
        for (float sign : {-1.f, 1.f}) {
            Vec3f way;
            way[axis] = sign;
            const std::set<std::int32_t> labels = facing(shape, regions, way);
            CHECK(labels.size() == 1);
            all.insert(labels.begin(), labels.end());
        }
    CHECK(all.size() == 6);
}

TEST_CASE("siteRegions: two balls are two regions, the larger first") {
    test::PointShape shape = test::spiralSphere(1000, 5);
    append(shape, test::spiralSphere(4000, 10), {30, 0, 0});
    const SiteRegions regions = divided(shape, 2);
    for (std::size_t i = 0; i < shape.point.size(); ++i) REQUIRE(regions.label[i] == (i < 1000));
    CHECK(regions.found == 2);
}

TEST_CASE("siteRegions: a cylinder's side and caps") {
    const test::PointShape shape = cylinder(10, 60);
    const SiteRegions regions = divided(shape, 3);
    CHECK(regions.halved == 0);
    for (std::size_t i = 0; i < shape.point.size(); ++i)
        if (std::abs(shape.normal[i].z) < 0.5f) REQUIRE(regions.label[i] == 0);
    CHECK(facing(shape, regions, {0, 0, 1}).size() == 1);
    CHECK(facing(shape, regions, {0, 0, 1}) != facing(shape, regions, {0, 0, -1}));
    CHECK(facing(shape, regions, {0, 0, 1}) != std::set<std::int32_t>{0});
}

TEST_CASE("siteRegions: a ball on a plate parts where they meet") {
    // Concave all around.
    test::PointShape shape = test::latticePlane(60);
    test::PointShape dome = test::spiralSphere(2400, 14);
    for (std::size_t i = 0; i < dome.point.size(); ++i)
        if (dome.point[i].z > 0) add(shape, dome.point[i] + Vec3f{30, 30, 0}, dome.normal[i]);
    test::PointShape open;
    for (std::size_t i = 0; i < shape.point.size(); ++i) {
        const Vec3f from = shape.point[i] - Vec3f{30, 30, 0};
        if (length(from) > 13.5f) add(open, shape.point[i], shape.normal[i]);
    }
    const SiteRegions regions = divided(open, 2);
    CHECK(regions.halved == 0);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < open.point.size(); ++i)
        wrong += regions.label[i] != (open.point[i].z > 0.01f);
    CHECK(wrong < open.point.size() / 100);
}

TEST_CASE("siteRegions: what nothing divides is halved, and counted") {
    for (const test::PointShape& shape : {test::latticePlane(30), test::spiralSphere(3000, 10)}) {
        const SiteRegions regions = divided(shape, 2);
        CHECK(regions.found == 1);
        CHECK(regions.halved == 1);
        REQUIRE(regions.labels == 2);
        CHECK(double(sizes(regions)[1]) > 0.35 * double(shape.point.size()));
    }
    CHECK(divided(test::latticePlane(30), 5).labels == 5);
}

TEST_CASE("siteRegions: more pieces than regions are grouped by size, crumbs join the nearest") {
    test::PointShape shape;
    for (int k = 0; k < 5; ++k)
        append(shape, k < 2 ? test::spiralSphere(2000, 10) : test::spiralSphere(500, 5),
               {float(40 * k), 0, 0});
    const SiteRegions regions = divided(shape, 2);
    CHECK(regions.found == 5);
    CHECK(sizes(regions) == std::vector<std::size_t>{4000, 1500});
    test::PointShape crumbs = test::spiralSphere(4000, 10);
    append(crumbs, test::spiralSphere(4000, 10), {100, 0, 0});
    append(crumbs, test::spiralSphere(12, 0.5), {115, 0, 0});
    const SiteRegions joined = divided(crumbs, 2);
    CHECK(joined.islands == 12);
    CHECK(joined.label.back() == joined.label[5000]);
    CHECK(joined.label[0] != joined.label[5000]);
}

TEST_CASE("siteRegions: few sites, wrong counts", "[error]") {
    test::PointShape few;
    add(few, {0, 0, 0}, {0, 0, 1});
    CHECK(divided(few, 3).labels == 1);
    add(few, {1, 0, 0}, {0, 0, 1});
    CHECK(divided(few, 3).labels == 2);
    CHECK(test::thrownBy([&] { divided(few, 0); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] { divided({}, 2); }).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("siteRegions: same labels for any number of threads, and it stops", "[determinism][cancel]") {
    const test::PointShape shape = cylinder(20, 40);
    CHECK(divided(shape, 4, test::onThreads(1)).label == divided(shape, 4, test::onThreads(3)).label);
    const SurfaceSites sites = sitesAcrossCreases(shape.point, shape.normal);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { siteRegions(sites, 4, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
