#include "libvdbsynth/distance/zero_level.h"

#include "libvdbsynth/base/random.h"
#include "tests/support/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

BrickField ballField(const IndexBox& box, const Vec3d& centre, double radius) {
    return BrickField::generate(box, {}, [&](const IndexBox& brick, float* samples) {
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const Index3 p = brick.min + Index3{i >> 6, i >> 3 & 7, i & 7};
            samples[i] = float(length(cast<double>(Vec3<int>{p.x, p.y, p.z}) - centre) - radius);
        }
    });
}

}  // namespace

TEST_CASE("zeroLevel: one sample inside is an octahedron of eight vertices and six faces",
          "[distance][oracle]") {
    // Around one sample inside lie eight cells, each with a vertex, and six edges, each with a quad.
    BrickField field(IndexBox{{-4, -4, -4}, {4, 4, 4}}, 1.f);
    const float inside = -1.f;
    field.writeBox({1, 0, -1}, {1, 1, 1}, &inside);
    const Mesh mesh = zeroLevel(field, field.box(), Facing::Outward);
    REQUIRE(mesh.points.size() == 8);
    REQUIRE(mesh.quads.size() == 6);
    REQUIRE(mesh.triangles.empty());
    const MeshSummary outward = summarize(mesh);
    CHECK(outward.closedManifold());
    CHECK(outward.signedVolume > 0);
    for (const Vec3f& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis) {
            const float middle = axis == 0 ? 1.f : axis == 1 ? 0.f : -1.f;
            CHECK(std::abs(std::abs(p[axis] - middle) - 0.2f) < 0.15f);
        }
    const MeshSummary inward = summarize(zeroLevel(field, field.box(), Facing::Inward));
    CHECK(inward.closedManifold());
    CHECK(inward.signedVolume == Approx(-outward.signedVolume));
}

TEST_CASE("zeroLevel: vertices of a ball lie on it", "[distance][property]") {
    const Vec3d centre{3.3, -2.1, 5.7};
    const BrickField field = ballField({{-20, -20, -20}, {30, 30, 30}}, centre, 11.4);
    const Mesh mesh = zeroLevel(field, field.box(), Facing::Outward);
    const MeshSummary summary = summarize(mesh);
    CHECK(summary.closedManifold());
    CHECK(summary.signedVolume == Approx(4.0 / 3 * 3.14159265 * 11.4 * 11.4 * 11.4).epsilon(0.01));
    double farthest = 0;
    for (const Vec3f& p : mesh.points)
        farthest = std::max(farthest, std::abs(length(cast<double>(p) - centre) - 11.4));
    CHECK(farthest < 0.03);  // so far is the trilinear field itself off
}

TEST_CASE("zeroLevel: noise of any signs is closed, and consistently oriented", "[distance][property]") {
    const BrickField field =
        BrickField::generate({{0, 0, 0}, {19, 19, 19}}, {}, [](const IndexBox& brick, float* samples) {
            for (int i = 0; i < BrickField::kSamples; ++i) {
                const Index3 p = brick.min + Index3{i >> 6, i >> 3 & 7, i & 7};
                const bool border = std::min({p.x, p.y, p.z}) < 2 || std::max({p.x, p.y, p.z}) > 17;
                Random random(7, std::uint64_t((p.x * 64 + p.y) * 64 + p.z));
                samples[i] = border ? 1.f : float(random.uniform()) - 0.5f;
            }
        });
    const MeshSummary summary = summarize(zeroLevel(field, field.box(), Facing::Outward));
    CHECK(summary.faces > 2000);
    CHECK(summary.openEdges == 0);
}

TEST_CASE("zeroLevel: a region has the faces that all of it has there, for any number of threads",
          "[distance][property][threads]") {
    const BrickField field = ballField({{-20, -20, -20}, {30, 30, 30}}, {3.3, -2.1, 5.7}, 11.4);
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    const Mesh all = zeroLevel(field, field.box(), Facing::Inward, one);
    const Mesh again = zeroLevel(field, field.box(), Facing::Inward, four);
    REQUIRE(all.quads == again.quads);
    for (std::size_t i = 0; i < all.points.size(); ++i) CHECK(length(all.points[i] - again.points[i]) == 0);
    const Mesh part = zeroLevel(field, {{0, 0, 0}, {7, 7, 15}}, Facing::Inward, four);
    CHECK(part.faceCount() > 50);
    CHECK(part.faceCount() < all.faceCount());
    for (const Vec3f& p : part.points)
        CHECK(std::any_of(all.points.begin(), all.points.end(),
                          [&](const Vec3f& q) { return length(p - q) == 0; }));
}

TEST_CASE("zeroLevel: nothing where all samples have one sign, and cancel is heard",
          "[distance][degenerate][cancel]") {
    const IndexBox box = IndexBox::fromSize({40, 40, 40});
    CHECK(zeroLevel(BrickField(box, 1.f), box, Facing::Outward).faceCount() == 0);
    CHECK(zeroLevel(BrickField(box, -1.f), box, Facing::Outward).faceCount() == 0);
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK_THROWS(zeroLevel(BrickField(box, 1.f), box, Facing::Outward, ctx));
}
