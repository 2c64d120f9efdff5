#include "libvdbsynth/render/wires.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <numeric>

using namespace vdbsynth;

namespace {

// Straight from the front at a square of 2 x 2 that is 10 away.
Camera front() {
    Camera camera;
    camera.eye = {0, -10, 0};
    camera.forward = {0, 1, 0};
    camera.right = {1, 0, 0};
    camera.up = {0, 0, 1};
    camera.spanX = camera.spanY = 0.2;  // 4 x 4 there
    return camera;
}

Mesh square() {
    Mesh mesh;
    mesh.points = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    mesh.quads = {{0, 1, 2, 3}};
    return mesh;
}

double sumOf(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

TEST_CASE("wireCoverage: the sides of a square where they are, one pixel wide, and no diagonal",
          "[render][oracle]") {
    const std::vector<float> depths(100 * 100, 1e30f);
    const std::vector<float> cover = wireCoverage(square(), front(), 100, 100, depths, 0.1);
    const auto at = [&](int x, int y) { return cover[std::size_t(y * 100 + x)]; };
    CHECK(at(25, 50) + at(24, 50) == Approx(1).margin(0.02));  // the side is at 25.0, between two pixels
    CHECK(at(50, 75) + at(50, 74) == Approx(1).margin(0.02));
    CHECK(at(50, 50) == 0);
    CHECK(at(40, 60) == 0);
    CHECK(at(20, 50) == 0);
    CHECK(sumOf(cover) == Approx(200).margin(6));
}

TEST_CASE("wireCoverage: what lies behind the surface is hidden, but for the slack", "[render]") {
    std::vector<float> depths(100 * 100, 1e30f);
    for (std::size_t y = 0; y < 100; ++y)
        for (std::size_t x = 0; x < 50; ++x) depths[y * 100 + x] = 9.5f;
    const std::vector<float> half = wireCoverage(square(), front(), 100, 100, depths, 0.1);
    CHECK(half[50 * 100 + 25] == 0);
    CHECK(half[50 * 100 + 75] + half[50 * 100 + 74] > 0.9f);
    CHECK(sumOf(wireCoverage(square(), front(), 100, 100, depths, 0.6)) > 1.8 * sumOf(half));
}

TEST_CASE("wireCoverage: edges behind or beside the camera leave nothing", "[render]") {
    const std::vector<float> depths(100 * 100, 1e30f);
    Camera camera = front();
    camera.eye.y = 10;
    CHECK(sumOf(wireCoverage(square(), camera, 100, 100, depths, 0.1)) == 0);
    camera = front();
    camera.eye.x = 1e7;
    CHECK(sumOf(wireCoverage(square(), camera, 100, 100, depths, 0.1)) == 0);
}
