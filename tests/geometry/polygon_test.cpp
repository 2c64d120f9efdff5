#include "libvdbsynth/geometry/polygon.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

using namespace vdbsynth;

namespace {

struct Plane {
    Vec3d origin, along, across;
    Vec3d at(double x, double y) const { return origin + along * x + across * y; }
    Vec3d normal() const { return cross(along, across); }
};

Plane randomPlane(std::uint64_t seed) {
    Random random(seed, 99);
    const auto direction = [&] {
        return normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    };
    Plane plane;
    plane.origin = direction() * random.uniform(0, 100);
    plane.along = direction();
    plane.across = normalized(cross(plane.along, direction()));
    return plane;
}

struct Cut {
    Mesh mesh;
    std::size_t crossing = 0;
};
Cut cutOf(const std::vector<Vec3d>& points, std::vector<std::uint32_t> corners = {}) {
    if (corners.empty()) {
        corners.resize(points.size());
        std::iota(corners.begin(), corners.end(), 0u);
    }
    PolygonList list;
    list.add(corners.data(), corners.size());
    Cut cut;
    cut.crossing = appendPolygons(cut.mesh, list, points);
    return cut;
}

// By the shoelace formula in the plane, before the points go there.
double shoelace(const std::vector<std::pair<double, double>>& ring) {
    double area = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto [x, y] = ring[i];
        const auto [u, v] = ring[(i + 1) % ring.size()];
        area += (x * v - u * y) / 2;
    }
    return area;
}

void checkCut(const std::vector<std::pair<double, double>>& ring, const Plane& plane, double noise = 0) {
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < ring.size(); ++i)
        points.push_back(plane.at(ring[i].first, ring[i].second) +
                         plane.normal() * (noise * Random(3, i).uniform(-1, 1)));
    const Cut cut = cutOf(points);
    CHECK(cut.crossing == 0);
    CHECK(cut.mesh.triangles.size() == ring.size() - 2);
    double area = 0, flipped = 0;
    std::set<std::uint32_t> used;
    for (const Triangle& t : cut.mesh.triangles) {
        const Vec3d normal = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) * 0.5;
        area += length(normal);
        flipped += std::max(0.0, -dot(normal, plane.normal()));
        used.insert(t.begin(), t.end());
    }
    CHECK(area == Approx(shoelace(ring)).epsilon(noise > 0 ? 0.01 : 1e-7));
    CHECK(flipped <= 1e-7 * area);
    CHECK(used.size() == ring.size());
}

std::vector<std::pair<double, double>> star(std::uint64_t seed, int corners) {
    std::vector<std::pair<double, double>> ring;
    for (int i = 0; i < corners; ++i) {
        const double radius = Random(seed, std::uint64_t(i)).uniform(0.2, 3);
        ring.push_back(
            {radius * std::cos(2 * M_PI * i / corners), radius * std::sin(2 * M_PI * i / corners)});
    }
    return ring;
}

}  // namespace

TEST_CASE("appendPolygons: triangles and convex quads as they are, under three corners no face",
          "[geometry]") {
    PolygonList list;
    const std::vector<std::uint32_t> corners{0, 1, 2, 3};
    for (const std::size_t count : {2u, 3u, 4u, 0u}) list.add(corners.data(), count);
    Mesh mesh;
    CHECK(appendPolygons(mesh, list, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) == 0);
    REQUIRE(mesh.triangles.size() == 1);
    REQUIRE(mesh.quads.size() == 1);
    CHECK(mesh.quads[0] == Quad{0, 1, 2, 3});
}

TEST_CASE("appendPolygons: convex polygons are the fan of their first corner", "[geometry][hand]") {
    const Cut cut = cutOf({{0, 0, 1}, {2, 0, 1}, {3, 2, 1}, {1, 3, 1}, {-1, 2, 1}});
    CHECK(cut.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    // The same from the other side.
    const Cut back = cutOf({{-1, 2, 1}, {1, 3, 1}, {3, 2, 1}, {2, 0, 1}, {0, 0, 1}});
    CHECK(back.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
}

TEST_CASE("appendPolygons: a concave quad is split along the diagonal inside", "[geometry][hand]") {
    const std::vector<Vec3d> dart{{0, 0, 5}, {4, 1, 5}, {8, 0, 5}, {4, 8, 5}};
    CHECK(cutOf(dart).mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}});
    CHECK(cutOf(dart, {1, 2, 3, 0}).mesh.triangles == std::vector<Triangle>{{1, 2, 3}, {1, 3, 0}});
    CHECK(cutOf(dart, {3, 2, 1, 0}).mesh.triangles == std::vector<Triangle>{{3, 2, 1}, {3, 1, 0}});
    CHECK(cutOf(dart).mesh.quads.empty());
    // A folded sheet: seen from above, corner 3 lies within the triangle of the others.
    const Cut folded = cutOf({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 1, 1}});
    CHECK(folded.mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}});
}

TEST_CASE("appendPolygons: straight and repeated corners and saddles stay quads", "[geometry][degenerate]") {
    for (const std::vector<Vec3d>& quad :
         std::vector<std::vector<Vec3d>>{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}},
                                         {{0, 0, 0}, {1, 1e-8, 0}, {2, 0, 0}, {1, 1, 0}},
                                         {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}},
                                         {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
                                         {{0, 0, 0}, {1, 0, 0.5}, {1, 1, 0}, {0, 1, 0.5}},
                                         {{0, 0, 0}, {1, 0, 2}, {1, 1, 0}, {0, 1, 2}},
                                         {{0, 0, 0}, {1, 0, 0}, {1, 1, 6}, {0, 1, 2}},
                                         {{3e38, 0, 0}, {3e38, 3e38, 0}, {-3e38, 3e38, 0}, {-3e38, 0, 0}}}) {
        const Cut cut = cutOf(quad);
        CHECK(cut.mesh.quads == std::vector<Quad>{{0, 1, 2, 3}});
        CHECK(cut.crossing == 0);
    }
}

TEST_CASE("appendPolygons: random polygons in random planes keep their area, unflipped",
          "[geometry][property]") {
    for (std::uint64_t seed = 0; seed < 80; ++seed) {
        CAPTURE(seed);
        const Plane plane = randomPlane(seed);
        checkCut(star(seed, 5 + int(seed) * 3), plane);
        std::vector<std::pair<double, double>> comb{{0, 0}, {10, 0}};
        for (int tooth = int(seed % 20) + 1; tooth >= 0; --tooth) {
            const double at = 10.0 * tooth / double(seed % 20 + 2);
            comb.push_back({at + 0.2, Random(seed, std::uint64_t(tooth)).uniform(1, 9)});
            comb.push_back({at, 0.5});
        }
        checkCut(comb, plane);
        checkCut(comb, plane, 1e-4);
        checkCut(comb, plane, 1e-2);
    }
}

TEST_CASE("appendPolygons: a folded polygon gets the triangles of least area", "[geometry][hand]") {
    // A roof of two rectangles that meet at corners 1 and 4 of the ridge.
    const std::vector<Vec3d> roof{{0, 0, 0}, {2, 0, 1}, {4, 0, 0}, {4, 1, 0}, {2, 1, 1}, {0, 1, 0}};
    for (std::uint32_t first = 0; first < 6; ++first) {
        std::vector<std::uint32_t> corners;
        for (std::uint32_t i = 0; i < 6; ++i) corners.push_back((first + i) % 6);
        Cut cut = cutOf(roof, corners);
        CHECK(cut.crossing == 0);
        REQUIRE(cut.mesh.triangles.size() == 4);
        for (const Vec3d& p : roof) cut.mesh.points.push_back(cast<float>(p));
        CHECK(summarize(cut.mesh).area == Approx(2 * std::sqrt(5)));
        CHECK(summarize(cut.mesh).misorientedEdges == 0);
    }
    const Cut repeated = cutOf(roof, {0, 1, 2, 3, 4, 4, 5});
    CHECK(repeated.mesh.triangles.size() == 4);
}

TEST_CASE("appendPolygons: far and large coordinates", "[geometry][property]") {
    Plane plane = randomPlane(5);
    plane.origin = {665187, 5648349, 243};
    std::vector<Vec3d> points;
    for (const auto& [x, y] : star(4, 31)) points.push_back(plane.at(x, y));
    double area = 0;
    const Cut cut = cutOf(points);
    for (const Triangle& t : cut.mesh.triangles)
        area += length(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]])) / 2;
    CHECK(area == Approx(shoelace(star(4, 31))).epsilon(1e-6));
    for (Vec3d& p : points) p = (p - plane.origin) * 1e37;
    CHECK(cutOf(points).mesh.triangles == cut.mesh.triangles);
}

TEST_CASE("appendPolygons: a hole behind a bridge of repeated corners", "[geometry][hand]") {
    const std::vector<Vec3d> points{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0},
                                    {3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}};
    const Cut cut = cutOf(points, {0, 1, 2, 3, 0, 4, 5, 6, 7, 4});
    CHECK(cut.crossing == 0);
    Mesh mesh = cut.mesh;
    for (const Vec3d& p : points) mesh.points.push_back(cast<float>(p));
    const MeshSummary summary = summarize(mesh);
    CHECK(mesh.triangles.size() == 8);
    CHECK(summary.area == Approx(72));
    CHECK(summary.openEdges == 8);  // the square and the hole, not the bridge
}

TEST_CASE("appendPolygons: polygons that cross themselves are counted and keep a face",
          "[geometry][hostile]") {
    const Cut bow = cutOf({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(bow.crossing == 1);
    CHECK(bow.mesh.quads.size() == 1);
    const Cut eight = cutOf({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}, {-1, 2, 0}});
    CHECK(eight.crossing == 1);
    CHECK(eight.mesh.triangles.size() == 3);
    // All on a line: no area to lose.
    const Cut line = cutOf({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}, {3, 3, 3}});
    CHECK(line.crossing == 0);
    CHECK(line.mesh.triangles.size() == 3);
}
