#include "libvdbsynth/pipeline/texture/texture_regions.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/contexts.h"
#include "tests/support/level_sets.h"
#include "tests/support/said.h"
#include "tests/support/texture_makers.h"

using namespace vdbsynth;

namespace {

// Points 0..9 along x at 0.
TextureShape row() {
    TextureShape shape;
    shape.name = "target";
    for (int x = 0; x < 10; ++x) shape.points.push_back({float(x), 0, 0});
    makeSites(shape, {});
    return shape;
}

// A grid that is `values[x]` at x.
template <typename Grid>
typename Grid::Ptr gridOf(const std::vector<typename Grid::ValueType>& values) {
    openvdb::initialize();
    auto grid = Grid::create();
    grid->setName("part");
    for (std::size_t x = 0; x < values.size(); ++x)
        grid->tree().setValueOn(openvdb::Coord(int(x), 0, 0), values[x]);
    return grid;
}

}  // namespace

TEST_CASE("labelsOf: from an attribute, each problem in words", "[pipeline][error]") {
    Mesh mesh = test::squareMesh(2);
    mesh.attributes.push_back({"part", 1, {0, 1, 0, 1}});
    const TextureShape shape = test::shapeOf(mesh);
    CHECK(labelsOf(shape, "part", 2) == std::vector<std::int32_t>{0, 1, 0, 1});
    CHECK(test::contains(test::thrownBy([&] { labelsOf(shape, "no", 2); }).message, "it has part"));
    CHECK(test::thrownBy([&] { labelsOf(shape, "part", 1); }).code == int(ErrorCode::BadData));
    CHECK(test::thrownBy([&] { labelsOf(shape, "uv", 2); }).code == int(ErrorCode::Unusable));
}

TEST_CASE("labelsInside: the sign counts far beyond the band", "[pipeline]") {
    LevelSet ball;
    ball.grid = test::ball();  // radius 10
    TextureShape shape;
    shape.points = {{0, 0, 0}, {9, 0, 0}, {11, 0, 0}, {1000, 0, 0}};
    makeSites(shape, {});
    CHECK(labelsInside(shape, ball) == std::vector<std::int32_t>{1, 1, 0, 0});
}

TEST_CASE("labelsIn: whole numbers, truths, reals above a half, and a level set's inside", "[pipeline]") {
    const TextureShape shape = row();
    const std::vector<std::int32_t> five{0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
    const auto whole = gridOf<openvdb::Int32Grid>({0, 0, 2, 2, 1, 1, 1, 1, 2});
    CHECK(labelsIn(shape, *whole, 3) == std::vector<std::int32_t>{0, 0, 2, 2, 1, 1, 1, 1, 2, 0});
    const auto truths = gridOf<openvdb::BoolGrid>({false, 0, 0, 0, 0, true, true, true, true, true});
    CHECK(labelsIn(shape, *truths, 2) == five);
    auto mask = openvdb::MaskGrid::create();
    for (int x = 5; x < 10; ++x) mask->tree().setValueOn(openvdb::Coord(x, 0, 0));
    CHECK(labelsIn(shape, *mask, 2) == five);
    const auto reals = gridOf<openvdb::FloatGrid>({0, 0, 0, .2f, .5f, .51f, 1, 1, 2, 1});
    CHECK(labelsIn(shape, *reals, 2) == five);
    auto solid = gridOf<openvdb::FloatGrid>({3, 3, 2, 1, 0.5f, -0.5f, -1, -2, -3, -3});
    solid->setGridClass(openvdb::GRID_LEVEL_SET);
    CHECK(labelsIn(shape, *solid, 2) == five);
}

TEST_CASE("labelsIn: each problem in words", "[pipeline][error]") {
    const TextureShape shape = row();
    const auto thrown = [&](const openvdb::GridBase& grid, std::size_t samples) {
        return test::thrownBy([&] { labelsIn(shape, grid, samples); });
    };
    const auto whole = gridOf<openvdb::Int32Grid>({0, 0, 2, -1});
    CHECK(thrown(*whole, 2).code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown(*whole, 2).message, "at 2,0,0 has the value 2; labels are 0 to 1"));
    CHECK(test::contains(thrown(*whole, 3).message, "has the value -1"));
    CHECK(thrown(*gridOf<openvdb::BoolGrid>({true}), 3).code == int(ErrorCode::InvalidOption));
    CHECK(thrown(*openvdb::Vec3SGrid::create(), 2).code == int(ErrorCode::BadData));
}

TEST_CASE("labelsByShape: says what the images take, and where nothing bounds them", "[pipeline]") {
    std::vector<std::string> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said.push_back(text); };
    const TextureShape ball = test::shapeOf(test::sphereMesh(1, 4));
    const std::vector<std::int32_t> labels = labelsByShape(ball, 2, ctx);
    CHECK(labels.size() == ball.site.size());
    REQUIRE(said.size() == 2);
    CHECK(test::contains(said[0], "by shape the images take"));
    CHECK(test::contains(said[1], "bound 1 region for 2 images; the largest ones are halved"));
    TextureShape two = ball;
    for (const Vec3f& p : ball.points) two.points.push_back(p * 0.5f + Vec3f{5, 0, 0});
    two.triangles.clear();
    std::vector<Vec3f> normals;
    for (const Vec3f& p : ball.points) normals.push_back(p);
    for (const Vec3f& p : ball.points) normals.push_back(p);
    makeSites(two, normals);
    said.clear();
    const std::vector<std::int32_t> apart = labelsByShape(two, 2, ctx);
    CHECK(said.size() == 1);
    for (std::size_t i = 0; i < two.site.size(); ++i) REQUIRE(apart[i] == (two.site[i].x > 2));
    said.clear();
    labelsByShape(two, 1, ctx);
    CHECK(test::contains(said.back(), "those of similar size share one"));
}
