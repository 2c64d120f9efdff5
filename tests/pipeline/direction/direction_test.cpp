#include "libvdbsynth/pipeline/direction/direction.h"

#include <catch2/catch.hpp>
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"

using namespace vdbsynth;
using Kind = DirectionSource::Kind;

namespace {

DirectionSource direction(const std::string& text) {
    DirectionSource source;
    REQUIRE(parseDirection(text, source));
    return source;
}

bool same(const Vec3d& a, const Vec3d& b) {
    return length(a - b) < 1e-9;
}

}  // namespace

TEST_CASE("parseDirection: what it takes and what it does not", "[pipeline]") {
    CHECK(direction("axis:-y").axis.y == -1);
    CHECK(direction("around:x").kind == Kind::Around);
    CHECK(direction("radial").kind == Kind::Radial);
    CHECK(direction("curvature").kind == Kind::Automatic);
    const DirectionSource vector = direction("1,-0.5,0");
    CHECK(vector.kind == Kind::Axis);
    CHECK(same(vector.axis, Vec3d{1, -0.5, 0}));
    DirectionSource source;
    for (const char* text : {"axis", "axis:", "axis:w", "axis:xy", "round:x", "axis:--x", "", "1,2", "0,0,0",
                             "1,2,3,4", "1,2,x", "1,,3", "nan,0,0", "1e200,0,0"})
        CHECK_FALSE(parseDirection(text, source));
}

TEST_CASE("requireDirection: every kind with what it needs", "[pipeline][error]") {
    const auto code = [](const DirectionSource& source) {
        return test::thrownBy([&] { requireDirection(source, "direction"); });
    };
    DirectionSource source;
    CHECK_NOTHROW(requireDirection(source, "direction"));
    source.kind = Kind::Grid;
    CHECK(code(source).code == int(ErrorCode::InvalidOption));
    source.kind = Kind::Strokes;
    CHECK(code(source).code == int(ErrorCode::InvalidOption));
    source.strokes = {{{0, 0, 0}, {std::nan(""), 0, 0}}};
    CHECK(code(source).message.find("`direction`") != std::string::npos);
    source.strokes = {{{0, 0, 0}, {1, 0, 0}}};
    CHECK_NOTHROW(requireDirection(source, "direction"));
    source.kind = Kind::Around;
    source.axis = {0, 0, 0};
    CHECK(code(source).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("directionReader: axes, about the middle, grids and gradients", "[pipeline]") {
    openvdb::initialize();
    const Vec3d middle{1, 2, 3}, at{3, 2, 3};
    CHECK(same(directionReader(direction("1,2,3"), middle, "direction")(at), Vec3d{1, 2, 3}));
    CHECK(same(directionReader(direction("around:z"), middle, "direction")(at), Vec3d{0, 2, 0}));
    CHECK(same(directionReader(direction("radial"), middle, "direction")(at), Vec3d{2, 0, 0}));
    DirectionSource source;
    source.kind = Kind::Grid;
    const auto vectors = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    vectors->fill(openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}), openvdb::Vec3f(0, 0, 2));
    source.grid = vectors;
    CHECK(same(directionReader(source, middle, "direction")(at), Vec3d{0, 0, 2}));
    const auto heights = openvdb::FloatGrid::create(0);
    for (int x = 0; x < 9; ++x) heights->fill(openvdb::CoordBBox({x, 0, 0}, {x, 9, 9}), 3 * float(x));
    source.grid = heights;
    CHECK(same(directionReader(source, middle, "direction")(at), Vec3d{3, 0, 0}));
    source.grid = openvdb::BoolGrid::create(false);
    const auto thrown = test::thrownBy([&] { directionReader(source, middle, "direction"); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(thrown.message.find("vectors or a float scalar are needed") != std::string::npos);
}
