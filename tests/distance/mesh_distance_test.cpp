#include "libvdbsynth/distance/mesh_distance.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("meshDistance: a sphere of small faces has a sphere's distances, in any band", "[grid][oracle]") {
    const Mesh mesh = test::sphereMesh(12, 4);
    for (float halfWidth : {3.f, 8.f}) {
        const IndexBox box{{-22, -21, -23}, {22, 24, 20}};
        const BrickField field = meshDistance(mesh, box, halfWidth);
        for (int x = box.min.x; x <= box.max.x; ++x)
            for (int y = box.min.y; y <= box.max.y; ++y)
                for (int z = box.min.z; z <= box.max.z; ++z) {
                    const double d = std::min(std::abs(length(Vec3d{double(x), double(y), double(z)}) - 12),
                                              double(halfWidth));
                    REQUIRE(double(field.at({x, y, z})) == Approx(d).margin(0.08));
                }
    }
}

TEST_CASE("meshDistance: near the faces equal to the least distance to all of them, elsewhere close",
          "[grid][oracle]") {
    // Two small spheres that nearly touch: creases in the distance everywhere between them.
    Mesh mesh = test::sphereMesh(4, 2);
    const std::uint32_t first = std::uint32_t(mesh.points.size());
    for (Vec3f p : test::sphereMesh(3, 2).points) mesh.points.push_back(p + Vec3f{7.3f, 1.1f, 0.4f});
    for (Triangle t : test::sphereMesh(3, 2).triangles)
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    const IndexBox box{{-9, -9, -9}, {15, 9, 9}};
    const BrickField field = meshDistance(mesh, box, 5.f);
    // The oracle samples every face densely, so it is above the true distance by at most 0.03.
    std::vector<Vec3d> samples;
    for (const Triangle& t : mesh.triangles)
        for (int i = 0; i <= 24; ++i)
            for (int j = 0; i + j <= 24; ++j)
                samples.push_back(cast<double>(mesh.points[t[0]]) * (1 - (i + j) / 24.0) +
                                  cast<double>(mesh.points[t[1]]) * (i / 24.0) +
                                  cast<double>(mesh.points[t[2]]) * (j / 24.0));
    for (int x = box.min.x; x <= box.max.x; x += 2)
        for (int y = box.min.y; y <= box.max.y; y += 3)
            for (int z = box.min.z; z <= box.max.z; z += 2) {
                double nearest = 1e9;
                for (const Vec3d& s : samples)
                    nearest = std::min(nearest, length(s - Vec3d{double(x), double(y), double(z)}));
                nearest = std::min(nearest, 5.0);
                const double value = double(field.at({x, y, z}));
                REQUIRE(value >= nearest - 0.06);
                REQUIRE(value <= nearest + (nearest < 2 ? 1e-4 : 0.1));
            }
}

TEST_CASE("meshDistance: no faces, and the same bits for any number of threads",
          "[grid][degenerate][determinism]") {
    const BrickField empty = meshDistance(Mesh(), IndexBox::fromSize({20, 20, 20}), 3.f);
    CHECK(empty.storedBricks() == 0);
    CHECK(empty.at({5, 5, 5}) == 3.f);
    const auto run = [](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        return test::samplesOf(
            meshDistance(test::sphereMesh(9, 3), {{-14, -14, -14}, {14, 14, 14}}, 4.f, ctx));
    };
    CHECK(run(1) == run(2));
}
