#include "libvdbsynth/pipeline/patch/patch_hole.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

// An egg-crate of 80 as it would be loaded whole, its corner away from the origin.
PatchSource crateSource(PatchPlane plane) {
    const test::PointShape shape = test::eggCratePoints({}, 80, 0);
    const Vec3d corner{5, -3, 2};
    PatchSource source;
    for (std::size_t p = 0; p < shape.point.size(); ++p) {
        source.cloud.points.push_back(cast<float>(fromPlane(plane, cast<double>(shape.point[p])) + corner));
        source.cloud.normals.push_back(cast<float>(fromPlane(plane, cast<double>(shape.normal[p]))));
    }
    source.exemplar = patchExemplar(
        source.cloud.points, source.cloud.normals,
        {fromPlane(plane, {0, 0, -4}) + corner, fromPlane(plane, {80, 80, 4}) + corner}, plane, 1);
    source.isPoints = true;
    Attribute colour{"Cd", 1, {}}, old{"patch", 1, {}};
    for (std::size_t p = 0; p < shape.point.size(); ++p) colour.values.push_back(float(p % 251));
    old.values = colour.values;
    source.attributes = {colour, old};
    return source;
}

PatchBox boxOf(const PatchSource& source, const Vec3d& low, const Vec3d& high) {
    return {source.exemplar.toWorld(low), source.exemplar.toWorld(high)};
}

bool same(const Vec3f& a, const Vec3f& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

struct Said {
    std::string text;
    RunContext ctx;
    Said() {
        ctx.onMessage = [this](MessageLevel, const std::string& line) { text += line + "\n"; };
    }
};

}  // namespace

TEST_CASE("repairSheet: untouched points keep their bits and order, along any plane", "[pipeline][patch]") {
    for (const PatchPlane plane : {PatchPlane::XY, PatchPlane::YZ, PatchPlane::ZX}) {
        const PatchSource source = crateSource(plane);
        const auto hole = holeColumns(source, boxOf(source, {32, 32, -1}, {46, 44, 9}), 2);
        const RepairedSheet repaired = repairSheet(source, hole, nullptr, {});
        const PointCloud& cloud = repaired.cloud;
        const Attribute *colour = findAttribute(cloud.attributes, "Cd"),
                        *number = findAttribute(cloud.attributes, "source");
        REQUIRE(colour);
        REQUIRE(number);
        CHECK(cloud.attributes.size() == 3);
        REQUIRE(repaired.repair.kept.size() > source.cloud.points.size() / 2);
        for (std::size_t k = 0; k < repaired.repair.kept.size(); ++k) {
            const std::uint32_t from = repaired.repair.kept[k];
            REQUIRE(same(cloud.points[k], source.cloud.points[from]));
            REQUIRE(same(cloud.normals[k], source.cloud.normals[from]));
        }
        for (std::size_t p = 0; p < cloud.points.size(); ++p)
            REQUIRE(colour->values[p] == float(std::size_t(number->values[p]) % 251));
        CHECK(repaired.sheet.result.sheet.size() == cloud.points.size());
        openvdb::initialize();
        LevelSet model = sheetLevelSet(source, repaired.sheet, 1, 3);
        carryAttributes(cloud, model);
        REQUIRE(model.attributes.size() == 1);
        CHECK(model.attributes[0]->getName() == "Cd");
    }
}

TEST_CASE("repairSheet: what an exemplar lacks is said", "[pipeline][patch]") {
    const PatchSource source = crateSource(PatchPlane::XY);
    PatchSource other = source;
    other.attributes = {{"height", 1, std::vector<float>(other.exemplar.points.size(), 1.f)}};
    const auto hole = holeColumns(source, boxOf(source, {32, 32, -1}, {46, 44, 9}), 2);
    Said said;
    const RepairedSheet repaired = repairSheet(source, hole, &other, {}, said.ctx);
    CHECK_THAT(said.text, Catch::Contains("no Cd") && Catch::Contains("no height"));
    CHECK(findAttribute(repaired.cloud.attributes, "Cd")->values.size() == repaired.cloud.points.size());
    PatchSource bare = source;
    bare.cloud = {};
    CHECK_THROWS_WITH(repairSheet(bare, hole, nullptr, {}), Catch::Contains("loaded whole"));
}

TEST_CASE("holeColumns: boxes and models, what lies above them, and what is refused", "[pipeline][patch]") {
    openvdb::initialize();
    const PatchSource source = crateSource(PatchPlane::YZ);
    const auto box = holeColumns(source, boxOf(source, {32, 32, -9}, {36, 40, 20}), 2);
    CHECK(std::count(box.begin(), box.end(), 1) == 2 * 4);
    Said quiet, said;
    holeColumns(source, boxOf(source, {32, 32, -9}, {36, 40, 20}), 2, quiet.ctx);
    CHECK(quiet.text.empty());
    holeColumns(source, boxOf(source, {30, 30, -9}, {44, 44, 0}), 1, said.ctx);
    CHECK_THAT(said.text, Catch::Contains("above, below"));
    LevelSet ball;
    const Vec3d middle = source.exemplar.toWorld({40, 40, 4});
    ball.grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        6, openvdb::Vec3f(float(middle.x), float(middle.y), float(middle.z)), 0.5f);
    ball.domain = solidBox(*ball.grid, "the ball");
    const auto round = holeColumns(source, ball, 2);
    CHECK(double(std::count(round.begin(), round.end(), 1)) == Approx(28).margin(8));
    CHECK_THROWS_WITH(holeColumns(source, boxOf(source, {90, 30, -9}, {95, 44, 9}), 2),
                      Catch::Contains("outside the sheet"));
    CHECK_THROWS_WITH(holeColumns(source, boxOf(source, {30, 30, 60}, {44, 44, 90}), 2),
                      Catch::Contains("outside the sheet"));
    CHECK_THROWS_WITH(holeColumns(source, boxOf(source, {44, 30, 0}, {30, 44, 9}), 2),
                      Catch::Contains("minimum"));
    CHECK_THROWS_AS(holeColumns(source, LevelSet{}, 2), Error);
}
