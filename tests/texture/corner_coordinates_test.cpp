#include "libvdbsynth/texture/corner_coordinates.h"

#include <catch2/catch.hpp>

#include <cstring>

#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

using namespace vdbsynth;

namespace {

// Sites on a plane with u along x, in texels of half a unit.
struct Plane {
    test::PointShape shape;
    TexturedSites sites;
    std::vector<SampleImage> samples{1};
    std::vector<Triangle> triangles;

    explicit Plane(int side) : shape(test::latticePlane(side)) {
        samples[0] = {16, 8, 1, true, std::vector<float>(128, 0.f)};
        const std::uint32_t n = std::uint32_t(side);
        for (const Vec3f& p : shape.point) {
            sites.sample.push_back(0);
            sites.coordinate.push_back({2 * p.x, 2 * p.y});
            sites.tangent.push_back({1, 0, 0});
            sites.values.push_back(0);
            sites.blended.push_back(0);
        }
        for (std::uint32_t y = 0; y + 1 < n; ++y)
            for (std::uint32_t x = 0; x + 1 < n; ++x) {
                const std::uint32_t a = y * n + x;
                triangles.insert(triangles.end(), {{a, a + 1, a + n}, {a + 1, a + n + 1, a + n}});
            }
    }
    TexturedSurface surface() const { return {shape.point, shape.normal, sites, samples, 0.5}; }
};

}  // namespace

TEST_CASE("extendedCoordinate: the paper's position formula on a slope", "[texture][fast]") {
    Plane plane(2);
    // From the site at the origin to (3, 0, 4): length 5 along u, ten texels.
    const Vec2f at = extendedCoordinate(plane.surface(), 0, {3, 0, 4});
    CHECK(at.x == Approx(10));
    CHECK(at.y == Approx(0));
    CHECK(extendedCoordinate(plane.surface(), 3, {1, 3, 0}).y == Approx(6));
}

TEST_CASE("cornerCoordinates: one chart gives the sites' own coordinates", "[texture][fast]") {
    const Plane plane(5);
    const CornerCoordinates corners = cornerCoordinates(plane.surface(), plane.triangles);
    CHECK(corners.torn == 0);
    for (std::size_t t = 0; t < plane.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2f own = plane.sites.coordinate[plane.triangles[t][k]];
            CHECK(length(corners.coordinate[3 * t + k] - own) == 0);
        }
}

TEST_CASE("cornerCoordinates: copies of a tileable sample are joined", "[texture]") {
    Plane plane(3);
    plane.sites.coordinate[1] = plane.sites.coordinate[1] + Vec2f{32, -8};
    const CornerCoordinates corners = cornerCoordinates(plane.surface(), plane.triangles);
    CHECK(corners.torn == 0);
    CHECK(length(corners.coordinate[1] - corners.coordinate[0]) == Approx(2));
    plane.samples[0].tileable = false;
    CHECK(cornerCoordinates(plane.surface(), plane.triangles).torn > 0);
}

TEST_CASE("cornerCoordinates: a triangle across charts takes that of most corners", "[texture]") {
    Plane plane(2);
    plane.samples[0].tileable = false;
    plane.sites.coordinate[0] = {7, 7};  // the odd one out of the first triangle
    const CornerCoordinates corners = cornerCoordinates(plane.surface(), plane.triangles);
    CHECK(corners.torn == 1);
    CHECK(length(corners.coordinate[1] - plane.sites.coordinate[1]) == 0);
    CHECK(length(corners.coordinate[2] - plane.sites.coordinate[2]) == 0);
    CHECK(length(corners.coordinate[0]) == Approx(0).margin(1e-5));  // what their chart has there
}

TEST_CASE("cornerCoordinates: another sample is another chart, none leaves a triangle bare", "[texture]") {
    Plane plane(2);
    plane.samples.push_back(plane.samples[0]);
    plane.sites.sample = {1, 0, 0, 0};
    CornerCoordinates corners = cornerCoordinates(plane.surface(), plane.triangles);
    CHECK(corners.sample == std::vector<std::int32_t>{0, 0});
    CHECK(corners.torn == 1);
    plane.sites.sample.assign(4, TexturedSites::kNone);
    corners = cornerCoordinates(plane.surface(), plane.triangles);
    CHECK(corners.sample == std::vector<std::int32_t>{-1, -1});
    CHECK(cornerCoordinates(plane.surface(), {}).coordinate.empty());
}

TEST_CASE("cornerCoordinates: any number of threads gives the same bits, cancelled it throws",
          "[texture][determinism][cancel]") {
    Plane plane(80);
    for (std::size_t i = 0; i < plane.sites.coordinate.size(); i += 7) plane.sites.coordinate[i].x += 5;
    const auto once = [&](int threads) {
        return cornerCoordinates(plane.surface(), plane.triangles, test::onThreads(threads)).coordinate;
    };
    const auto one = once(1), two = once(2);
    CHECK(std::memcmp(one.data(), two.data(), one.size() * sizeof(Vec2f)) == 0);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              cornerCoordinates(plane.surface(), plane.triangles, ctx);
          }).code == int(ErrorCode::Cancelled));
}
