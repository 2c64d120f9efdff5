#include "libvdbsynth/pipeline/direction/place_directions.h"

#include <catch2/catch.hpp>
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "tests/support/makers.h"

using namespace vdbsynth;
using Kind = DirectionSource::Kind;

namespace {

constexpr double kTurn = 3.14159265358979323846;

DirectionSource strokes(std::vector<Stroke> given) {
    DirectionSource source;
    source.kind = Kind::Strokes;
    source.strokes = std::move(given);
    return source;
}

Vec3d randomUnit(std::uint64_t i) {
    Random random(7, i);
    return normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
}

bool same(const Vec3d& a, const Vec3d& b) {
    return length(a - b) < 1e-9;
}

}  // namespace

TEST_CASE("directionsInSpace: unit length, 0 where there is none, none at all is an error", "[pipeline]") {
    openvdb::initialize();
    DirectionSource source;
    source.kind = Kind::Grid;
    const auto vectors = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    vectors->fill(openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}), openvdb::Vec3f(0, 5, 0));
    source.grid = vectors;
    const std::vector<Vec3d> found = directionsInSpace(source, {{2, 2, 2}, {50, 0, 0}}, {}, "direction");
    CHECK(same(found[0], Vec3d{0, 1, 0}));
    CHECK(same(found[1], Vec3d{0, 0, 0}));
    CHECK(test::thrownBy([&] {
              directionsInSpace(source, {{50, 0, 0}}, {}, "direction");
          }).code == int(ErrorCode::Unusable));
    CHECK(test::thrownBy([&] {
              directionsInSpace(DirectionSource{}, {{0, 0, 0}}, {}, "direction");
          }).code == int(ErrorCode::InvalidOption));
    RunContext ctx;
    std::atomic<bool> cancel{true};
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] {
              directionsInSpace(source, {{2, 2, 2}}, {}, "direction", ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("directionsInSpace: strokes hold where they are, and are mixed in between", "[pipeline]") {
    const DirectionSource two = strokes({{{0, 0, 0}, {3, 0, 0}}, {{10, 0, 0}, {0, 2, 0}}});
    const auto found = directionsInSpace(two, {{0, 0, 0}, {10, 0, 0}, {5, 0, 0}, {1, 0, 0}}, {}, "direction");
    CHECK(same(found[0], Vec3d{1, 0, 0}));
    CHECK(same(found[1], Vec3d{0, 1, 0}));
    CHECK(found[2].x == Approx(std::sqrt(0.5)));
    // Weights 1 and 1/81.
    CHECK(found[3].y / found[3].x == Approx(1.0 / 81));
    // Continuous where a stroke leaves the nearest eight.
    std::vector<Stroke> many;
    for (int i = 0; i < 30; ++i)
        many.push_back({{double(i), double(i * i % 7), 0}, randomUnit(std::uint64_t(i))});
    std::vector<Vec3d> line;
    for (int i = 0; i < 3000; ++i) line.push_back({0.31 + i * 0.009, 2.17, 0.5});
    const auto along = directionsInSpace(strokes(many), line, {}, "direction");
    for (std::size_t i = 1; i < along.size(); ++i) CHECK(length(along[i] - along[i - 1]) < 0.2);
}

TEST_CASE("rotationsBetween: each takes its direction to the other by the least angle",
          "[pipeline][property]") {
    std::vector<Vec3d> from, to;
    for (std::uint64_t i = 0; i < 200; ++i) {
        from.push_back(randomUnit(2 * i));
        to.push_back(randomUnit(2 * i + 1));
    }
    const std::vector<Vec3d> rotations = rotationsBetween(from, to);
    for (std::size_t i = 0; i < from.size(); ++i) {
        CHECK(length(transformed(rotationMatrix(rotations[i]), from[i]) - to[i]) < 1e-9);
        CHECK(length(rotations[i]) == Approx(std::acos(dot(from[i], to[i]))));
    }
    CHECK(same(rotationsBetween({{1, 0, 0}}, {{0, 0, 0}})[0], Vec3d{0, 0, 0}));
    CHECK(same(rotationsBetween({{1, 0, 0}}, {{1, 0, 0}})[0], Vec3d{0, 0, 0}));
    CHECK(rotationsBetween({}, {}).empty());
}

TEST_CASE("rotationsBetween: half a turn in the plane of the others", "[pipeline]") {
    const Vec3d x{1, 0, 0};
    const auto in = [&](const Vec3d& second) { return rotationsBetween({x, x, x}, {second, -x, x})[1]; };
    CHECK(length(in({0, 1, 0}) - Vec3d{0, 0, kTurn}) < 1e-9);
    CHECK(std::abs(in({0, 0, 1}).y) == Approx(kTurn));
    // Nothing else rotates: about z.
    CHECK(length(rotationsBetween({x}, {-x})[0] - Vec3d{0, 0, kTurn}) < 1e-9);
    CHECK(length(rotationsBetween({{0, 0, 1}}, {{0, 0, -1}})[0] - Vec3d{kTurn, 0, 0}) < 1e-9);
}
