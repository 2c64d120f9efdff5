#include "libvdbsynth/pipeline/repeat/repeat.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/crop/crop.h"
#include "libvdbsynth/pipeline/fill/fill.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/made_models.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;
using test::made;
using test::sized;

namespace {

// Through a file of either kind of grids and back.
LevelSet again(const SourceMap& map, const LevelSet& result, const std::vector<const LevelSet*>& inputs,
               MapTypes types = MapTypes::Integer, const RunContext& ctx = {}) {
    const test::TemporaryFolder folder;
    writeVdb(folder.path("m.vdb"), sourceMapGrids(map, *result.grid, {}, types), {});
    return repeatMap(readSourceMap(folder.path("m.vdb")), inputs, {}, ctx);
}

ModelPair pairOf(const char* kind) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = 64;
    return makePair(options);
}

AnalogyResult applied(const ModelPair& pair, const LevelSet& target, AnalogyOptions options = {}) {
    parseDirection("around:z", options.direction);
    return makeAnalogyModel({{&pair.plain, &pair.textured}}, target, options);
}

// A model with its surface moved outwards.
LevelSet offset(const LevelSet& model, float voxels) {
    const openvdb::FloatGrid::Ptr field = model.grid->deepCopy();
    for (auto it = field->beginValueOn(); it; ++it) it.setValue(*it - voxels * float(voxelSizeOf(*field)));
    LevelSet moved = model;
    moved.grid = rebuildLevelSet(*field, kHalfWidth, "moved");
    stampLevelSet(moved);
    return moved;
}

LevelSet atHalfTheVoxels(const LevelSet& model) {
    const double voxel = voxelSizeOf(*model.grid) / 2;
    LevelSet fine = model;
    fine.grid = meshToLevelSet(levelSetToMesh(*model.grid), voxel, 3, "fine");
    fine.domain = {model.domain.min * 2, model.domain.max * 2 + Index3{1, 1, 1}};
    stampLevelSet(fine);
    return fine;
}

// A texture with a box cut out, and the box.
struct Holed {
    LevelSet partial, hole;
};
Holed holed() {
    Holed holed;
    holed.partial = made("sponge", 64);
    const IndexBox box{{22, 22, 22}, {41, 41, 41}};
    const openvdb::FloatGrid::Ptr cut = holed.partial.grid->deepCopy();
    for (int x = box.min.x; x <= box.max.x; ++x)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int z = box.min.z; z <= box.max.z; ++z) cut->tree().setValueOn({x, y, z}, 3.f);
    holed.partial.grid = rebuildLevelSet(*cut, kHalfWidth, "cut");
    stampLevelSet(holed.partial);
    auto place = openvdb::FloatGrid::create(0.f);
    place->setName("place");
    for (auto it = holed.partial.grid->cbeginValueOn(); it; ++it)
        place->tree().setValueOn(it.getCoord(), float(it.getCoord().x()));
    holed.partial.attributes = {place};
    holed.hole = boxHole(holed.partial, box);
    return holed;
}

}  // namespace

TEST_CASE("repeatMap: the run's own exemplar gives the result back bit for bit, through a file",
          "[pipeline][property]") {
    const test::TemporaryFolder folder;
    const LevelSet exemplar = made("balls");
    for (bool draft : {false, true}) {
        SynthOptions options = sized(2, 1.7, 1);
        options.draft = draft;
        const SynthResult result = synthesize(exemplar, options);
        std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
        CHECK(grids.size() == 4);
        grids.push_back(result.model.grid);
        writeVdb(folder.path("m.vdb"), grids, {});
        const LevelSet again = repeatMap(readSourceMap(folder.path("m.vdb")), {&exemplar});
        CHECK(levelSetHash(*again.grid) == levelSetHash(*result.model.grid));
        CHECK(again.domain == result.model.domain);
    }
}

TEST_CASE("repeatMap: a finer exemplar gives the matching finer result", "[pipeline][property]") {
    const LevelSet exemplar = made("grid", 40, 16, 1);
    const SynthResult result = synthesize(exemplar, sized(2, 1, 1));
    openvdb::FloatGrid::Ptr fine = meshToLevelSet(levelSetToMesh(*exemplar.grid), 0.5, 3, "fine");
    LevelSet finer{fine, {}, false};
    finer.domain = solidBox(*fine, "fine");
    const LevelSet again = repeatMap(result.map, {&finer});
    CHECK(voxelSizeOf(*again.grid) == Approx(0.5));
    CHECK(solidVoxels(*again.grid) / 8 == Approx(solidVoxels(*result.model.grid)).epsilon(0.05));
    const LevelSet coarse = made("grid", 40, 16, 3);
    CHECK(test::thrownBy([&] { repeatMap(result.map, {&coarse}); }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("repeatMap: a map of floats gives the same back as one of whole numbers", "[pipeline][property]") {
    const LevelSet balls = made("balls"), grid = made("grid", 44);
    SynthOptions options = sized(2, 1, 1);
    auto exemplars = openvdb::FloatGrid::create(0.f);
    exemplars->fill({openvdb::Coord(0, 0, 0), openvdb::Coord(39, 59, 43)}, 1.f);
    options.exemplarMap = exemplars;
    const SynthResult result = synthesize({&balls, &grid}, options);
    for (MapTypes types : {MapTypes::Integer, MapTypes::Float})
        CHECK(levelSetHash(*again(result.map, result.model, {&balls, &grid}, types).grid) ==
              levelSetHash(*result.model.grid));
}

TEST_CASE("repeatMap: a filled hole is filled again bit for bit, with its attributes",
          "[pipeline][property]") {
    const Holed model = holed();
    const LevelSet other = made("sponge", 48, 0, 1, 5);
    for (const LevelSet* exemplar : {static_cast<const LevelSet*>(nullptr), &other}) {
        INFO((exemplar ? "from an exemplar" : "from itself"));
        const FillResult result = fillHoles(model.partial, model.hole, exemplar);
        std::vector<const LevelSet*> inputs{&model.partial};
        if (exemplar) inputs.insert(inputs.begin(), exemplar);
        const LevelSet repeated = again(result.map, result.model, inputs);
        CHECK(levelSetHash(*repeated.grid) == levelSetHash(*result.model.grid));
        CHECK(repeated.domain == result.model.domain);
        REQUIRE(repeated.attributes.size() == result.model.attributes.size());
        REQUIRE(repeated.attributes.size() == 1);
        CHECK(levelSetHash(*openvdb::gridPtrCast<openvdb::FloatGrid>(repeated.attributes[0])) ==
              levelSetHash(*openvdb::gridPtrCast<openvdb::FloatGrid>(result.model.attributes[0])));
        // An exemplar that is not its own is an input.
        inputs.push_back(&model.partial);
        CHECK(test::thrownBy([&] { repeatMap(result.map, inputs); }).code == int(ErrorCode::ShapeMismatch));
    }
}

TEST_CASE("repeatMap: an analogy's own models give it back bit for bit", "[pipeline][property]") {
    const LevelSet target = made("three-tori", 72);
    ModelPair pair = pairOf("grooves");
    auto heat = openvdb::FloatGrid::create(0.f);
    heat->setName("heat");
    heat->setTransform(pair.textured.grid->transform().copy());
    for (auto it = pair.textured.grid->cbeginValueOn(); it; ++it)
        heat->tree().setValueOn(it.getCoord(), float(it.getCoord().z()));
    pair.textured.attributes = {heat};
    AnalogyOptions masked;
    masked.scale = 1.25;
    masked.strength = 0.75;
    auto ramp = openvdb::FloatGrid::create(0.f);
    ramp->setTransform(target.grid->transform().copy());
    ramp->fill({openvdb::Coord(0, 0, 0), openvdb::Coord(200, 200, 200)}, 0.5f);
    masked.mask = ramp;
    for (const AnalogyOptions& options : {AnalogyOptions{}, masked}) {
        INFO(options.scale);
        const AnalogyResult result = applied(pair, target, options);
        for (MapTypes types : {MapTypes::Integer, MapTypes::Float}) {
            RunContext one;
            one.threads = 1;
            const LevelSet repeated = again(result.map, result.model, {&pair.textured, &target}, types, one);
            CHECK(levelSetHash(*repeated.grid) == levelSetHash(*result.model.grid));
            REQUIRE(repeated.attributes.size() == 1);
            CHECK(levelSetHash(*openvdb::gridPtrCast<openvdb::FloatGrid>(repeated.attributes[0])) ==
                  levelSetHash(*openvdb::gridPtrCast<openvdb::FloatGrid>(result.model.attributes[0])));
        }
    }
}

TEST_CASE("repeatMap: another textured model gives an analogy's arrangement another look",
          "[pipeline][property]") {
    const LevelSet target = made("three-tori", 72);
    const ModelPair pair = pairOf("grooves");
    const AnalogyResult result = applied(pair, target);
    std::vector<std::string> told;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level != MessageLevel::Detail) told.push_back(text);
    };
    const LevelSet thicker = offset(pair.textured, 0.8f);
    const LevelSet repeated = repeatMap(result.map, {&thicker, &target}, {}, ctx);
    REQUIRE(told.size() == 1);
    CHECK(test::contains(told[0], "is not the one that the map was made with"));
    // The same as the first result with its surface moved as far.
    const double moved = solidVoxels(*offset(result.model, 0.8f).grid);
    CHECK(solidVoxels(*repeated.grid) == Approx(moved).epsilon(0.02));
    CHECK(solidVoxels(*repeated.grid) > 1.05 * solidVoxels(*result.model.grid));
    told.clear();
    // By what its band holds each time: three voxels.
    const LevelSet thickest = offset(offset(pair.textured, 9), 9);
    repeatMap(result.map, {&thickest, &target}, {}, ctx);
    REQUIRE(told.size() == 2);
    CHECK(test::contains(told[1], "is cut off where"));
}

TEST_CASE("repeatMap: finer models give an analogy's matching finer result", "[pipeline][property]") {
    const LevelSet target = made("three-tori", 60);
    ModelPair pair = pairOf("grooves");
    const AnalogyResult result = applied(pair, target);
    LevelSet texture = atHalfTheVoxels(pair.textured), plain = atHalfTheVoxels(target);
    auto place = openvdb::FloatGrid::create(0.f);
    place->setName("place");
    place->setTransform(texture.grid->transform().copy());
    for (auto it = texture.grid->cbeginValueOn(); it; ++it)
        place->tree().setValueOn(it.getCoord(), float(it.getCoord().z()));
    texture.attributes = {place};
    const LevelSet repeated = repeatMap(result.map, {&texture, &plain});
    CHECK(voxelSizeOf(*repeated.grid) == Approx(voxelSizeOf(*target.grid) / 2));
    CHECK(solidVoxels(*repeated.grid) / 8 == Approx(solidVoxels(*result.model.grid)).epsilon(0.02));
    // No rougher than what it is finer than.
    CHECK(measureBand(*repeated.grid).gradientErrorMean <
          measureBand(*result.model.grid).gradientErrorMean + 0.01);
    REQUIRE(repeated.attributes.size() == 1);
    CHECK(openvdb::gridPtrCast<openvdb::FloatGrid>(repeated.attributes[0])->activeVoxelCount() >
          repeated.grid->activeVoxelCount() / 2);
    CHECK(test::contains(test::thrownBy([&] {
                             repeatMap(result.map, {&texture, &target});
                         }).message,
                         "must be finer"));
}

TEST_CASE("repeatMap: every refusal says what to do", "[pipeline][error][cancel]") {
    const LevelSet exemplar = made("balls");
    const SynthResult result = synthesize(exemplar, sized(2, 1, 1));
    const auto thrown = [&](const std::vector<const LevelSet*>& inputs, const RepeatOptions& options = {},
                            const RunContext& ctx = {}) {
        return test::thrownBy([&] { repeatMap(result.map, inputs, options, ctx); });
    };
    CHECK(test::contains(thrown({&exemplar, &exemplar}).message, "made with 1 exemplars"));
    RepeatOptions options;
    options.halfWidth = 1;
    CHECK(thrown({&exemplar}, options).code == int(ErrorCode::InvalidOption));
    options.halfWidth = 4;
    CHECK(halfWidthOf(*repeatMap(result.map, {&exemplar}, options).grid) == Approx(4));
    LevelSet elsewhere = exemplar;
    elsewhere.grid = openvdb::FloatGrid::create(3.f);
    elsewhere.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    elsewhere.grid->tree().setValueOn({500, 500, 500}, -1.f);
    CHECK(test::contains(thrown({&elsewhere}).message, "no surface in the map's box"));
    RunContext small, stopped;
    small.maxMemory = 1000;
    CHECK(thrown({&exemplar}, {}, small).code == int(ErrorCode::Memory));
    const std::atomic<bool> stop{true};
    stopped.cancel = &stop;
    CHECK(thrown({&exemplar}, {}, stopped).code == int(ErrorCode::Cancelled));
    const Holed model = holed();
    const FillResult filled = fillHoles(model.partial, model.hole, nullptr);
    const LevelSet finer = atHalfTheVoxels(model.partial);
    CHECK(test::contains(test::thrownBy([&] { repeatMap(filled.map, {&finer}); }).message,
                         "at the map's resolution only"));
    options = {};
    options.carried = AttributeValues::Blended;
    CHECK(test::thrownBy([&] { repeatMap(filled.map, {&model.partial}, options); }).code ==
          int(ErrorCode::InvalidOption));
}
