#include "libvdbsynth/vdb/level_set.h"

#include <catch2/catch.hpp>

#include <openvdb/tools/LevelSetSphere.h>

#include <atomic>
#include <functional>
#include <limits>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/comma_locale.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

FloatGridPtr ball() {
    return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.f, openvdb::Vec3f(0.f), 1.f, 3.f);
}

std::string hashAfter(const std::function<void(openvdb::FloatGrid&)>& change) {
    const FloatGridPtr grid = ball();
    change(*grid);
    return levelSetHash(*grid);
}

LevelSet ballModel() {
    LevelSet model;
    model.grid = ball();
    model.domain = {{-6, -6, -6}, {6, 6, 6}};
    return model;
}

// What requireModel throws of a ball that was changed.
test::Thrown refusal(const std::function<void(LevelSet&)>& change) {
    LevelSet model = ballModel();
    change(model);
    return test::thrownBy([&] { requireModel(&model, "the ball"); });
}

}  // namespace

TEST_CASE("requireModel: a ball in rotated, mirrored and moved voxels is one", "[vdb][property]") {
    CHECK(refusal([](LevelSet&) {}).code == -1);
    CHECK(refusal([](LevelSet& m) { m.grid->transform().postRotate(0.3, openvdb::math::X_AXIS); }).code ==
          -1);
    CHECK(refusal([](LevelSet& m) { m.grid->transform().postScale(openvdb::Vec3d(-1, 1, 1)); }).code == -1);
    CHECK(refusal([](LevelSet& m) { m.grid->transform().postTranslate(openvdb::Vec3d(1e6, 0, 0)); }).code ==
          -1);
    CHECK(refusal([](LevelSet& m) { m.grid->setGridClass(openvdb::GRID_UNKNOWN); }).code == -1);
    CHECK(refusal([](LevelSet& m) { m.domain = {{-(1 << 28), 0, 0}, {1 << 28, 0, 0}}; }).code == -1);
}

TEST_CASE("requireModel: what is no level set is refused, the reason named", "[vdb][error]") {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    struct Case {
        const char* named;
        ErrorCode code;
        std::function<void(LevelSet&)> change;
    };
    const Case cases[] = {
        {"`grid`", ErrorCode::InvalidOption, [](LevelSet& m) { m.grid = nullptr; }},
        {"`attributes`", ErrorCode::InvalidOption, [](LevelSet& m) { m.attributes = {nullptr}; }},
        {"`domain`", ErrorCode::InvalidOption, [](LevelSet& m) { m.domain = IndexBox(); }},
        {"`domain`", ErrorCode::InvalidOption, [](LevelSet& m) { m.domain.max.y = (1 << 28) + 1; }},
        {"`domain`", ErrorCode::InvalidOption, [](LevelSet& m) { m.domain.min.z = -(1 << 28) - 1; }},
        {"not a level set", ErrorCode::Unusable,
         [](LevelSet& m) { m.grid->setGridClass(openvdb::GRID_FOG_VOLUME); }},
        {"not a level set", ErrorCode::Unusable,
         [](LevelSet& m) { m.grid->tree().root().setBackground(-3.f, false); }},
        {"not cubes", ErrorCode::Unusable,
         [](LevelSet& m) { m.grid->transform().preScale(openvdb::Vec3d(1, 1, 1.001)); }},
        {"not cubes", ErrorCode::Unusable,
         [](LevelSet& m) {
             m.grid->transform().preShear(0.1, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
         }},
        {"under 1.5", ErrorCode::Unusable, [](LevelSet& m) { m.grid->transform().preScale(2.1); }},
        {"no active voxels", ErrorCode::EmptyInput, [](LevelSet& m) { m.grid->clear(); }},
        {"NaN", ErrorCode::BadData,
         [&](LevelSet& m) {
             m.grid->tree().setValue({6, 0, 0}, nan);
         }},
        {"NaN", ErrorCode::BadData,
         [&](LevelSet& m) {
             m.grid->tree().setValueOff({6, 7, 7}, infinite);
         }},
        {"NaN", ErrorCode::BadData,
         [&](LevelSet& m) {
             m.grid->tree().addTile(1, {64, 0, 0}, -infinite, false);
         }},
        {"NaN", ErrorCode::BadData,
         [&](LevelSet& m) { m.grid->tree().root().setBackground(infinite, false); }},
    };
    for (const Case& each : cases) {
        const test::Thrown thrown = refusal(each.change);
        INFO(each.named << " | " << thrown.message);
        CHECK(thrown.code == int(each.code));
        CHECK(thrown.message.find("the ball: ") == 0);
        CHECK(test::contains(thrown.message, each.named));
    }
    const test::Thrown null = test::thrownBy([] { requireModel(nullptr, "the exemplar"); });
    CHECK(null.code == int(ErrorCode::InvalidOption));
    CHECK(null.message.find("the exemplar") == 0);
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    const LevelSet model = ballModel();
    CHECK(test::thrownBy([&] { requireModel(&model, "m", ctx); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("requireBox, requireHalfWidth: the field is named, ends of the range are in it", "[vdb][error]") {
    const auto box = [](const IndexBox& b) { return test::thrownBy([&] { requireBox(b, "holeBox"); }); };
    CHECK(box({{-(1 << 28), 0, 0}, {0, 0, 1 << 28}}).code == -1);
    for (const IndexBox& bad :
         {IndexBox(), IndexBox{{0, 0, 0}, {3, -1, 3}}, IndexBox{{0, 0, 0}, {0, (1 << 28) + 1, 0}},
          IndexBox{{std::numeric_limits<int>::min(), 0, 0}, {0, 0, 0}}}) {
        CHECK(box(bad).code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(box(bad).message, "`holeBox`"));
    }
    const auto width = [](double w) { return test::thrownBy([&] { requireHalfWidth(w, "band"); }); };
    for (double good : {1.5, 3.0, 100.0}) CHECK(width(good).code == -1);
    for (double bad : {1.49, 100.1, -3.0, std::nan("")}) {
        CHECK(width(bad).code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(width(bad).message, "`band`"));
    }
}

TEST_CASE("levelSetHash: the same grid has the same hash, whatever its name and metadata",
          "[vdb][property]") {
    const std::string hash = levelSetHash(*ball());
    CHECK(hash.size() == 32);
    CHECK(levelSetHash(*ball()) == hash);
    CHECK(levelSetHash(*ball()->deepCopy()) == hash);
    CHECK(hashAfter([](auto& grid) {
              grid.setName("other");
              grid.insertMeta("note", openvdb::StringMetadata("x"));
          }) == hash);
    // A leaf that holds nothing but background.
    CHECK(hashAfter([](auto& grid) {
              grid.tree().touchLeaf(openvdb::Coord(400, 0, 0));
              grid.tree().prune();
          }) == hash);
}

TEST_CASE("levelSetHash: a value, an active state, a tile, the background or the transform change it",
          "[vdb][property]") {
    const std::string hash = levelSetHash(*ball());
    const openvdb::Coord on(6, 0, 0), off(0, 0, 0);
    const std::pair<const char*, std::function<void(openvdb::FloatGrid&)>> changes[] = {
        {"value", [&](auto& grid) { grid.tree().setValue(on, 0.125f); }},
        {"value of an inactive voxel",
         [&](auto& grid) { grid.tree().setValueOff(openvdb::Coord(1, 1, 1), -1.f); }},
        {"topology", [&](auto& grid) { grid.tree().setActiveState(on, false); }},
        {"topology of a leaf", [&](auto& grid) { grid.tree().setActiveState(off, true); }},
        {"tile", [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 0, 0), -3.f, false); }},
        {"active tile", [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 0, 0), 3.f, true); }},
        {"place of a tile",
         [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 8, 0), -3.f, false); }},
        {"value of a tile",
         [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 0, 0), -2.f, false); }},
        {"background", [&](auto& grid) { grid.tree().root().setBackground(4.f, false); }},
        {"voxel size",
         [&](auto& grid) { grid.setTransform(openvdb::math::Transform::createLinearTransform(0.5)); }},
        {"place in the world",
         [&](auto& grid) { grid.transform().postTranslate(openvdb::Vec3d(0, 0, 1e-9)); }},
    };
    std::vector<std::string> seen{hash};
    for (const auto& [what, change] : changes) {
        CAPTURE(what);
        const std::string changed = hashAfter(change);
        CHECK(std::find(seen.begin(), seen.end(), changed) == seen.end());
        seen.push_back(changed);
    }
}

TEST_CASE("boxText, parseBox: a box comes back, in a host with a decimal comma too", "[vdb][property]") {
    const IndexBox box{{-1234567, 0, 5}, {1234567, 268435456, 5}};
    const auto check = [&] {
        CHECK(boxText(box) == "-1234567,0,5,1234567,268435456,5");
        IndexBox back;
        CHECK(parseBox(boxText(box), back));
        CHECK(back == box);
    };
    check();
    const test::CommaLocale host;
    check();
}

TEST_CASE("parseBox: what is not six numbers in order is refused and changes nothing", "[vdb][error]") {
    IndexBox box{{1, 2, 3}, {4, 5, 6}};
    for (const char* text : {"", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,6,", "1,2,3,4,5,6 ", " 1,2,3,4,5,6",
                             "1,2,3,0,5,6", "1,2,3,4,5,4294967302", "1,2,3,4,5,268435457",
                             "-268435457,2,3,4,5,6", "1,2,,4,5,6", "1.0,2,3,4,5,6"}) {
        CAPTURE(text);
        CHECK_FALSE(parseBox(text, box));
        CHECK(box == IndexBox{{1, 2, 3}, {4, 5, 6}});
    }
}

TEST_CASE("solidBox, solidVoxels: by hand, of voxels and of tiles", "[vdb][oracle][error]") {
    const auto grid = openvdb::FloatGrid::create(3.f);
    CHECK(solidVoxels(*grid) == 0);
    const test::Thrown none = test::thrownBy([&] { solidBox(*grid, "the hole"); });
    CHECK(none.code == int(ErrorCode::EmptyInput));
    CHECK(none.message.find("the hole: has no inside") == 0);
    grid->tree().setValueOn({-3, 2, 5}, -1.f);
    grid->tree().setValueOff({4, 2, 5}, -0.5f);
    grid->tree().setValueOn({9, 9, 9}, 1.f);
    CHECK(solidBox(*grid, "m") == IndexBox{{-3, 2, 5}, {4, 2, 5}});
    CHECK(solidVoxels(*grid) == 2);
    grid->tree().addTile(1, {64, 0, 0}, -3.f, false);
    CHECK(solidBox(*grid, "m") == IndexBox{{-3, 0, 0}, {71, 7, 7}});
    CHECK(solidVoxels(*grid) == 2 + 512);
}

TEST_CASE("measureBand: slope, missing neighbours and values that are not finite, by hand", "[vdb][oracle]") {
    // Planes across z at 7.5: four layers, each 10 x 10, those at the sides without neighbours.
    const auto planes = [](float slope, float voxel) {
        const BrickField field = test::fieldFrom({10, 10, 16}, [&](const Index3& p) {
            return std::clamp(slope * (float(p.z) - 7.5f), -3.f, 3.f);
        });
        const FloatGridPtr grid = scatterBricks(field, {0, 0, 0}, voxel, 3.f);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(double(voxel)));
        return grid;
    };
    for (float voxel : {1.f, 0.25f}) {
        const BandQuality flat = measureBand(*planes(1, voxel));
        CHECK(flat.measured == 8 * 8 * 2);
        CHECK(flat.missingNeighbours == 10 * 10 * 2 - flat.measured);
        CHECK(flat.gradientErrorMean == Approx(0).margin(1e-5));
        CHECK(flat.finite);
        const BandQuality steep = measureBand(*planes(1.25f, voxel));
        CHECK(steep.gradientErrorMean == Approx(0.25).margin(1e-4));
        CHECK(steep.gradientErrorP99 == Approx(0.25).margin(1e-4));
    }
    const FloatGridPtr bad = planes(1, 1);
    bad->tree().setValueOn({5, 5, 9}, std::numeric_limits<float>::infinity());
    CHECK_FALSE(measureBand(*bad).finite);
    const BandQuality none = measureBand(*openvdb::FloatGrid::create(3.f));
    CHECK((none.measured == 0 && none.gradientErrorMean == 0 && none.finite));
}

TEST_CASE("measureBand: on the ridge in a thin wall a true distance is one", "[vdb][property]") {
    const BrickField field = test::fieldFrom(
        {20, 20, 20}, [](const Index3& p) { return std::min(std::abs(float(p.z) - 10.f) - 0.75f, 3.f); });
    CHECK(measureBand(*scatterBricks(field, {0, 0, 0}, 1.f, 3.f)).gradientErrorMean ==
          Approx(0).margin(1e-5));
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    CHECK(measureBand(*ball(), one).gradientErrorMean == measureBand(*ball(), four).gradientErrorMean);
}

TEST_CASE("rangeOf: of active voxels and tiles, finite only if all values are", "[vdb][oracle]") {
    const auto grid = openvdb::FloatGrid::create(3.f);
    CHECK((rangeOf(*grid).minimum == 0 && rangeOf(*grid).maximum == 0));
    grid->tree().setValueOn({0, 0, 0}, 2.f);
    grid->tree().setValueOff({1, 0, 0}, 50.f);
    grid->tree().addTile(1, {64, 0, 0}, -4.f, true);
    const ValueRange range = rangeOf(*grid);
    CHECK((range.minimum == -4 && range.maximum == 2 && range.finite));
    grid->tree().setValueOff({1, 0, 0}, std::numeric_limits<float>::quiet_NaN());
    CHECK_FALSE(rangeOf(*grid).finite);
    CHECK(rangeOf(*grid).maximum == 2);
}

TEST_CASE("stampLevelSet, inIndexSpace, asFloat: metadata, a shared tree, kinds of grid", "[vdb][oracle]") {
    LevelSet model = ballModel();
    model.domainRecorded = true;
    model.grid->setName("other");
    stampLevelSet(model);
    CHECK(model.grid->getName() == kSurfaceName);
    CHECK(model.grid->getGridClass() == openvdb::GRID_LEVEL_SET);
    CHECK(model.grid->metaValue<std::string>(kDomainKey) == "-6,-6,-6,6,6,6");
    model.domainRecorded = false;
    stampLevelSet(model);
    CHECK_FALSE((*model.grid)[kDomainKey]);
    model.grid->transform().preScale(0.5);
    model.grid->transform().postTranslate(openvdb::Vec3d(1, 2, 3));
    CHECK(voxelSizeOf(*model.grid) == 0.5);
    CHECK(halfWidthOf(*model.grid) == 6);
    const Vec3d moved = transformed(transformOf(*model.grid), {2, 4, 6});
    CHECK((moved.x == 2 && moved.y == 4 && moved.z == 6));
    const FloatGridPtr plain = inIndexSpace(*model.grid);
    CHECK(plain->treePtr() == model.grid->treePtr());
    CHECK(transformOf(*plain) == kIdentity);
    CHECK(activeVoxels(*plain) == activeVoxels(*model.grid));
    CHECK(asFloat(model.grid) == model.grid);
    const auto doubles = openvdb::DoubleGrid::create(2.5);
    doubles->setName("d");
    doubles->tree().setValueOn({1, 2, 3}, 0.75);
    const FloatGridPtr floats = asFloat(doubles);
    CHECK((floats->getName() == "d" && floats->background() == 2.5f));
    CHECK(floats->tree().getValue({1, 2, 3}) == 0.75f);
    CHECK(asFloat(openvdb::Int32Grid::create()) == nullptr);
}
