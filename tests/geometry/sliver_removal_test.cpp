#include "libvdbsynth/geometry/sliver_removal.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/geometry/mesh_check.h"
#include "libvdbsynth/io/mesh_file.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

SliverOptions within(double tolerance) {
    SliverOptions options;
    options.tolerance = tolerance;
    return options;
}

// [degrees] by the law of cosines: the oracle.
double smallestAngle(const Mesh& mesh, const Triangle& t) {
    double smallest = 180;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d at = cast<double>(mesh.points[t[i]]);
        const Vec3d a = normalized(cast<double>(mesh.points[t[(i + 1) % 3]]) - at);
        const Vec3d b = normalized(cast<double>(mesh.points[t[(i + 2) % 3]]) - at);
        smallest = std::min(smallest, std::atan2(length(cross(a, b)), dot(a, b)) * 180 / 3.14159265358979);
    }
    return smallest;
}

std::size_t sliversOf(const Mesh& mesh) {
    const std::vector<Triangle> all = triangulated(mesh);
    return std::size_t(
        std::count_if(all.begin(), all.end(), [&](const Triangle& t) { return smallestAngle(mesh, t) < 5; }));
}

long eulerNumber(const Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    return long(mesh.points.size()) - long(edges.size()) + long(mesh.triangles.size());
}

// A flat hexagon about its middle; the side that begins at corner 0 is split at `middle`.
Mesh hexagon(const Vec3f& middle) {
    Mesh mesh;
    mesh.points = {{2, 0, 0}, {1, 2, 0}, {-1, 2, 0}, {-2, 0, 0}, {-1, -2, 0}, {1, -2, 0}, middle};
    for (std::uint32_t i = 0; i < 6; ++i) mesh.triangles.push_back({6, i, (i + 1) % 6});
    return mesh;
}

// A sphere whose edges were split at random, very near one of their ends: needles, and caps beside them.
Mesh roughSphere(std::uint64_t seed, int splits) {
    Mesh mesh = test::sphereMesh(10, 3);
    for (int i = 0; i < splits; ++i) {
        Random random(seed, std::uint64_t(i));
        const Triangle t = mesh.triangles[std::size_t(random.uniform(0, double(mesh.triangles.size())))];
        const std::uint32_t a = t[0], b = t[1], middle = std::uint32_t(mesh.points.size());
        const float share = float(random.uniform(0.005, 0.5));
        mesh.points.push_back(mesh.points[a] * (1 - share) + mesh.points[b] * share);
        const std::size_t count = mesh.triangles.size();
        for (std::size_t f = 0; f < count; ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t from = mesh.triangles[f][k], to = mesh.triangles[f][(k + 1) % 3];
                if (std::minmax(from, to) != std::minmax(a, b)) continue;
                const std::uint32_t far = mesh.triangles[f][(k + 2) % 3];
                mesh.triangles[f] = {from, middle, far};
                mesh.triangles.push_back({middle, to, far});
                break;
            }
    }
    return mesh;
}

}  // namespace

TEST_CASE("removeSlivers: a needle between two good triangles collapses, its neighbours close the gap",
          "[geometry][oracle]") {
    Mesh mesh = hexagon({0, 0, 0});
    // Corner 0 twice, 0.02 apart: the triangle between the middle and the two is a needle of 0.57 degrees.
    mesh.points.push_back({2, 0.02f, 0});
    mesh.triangles[0] = {6, 7, 1};
    mesh.triangles.push_back({6, 0, 7});
    // A face on the other side makes the two edges of corner 7 inner ones.
    mesh.points.push_back({5, 1, 0});
    mesh.triangles.push_back({7, 0, 8});
    mesh.triangles.push_back({1, 7, 8});
    mesh.attributes = {{"n", 1, {0, 1, 2, 3, 4, 5, 6, 7, 8}}};
    REQUIRE(sliversOf(mesh) == 2);
    const double area = summarize(mesh).area;
    const SliverResult result = removeSlivers(mesh, within(0.03));
    CHECK((result.before == 2 && result.left == 0 && result.collapses == 1 && result.flips == 0));
    CHECK(mesh.points.size() == 8);
    CHECK(mesh.attributes[0].values == std::vector<float>{0, 1, 2, 3, 4, 5, 6, 8});
    CHECK((mesh.points[7].x == 5 && mesh.triangles.size() == 7 && sliversOf(mesh) == 0));
    CHECK(summarize(mesh).area == Approx(area).epsilon(0.01));
}

TEST_CASE("removeSlivers: the long edge of a cap is flipped", "[geometry][oracle]") {
    // Corner 2 is 0.02 above the edge 0-1, whose other triangle is good; its corners are all at the outline.
    Mesh mesh;
    mesh.points = {{-1, 0, 0}, {1, 0, 0}, {0, 0.02f, 0}, {0, -2, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    const SliverResult result = removeSlivers(mesh, within(0));
    CHECK((result.before == 1 && result.left == 0 && result.collapses == 0 && result.flips == 1));
    CHECK(mesh.points.size() == 4);
    std::vector<Triangle> found = mesh.triangles;
    for (Triangle& t : found) std::rotate(t.begin(), std::find(t.begin(), t.end(), 2u), t.end());
    std::sort(found.begin(), found.end());
    CHECK(found == std::vector<Triangle>{{2, 0, 3}, {2, 3, 1}});
}

TEST_CASE("removeSlivers: what moves the surface further than the tolerance stays", "[geometry][oracle]") {
    // The same cap, but the fourth corner stands 1 out of the plane: the two diagonals are 0.0089 apart.
    const auto left = [](double tolerance) {
        Mesh mesh;
        mesh.points = {{-1, 0, 0}, {1, 0, 0}, {0, 0.02f, 0}, {0, -2, 1}};
        mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
        return removeSlivers(mesh, within(tolerance)).left;
    };
    CHECK(left(0.0085) == 1);
    CHECK(left(0.0095) == 0);
}

TEST_CASE("removeSlivers: closed, manifold, with the same Euler number and volume, no point moved",
          "[geometry][property]") {
    for (std::uint64_t seed : {1u, 2u, 3u}) {
        Mesh mesh = roughSphere(seed, 300);
        const Mesh before = mesh;
        const MeshSummary was = summarize(mesh);
        REQUIRE((was.closedManifold() && sliversOf(mesh) > 100));
        const SliverResult result = removeSlivers(mesh, within(0.1));
        CHECK_NOTHROW(requireMesh(mesh, "result"));
        const MeshSummary is = summarize(mesh);
        CHECK(is.closedManifold());
        CHECK(is.signedVolume == Approx(was.signedVolume).epsilon(1e-3));
        CHECK(eulerNumber(mesh) == eulerNumber(before));
        CHECK(result.before == sliversOf(before));
        CHECK(result.left == sliversOf(mesh));
        CHECK(result.left * 50 < result.before);
        CHECK(mesh.points.size() == before.points.size() - result.collapses);
        std::size_t at = 0;  // points that stay keep their order
        for (const Vec3f& p : before.points)
            if (at < mesh.points.size() && length(p - mesh.points[at]) == 0) ++at;
        CHECK(at == mesh.points.size());
        // Once more does nothing.
        const Mesh once = mesh;
        CHECK(removeSlivers(mesh, within(0)).collapses == 0);
        CHECK(mesh.points.size() == once.points.size());
    }
}

TEST_CASE("removeSlivers: repeats, and leaves a good mesh, quads split, as it is",
          "[geometry][property][determinism]") {
    Mesh a = roughSphere(7, 200), b = a;
    RunContext one;
    one.threads = 1;
    removeSlivers(a, within(0.1), one);
    removeSlivers(b, within(0.1));
    CHECK(a.triangles == b.triangles);
    CHECK(std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                     [](const Vec3f& p, const Vec3f& q) { return length(p - q) == 0; }));
    Mesh box = test::boxMesh({0, 0, 0}, {1, 1, 1});
    const std::vector<Triangle> split = triangulated(box);
    const SliverResult result = removeSlivers(box, within(1));
    CHECK((result.before == 0 && result.left == 0 && box.quads.empty() && box.triangles == split));
}

TEST_CASE("removeSlivers: edges and corners stay, also thin boxes, tetrahedra and needles of the solid",
          "[geometry][degenerate]") {
    // A box whose edge x = 1, z = 1 was split near its end.
    Mesh thin = test::boxMesh({0, 0, 0}, {1, 0.01f, 1});  // all its long faces' ends are slivers
    const SliverResult kept = removeSlivers(thin, within(0.001));
    CHECK((kept.left == kept.before && kept.collapses == 0 && thin.points.size() == 8));
    CHECK(summarize(thin).signedVolume == Approx(0.01));
    Mesh tetrahedron;  // 0.02 flat: nothing may change
    tetrahedron.points = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0.02f, 0}, {0.5f, 0.01f, 0.02f}};
    tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    REQUIRE(summarize(tetrahedron).closedManifold());
    CHECK(removeSlivers(tetrahedron, within(10)).collapses == 0);
    CHECK(summarize(tetrahedron).closedManifold());
    Mesh one;
    one.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {9, 9, 9}};
    one.triangles = {{0, 1, 2}};  // no area, no neighbours, and a point that no face uses
    const SliverResult result = removeSlivers(one, within(10));
    CHECK((result.before == 1 && result.left == 1 && one.points.size() == 4 && one.triangles.size() == 1));
    Mesh twice;  // faces that use a corner twice, coincident points, three faces at an edge
    twice.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}};
    twice.triangles = {{0, 1, 1}, {0, 1, 2}, {1, 0, 4}, {0, 1, 3}, {0, 3, 2}};
    CHECK_NOTHROW(removeSlivers(twice, within(1)));
    CHECK_NOTHROW(requireMesh(twice, "result"));
}

TEST_CASE("removeSlivers: equal points of a closed mesh become one", "[geometry][degenerate]") {
    Mesh mesh = roughSphere(3, 0);
    // An edge split at its own end: two triangles without area.
    const Triangle t = mesh.triangles[0];
    mesh.points.push_back(mesh.points[t[0]]);
    const std::uint32_t fresh = std::uint32_t(mesh.points.size() - 1);
    const std::size_t count = mesh.triangles.size();
    for (std::size_t f = 0; f < count; ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = mesh.triangles[f][k], to = mesh.triangles[f][(k + 1) % 3];
            if (std::minmax(from, to) != std::minmax(t[0], t[1])) continue;
            const std::uint32_t far = mesh.triangles[f][(k + 2) % 3];
            mesh.triangles[f] = {from, fresh, far};
            mesh.triangles.push_back({fresh, to, far});
            break;
        }
    REQUIRE(summarize(mesh).closedManifold());
    CHECK(removeSlivers(mesh, within(0)).left == 0);
    CHECK(summarize(mesh).closedManifold());
    CHECK(mesh.points.size() == fresh);
}

TEST_CASE("removeSlivers: options out of range, bad meshes, cancel", "[geometry][error]") {
    const auto refusal = [](const SliverOptions& options, const char* field) {
        const test::Thrown thrown = test::thrownBy([&] { validate(options); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, field));
        Mesh mesh = test::sphereMesh(1, 1);
        CHECK(test::thrownBy([&] { removeSlivers(mesh, options); }).message == thrown.message);
    };
    for (double angle : {0.0, -1.0, 31.0, std::nan("")}) refusal({angle, 0}, "`angle`");
    for (double tolerance : {-1.0, 1e31, std::nan("")}) refusal({5, tolerance}, "`tolerance`");
    Mesh none, wild = test::sphereMesh(1, 0), infinite = wild, ragged = wild;
    wild.triangles[0][0] = 99;
    infinite.points[0].x = INFINITY;
    ragged.attributes = {{"a", 1, {1}}};
    const auto code = [](Mesh& mesh) { return test::thrownBy([&] { removeSlivers(mesh, {}); }).code; };
    CHECK(code(none) == int(ErrorCode::EmptyInput));
    for (Mesh* bad : {&wild, &infinite, &ragged}) CHECK(code(*bad) == int(ErrorCode::BadData));
    const std::atomic<bool> stop{true};
    RunContext ctx;
    ctx.cancel = &stop;
    Mesh mesh = roughSphere(1, 50);
    CHECK(test::thrownBy([&] { removeSlivers(mesh, within(0.1), ctx); }).code == int(ErrorCode::Cancelled));
}
