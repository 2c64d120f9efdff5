#include "libvdbsynth/measure/surface_distance.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/geometry/triangle.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;

namespace {

// A square sheet of cells of one, at a height that may vary.
Mesh sheet(int side, const std::function<float(int x, int y)>& height) {
    Mesh mesh;
    const auto number = [side](int x, int y) { return std::uint32_t(x * (side + 1) + y); };
    for (int x = 0; x <= side; ++x)
        for (int y = 0; y <= side; ++y) mesh.points.push_back({float(x), float(y), height(x, y)});
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            mesh.quads.push_back({number(x, y), number(x + 1, y), number(x + 1, y + 1), number(x, y + 1)});
    return mesh;
}

// Over all faces; every vertex by a third of its faces' area.
SurfaceDistance oneWay(const Mesh& from, const Mesh& to) {
    std::vector<double> area(from.points.size(), 0);
    for (const Triangle& t : triangulated(from))
        for (std::uint32_t v : t)
            area[v] += double(length(cross(from.points[t[1]] - from.points[t[0]],
                                           from.points[t[2]] - from.points[t[0]]))) /
                       6;
    SurfaceDistance result;
    double total = 0;
    for (std::size_t i = 0; i < from.points.size(); ++i) {
        double best = 1e30;
        const Vec3d p = cast<double>(from.points[i]);
        for (const Triangle& t : triangulated(to)) {
            const Vec3d a = cast<double>(to.points[t[0]]), b = cast<double>(to.points[t[1]]),
                        c = cast<double>(to.points[t[2]]);
            const Vec3d w = nearestInTriangle(p, a, b, c);
            best = std::min(best, length(p - (a * w.x + b * w.y + c * w.z)));
        }
        total += area[i];
        result.mean += area[i] * best;
        result.rootMean += area[i] * best * best;
        result.hausdorff = std::max(result.hausdorff, best);
    }
    return {result.mean / total, std::sqrt(result.rootMean / total), result.hausdorff};
}

}  // namespace

TEST_CASE("surfaceDistance: two spheres are their radii's difference apart", "[measure][oracle]") {
    const Mesh small = test::sphereMesh(10, 4), large = test::sphereMesh(11, 4);
    const SurfaceDistance d = surfaceDistance(small, large);
    CHECK(d.mean == Approx(1).margin(0.02));
    CHECK(d.rootMean == Approx(1).margin(0.02));
    CHECK(d.hausdorff == Approx(1).margin(0.02));
    CHECK(surfaceDistance(small, small).hausdorff == Approx(0).margin(1e-6));
    // A bump of one vertex: Hausdorff sees it, the mean hardly.
    Mesh bumped = small;
    bumped.points[0] = bumped.points[0] * 1.3f;
    const SurfaceDistance bump = surfaceDistance(small, bumped);
    CHECK(bump.hausdorff == Approx(3).margin(0.1));
    CHECK(bump.mean < 0.02);
}

TEST_CASE("surfaceDistance: the larger of both ways, in either order", "[measure][oracle]") {
    // All of the short sheet lies half above the long one, whose other end is far from the short one.
    const Mesh longer = sheet(8, [](int, int) { return 0.f; });
    const Mesh shorter = sheet(4, [](int, int) { return 0.5f; });
    const SurfaceDistance there = surfaceDistance(shorter, longer), back = surfaceDistance(longer, shorter);
    CHECK(there.hausdorff == Approx(std::sqrt(0.25 + 16 + 16)));
    CHECK(back.hausdorff == there.hausdorff);
    CHECK(back.mean == there.mean);
    CHECK(back.rootMean == there.rootMean);
    CHECK(there.mean > 1);
}

TEST_CASE("surfaceDistance: as over all faces of the other, each vertex by its area", "[measure][oracle]") {
    const Mesh a = sheet(9, [](int x, int y) { return float(std::sin(x * 0.7) + 0.3 * y); });
    Mesh b = sheet(9, [](int x, int y) { return float(std::sin(x * 0.7 + 0.5) + 0.28 * y + 0.4); });
    b.points.push_back({0, 0, 500});  // without faces it is not on the surface
    const SurfaceDistance expected[] = {oneWay(a, b), oneWay(b, a)};
    const SurfaceDistance found = surfaceDistance(a, b);
    CHECK(found.mean == Approx(std::max(expected[0].mean, expected[1].mean)));
    CHECK(found.rootMean == Approx(std::max(expected[0].rootMean, expected[1].rootMean)));
    CHECK(found.hausdorff < 2);
    b.points.pop_back();
    CHECK(found.hausdorff == Approx(std::max(oneWay(a, b).hausdorff, oneWay(b, a).hausdorff)));
}

TEST_CASE("surfaceDistance: only vertices inside the box, none give 0", "[measure][oracle][degenerate]") {
    const Mesh flat = sheet(20, [](int, int) { return 0.f; });
    const Mesh step = sheet(20, [](int x, int) { return x < 10 ? 0.25f : 2.f; });
    const IndexBox low{{1, 1, -5}, {7, 19, 5}}, high{{12, 1, -5}, {19, 19, 5}};
    CHECK(surfaceDistance(flat, step, low).hausdorff == Approx(0.25));
    CHECK(surfaceDistance(flat, step, high).mean == Approx(2));
    CHECK(surfaceDistance(flat, step).hausdorff == Approx(2));
    const SurfaceDistance none = surfaceDistance(flat, step, IndexBox{{30, 0, 0}, {40, 9, 9}});
    CHECK((none.mean == 0 && none.rootMean == 0 && none.hausdorff == 0));
}

TEST_CASE("surfaceDistance: the same bits for any threads, stops when asked to",
          "[measure][determinism][cancel]") {
    const Mesh a = test::sphereMesh(10, 4), b = test::boxMesh({-8, -8, -8}, {8, 8, 8});
    RunContext one, four, stopped;
    one.threads = 1;
    four.threads = 4;
    const SurfaceDistance first = surfaceDistance(a, b, {}, one), again = surfaceDistance(a, b, {}, four);
    CHECK(first.mean == again.mean);
    CHECK(first.rootMean == again.rootMean);
    CHECK(first.hausdorff == again.hausdorff);
    std::atomic<bool> cancel{true};
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { surfaceDistance(a, b, {}, stopped); }).code == int(ErrorCode::Cancelled));
}
