#include "libvdbsynth/geometry/rest_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "tests/support/makers.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

namespace {

// A strip of quads along x with a row of triangles beside it.
Mesh strip() {
    Mesh mesh;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 3; ++j) mesh.points.push_back({float(i), float(j), 0});
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t a = 3 * i;
        mesh.quads.push_back({a, a + 3, a + 4, a + 1});
        mesh.triangles.push_back({a + 1, a + 4, a + 5});
        mesh.triangles.push_back({a + 1, a + 5, a + 2});
    }
    return mesh;
}

template <typename Move>
Mesh moved(Mesh mesh, const Move& move) {
    for (Vec3f& p : mesh.points) p = cast<float>(move(cast<double>(p)));
    return mesh;
}

}  // namespace

TEST_CASE("RestMap: in the pose at rest every place is its own", "[geometry]") {
    const RestMap map(strip(), strip());
    for (std::uint32_t face = 0; face < map.posed().triangles.size(); ++face) {
        const RestPlace rest = map.at({1.3, 0.7, 0.4}, face);
        CHECK(length(rest.place - Vec3d{1.3, 0.7, 0.4}) < 1e-12);
        CHECK(length(rest.turn[2] - Vec3d{0, 0, 1}) < 1e-12);
    }
}

TEST_CASE("RestMap: a rigid motion is taken back, beside the surface and beyond its ends",
          "[geometry][property]") {
    const double c = 0.8, s = 0.6;
    const auto motion = [&](const Vec3d& p) {
        return Vec3d{c * p.x - s * p.z + 3, p.y - 2, s * p.x + c * p.z};
    };
    const RestMap map(strip(), moved(strip(), motion));
    Random random(1, 0);
    for (int n = 0; n < 200; ++n) {
        const Vec3d at{random.uniform(-1, 5), random.uniform(-1, 3), random.uniform(-2, 2)};
        const auto face = random.below(std::uint32_t(map.posed().triangles.size()));
        const RestPlace rest = map.at(motion(at), face);
        REQUIRE(length(rest.place - at) < 1e-5);
        REQUIRE(length(rest.turn[2] - Vec3d{-s, 0, c}) < 1e-5);
    }
}

TEST_CASE("RestMap: a quad that is concave in one pose only, and is split there", "[geometry]") {
    const Mesh rest = strip();
    Mesh posed = rest;
    // The second quad as two triangles, along either diagonal.
    const Quad q = posed.quads[1];
    posed.quads.erase(posed.quads.begin() + 1);
    const std::vector<Triangle> splits[2] = {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}},
                                             {{q[1], q[2], q[3]}, {q[3], q[0], q[1]}}};
    for (const auto& split : splits)
        for (const bool swapped : {false, true}) {
            Mesh other = posed;
            other.triangles.insert(other.triangles.begin() + 2, split.begin(), split.end());
            const RestMap map(swapped ? other : rest, swapped ? rest : other);
            CHECK(map.posed().triangles.size() == 16);
            CHECK(length(map.at({1.3, 0.7, 0.4}, 3).place - Vec3d{1.3, 0.7, 0.4}) < 1e-12);
        }
    // A hole is not a split, nor is another order of vertices.
    CHECK(test::thrownBy([&] { RestMap(rest, posed); }).code == int(ErrorCode::ShapeMismatch));
    Mesh shuffled = rest;
    for (Triangle& t : shuffled.triangles)
        for (std::uint32_t& v : t) v = (v + 3) % 15;
    for (Quad& quad : shuffled.quads)
        for (std::uint32_t& v : quad) v = (v + 3) % 15;
    CHECK(test::thrownBy([&] { RestMap(rest, shuffled); }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("RestMap: a stretch moves places along the surface, heights stay", "[geometry]") {
    const RestMap map(strip(), moved(strip(), [](const Vec3d& p) { return Vec3d{2 * p.x, p.y, p.z}; }));
    for (std::uint32_t face = 0; face < map.posed().triangles.size(); ++face) {
        // Over the middle of each face.
        Vec3d middle;
        for (const std::uint32_t v : map.posed().triangles[face])
            middle = middle + cast<double>(map.posed().points[v]) * (1.0 / 3);
        const RestPlace rest = map.at(middle + Vec3d{0, 0, 0.75}, face);
        CHECK(length(rest.place - Vec3d{middle.x / 2, middle.y, 0.75}) < 1e-6);
    }
}

TEST_CASE("RestMap: bent round a cylinder, heights over it are heights over the strip",
          "[geometry][oracle]") {
    constexpr double kRadius = 20;
    Mesh fine;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 4; ++j) fine.points.push_back({float(i) * 0.25f, float(j) * 0.25f, 0});
    for (std::uint32_t i = 0; i < 40; ++i)
        for (std::uint32_t j = 0; j < 4; ++j)
            fine.quads.push_back({i * 5 + j, i * 5 + 5 + j, i * 5 + 6 + j, i * 5 + j + 1});
    const auto bend = [&](const Vec3d& p) {
        const double angle = p.x / kRadius, s = std::sin(angle), c = std::cos(angle);
        return Vec3d{(kRadius + p.z) * s, p.y, (kRadius + p.z) * c - kRadius};
    };
    const RestMap map(fine, moved(fine, bend));
    double worst = 0;
    std::size_t tried = 0;
    for (std::uint32_t face = 0; face < map.posed().triangles.size(); ++face) {
        Vec3d middle;
        for (const std::uint32_t v : map.posed().triangles[face])
            middle = middle + cast<double>(fine.points[v]) * (1.0 / 3);
        if (middle.x < 0.5 || middle.x > 9.5) continue;
        for (const double height : {-2.0, 0.0, 2.0}) {
            const Vec3d at{middle.x, middle.y, height};
            worst = std::max(worst, length(map.at(bend(at), face).place - at));
            ++tried;
        }
    }
    CHECK(tried > 500);
    CHECK(worst < 0.02);
}

TEST_CASE("RestMap: meshes of other faces are refused", "[geometry][error]") {
    Mesh fewer = strip(), others = strip();
    fewer.triangles.pop_back();
    others.triangles[0] = {0, 7, 14};
    CHECK(test::thrownBy([&] { RestMap(strip(), fewer); }).code == int(ErrorCode::ShapeMismatch));
    CHECK(test::thrownBy([&] { RestMap(strip(), others); }).code == int(ErrorCode::ShapeMismatch));
    Mesh reordered = strip();
    std::swap(reordered.triangles[0], reordered.triangles[1]);
    CHECK_NOTHROW(RestMap(strip(), reordered));
    CHECK(test::thrownBy([&] { RestMap({}, {}); }).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("RestMap: faces without area take part in nothing", "[geometry][degenerate]") {
    Mesh mesh = strip();
    mesh.points.push_back({9, 9, 9});
    mesh.triangles.push_back({0, 0, 15});
    const RestMap map(mesh, mesh);
    const RestPlace rest = map.at({1, 1, 1}, 0);
    CHECK(length(rest.place - Vec3d{1, 1, 1}) < 1e-12);
    const RestPlace flat = map.at({9, 9, 8}, 8);
    CHECK(std::isfinite(flat.place.x));
}
