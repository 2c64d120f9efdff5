#include "libvdbsynth/relief/growth/density_correlation.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/said.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

namespace {

Mesh squareOf(int cells, float side) {
    Mesh mesh;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x)
            mesh.points.push_back({float(x) * side / float(cells), float(y) * side / float(cells), 0});
    const auto at = [&](int x, int y) { return std::uint32_t(y * (cells + 1) + x); };
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x)
            mesh.quads.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    return mesh;
}

Mesh tetrahedron() {
    Mesh mesh;
    mesh.points = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

}  // namespace

TEST_CASE("vertexDensity: by hand, unused vertices do not count") {
    Mesh mesh = squareOf(4, 2);
    CHECK(vertexDensity(mesh) == Approx(25 / 4.0));
    mesh.points.push_back({9, 9, 9});
    CHECK(vertexDensity(mesh) == Approx(25 / 4.0));
    CHECK(vertexDensity({}) == 0);
}

TEST_CASE("refineToVertices: the longest edge of one triangle, by hand") {
    Mesh mesh;
    mesh.points = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.attributes = {{"heat", 1, {1, 2, 4}}};
    CHECK(refineToVertices(mesh, 4) == 1);
    CHECK(mesh.points[3].x == 1.5f);
    CHECK(mesh.points[3].y == 2);
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}});
    CHECK(mesh.attributes[0].values == std::vector<float>{1, 2, 4, 3});
    CHECK(refineToVertices(mesh, 4) == 0);
}

TEST_CASE("refineToVertices: closed stays closed, area and volume stay, spacing becomes even") {
    Mesh mesh = tetrahedron();
    const MeshSummary before = summarize(mesh);
    CHECK(refineToVertices(mesh, 3000) == 2996);
    const MeshSummary after = summarize(mesh);
    CHECK(after.vertices == 3000);
    CHECK(after.closedManifold());
    CHECK(after.area == Approx(before.area));
    CHECK(after.signedVolume == Approx(before.signedVolume));
    double longest = 0;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, double(length(mesh.points[t[k]] - mesh.points[t[(k + 1) % 3]])));
    CHECK(longest < 2.2 * std::sqrt(after.area / 3000));
}

TEST_CASE("refineToVertices: open, non-manifold and degenerate meshes") {
    Mesh open = squareOf(1, 1);
    refineToVertices(open, 500);
    CHECK(open.quads.empty());
    CHECK(summarize(open).nonManifoldEdges == 0);
    CHECK(summarize(open).area == Approx(1));
    Mesh fan;  // three faces at an edge
    fan.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    fan.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    const double area = summarize(fan).area;
    refineToVertices(fan, 200);
    CHECK(summarize(fan).area == Approx(area));
    Mesh flat;  // no edge has a length
    flat.points.assign(3, {1, 1, 1});
    flat.triangles = {{0, 1, 2}};
    CHECK(refineToVertices(flat, 10) == 0);
    Mesh twice;  // a face that uses a corner twice
    twice.points = {{0, 0, 0}, {1, 0, 0}};
    twice.triangles = {{0, 1, 0}};
    CHECK(refineToVertices(twice, 4) <= 2);
}

TEST_CASE("correlateDensities: the sparser one is refined, equal ones stay") {
    Mesh sample = squareOf(10, 1), target = squareOf(5, 2);
    test::Said said;
    const DensityCorrelation result = correlateDensities(sample, target, said.ctx);
    CHECK(result.targetRefined);
    CHECK(said.noted("the target has"));
    CHECK(sample.points.size() == 121);
    CHECK(vertexDensity(target) == Approx(vertexDensity(sample)).epsilon(0.01));
    CHECK(result.added == target.points.size() - 36);

    Mesh again = squareOf(5, 2), fine = squareOf(40, 2);
    CHECK_FALSE(correlateDensities(again, fine).targetRefined);
    CHECK(vertexDensity(again) == Approx(vertexDensity(fine)).epsilon(0.01));
    CHECK(correlateDensities(again, fine).added == 0);
}

TEST_CASE("correlateDensities: errors, memory, cancel") {
    Mesh none, square = squareOf(20, 1), sparse = squareOf(2, 1);
    CHECK(test::thrownBy([&] { correlateDensities(none, square); }).code == int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] { correlateDensities(square, none); }).code == int(ErrorCode::EmptyInput));
    RunContext little;
    little.maxMemory = 1000;
    CHECK(test::thrownBy([&] { correlateDensities(square, sparse, little); }).code == int(ErrorCode::Memory));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              correlateDensities(square, sparse, ctx);
          }).code == int(ErrorCode::Cancelled));
    CHECK(sparse.points.size() == 9);
    Mesh huge = squareOf(1, 1e6f), tiny = squareOf(20, 1e-3f);
    CHECK(test::thrownBy([&] { correlateDensities(tiny, huge); }).code == int(ErrorCode::Memory));
}
