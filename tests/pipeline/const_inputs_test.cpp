// No function of the pipeline changes what it is given.
#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/analogy/filter_analogy.h"
#include "libvdbsynth/pipeline/compare/compare.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/crop/crop.h"
#include "libvdbsynth/pipeline/fill/fill.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/match/match.h"
#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/vdb/control_grids.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// Of everything that a grid has: name, class and other metadata, transform, topology, values.
std::string printOf(const openvdb::GridBase& grid) {
    std::ostringstream text(std::ios::binary);
    grid.writeMeta(text);
    grid.writeTransform(text);
    grid.writeTopology(text);
    grid.writeBuffers(text);
    const std::string bytes = text.str();
    return contentHash(bytes.data(), bytes.size());
}

// Watches grids, and says the names of those that have changed.
class Watch {
public:
    explicit Watch(const std::vector<GridConstPtr>& grids) {
        for (const GridConstPtr& grid : grids) mGrids.push_back({grid, grid->getName(), printOf(*grid)});
    }
    void add(const LevelSet& model) {
        mGrids.push_back({model.grid, model.grid->getName(), printOf(*model.grid)});
        for (const GridPtr& grid : model.attributes)
            mGrids.push_back({grid, grid->getName(), printOf(*grid)});
    }
    std::string changed() const {
        std::string names;
        for (const Entry& entry : mGrids)
            if (printOf(*entry.grid) != entry.print) names += entry.name + " ";
        return names;
    }

private:
    struct Entry {
        GridConstPtr grid;
        std::string name, print;
    };
    std::vector<Entry> mGrids;
};

openvdb::FloatGrid::Ptr sphere(const std::string& name, float radius = 10) {
    openvdb::initialize();
    auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, openvdb::Vec3f(0), 1.f, 4.f);
    grid->setName(name);
    grid->insertMeta("shot", openvdb::StringMetadata("017"));
    grid->setSaveFloatAsHalf(true);
    return grid;
}

openvdb::FloatGrid::Ptr fogOf(const std::string& name, bool cubes) {
    auto fog = sphere(name);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (auto it = fog->beginValueAll(); it; ++it) it.setValue(std::max(0.f, 4.f - *it));
    fog->tree().root().setBackground(0, true);
    if (!cubes) fog->transform().preScale(openvdb::Vec3d(1, 1, 1.5));
    return fog;
}

LevelSet made(const char* kind, int resolution) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    LevelSet model = makeModel(options);
    auto density = openvdb::FloatGrid::create(0);
    density->setName("density");
    density->setTransform(model.grid->transform().copy());
    for (auto it = model.grid->cbeginValueOn(); it; ++it) density->tree().setValueOn(it.getCoord(), 2.f);
    model.attributes = {density};
    return model;
}

}  // namespace

TEST_CASE("modelFromGrids: the caller's grids keep name, metadata, transform and values",
          "[pipeline][property]") {
    VdbReadOptions iso;
    iso.iso = 2;
    for (const auto& [grid, options] : std::vector<std::pair<openvdb::FloatGrid::Ptr, VdbReadOptions>>{
             {sphere("mine"), {}}, {fogOf("fog", true), iso}, {fogOf("flat fog", false), iso}}) {
        const Watch watch({grid});
        const LevelSet model = modelFromGrids("shot.vdb", {grid}, options);
        CHECK(model.grid->getName() == "surface");
        CHECK(solidVoxels(*model.grid) > 1000);
        CHECK(watch.changed().empty());
    }
}

TEST_CASE("synthesize: inputs and controls stay as they are", "[pipeline][property]") {
    const LevelSet balls = made("balls", 32), grid = made("grid", 32);
    SynthOptions options;
    options.size = TargetSize::multiples(1.5, 1, 1);
    options.exemplarMask = boxMask(balls.domain, 1);
    options.exemplarMap = asControl(grid.grid);
    options.guide = balls.attributes.front();
    options.exemplarGuides = {balls.attributes.front(), balls.grid};
    options.carried = AttributeValues::Blended;
    Watch watch({options.exemplarMask});
    watch.add(balls);
    watch.add(grid);
    const SynthResult result = synthesize({&balls, &grid}, options);
    CHECK(watch.changed().empty());
    repeatMap(result.map, {&balls, &grid});
    CHECK(watch.changed().empty());
}

TEST_CASE("matchModel, cropModel, withHalfWidth, compareModels, writeModel: inputs stay as they are",
          "[pipeline][property]") {
    const LevelSet model = made("sponge", 40);
    Watch watch({});
    watch.add(model);
    MatchOptions match;
    match.block = 8;
    match.mask = model.attributes.front();
    match.at = {10, 10, 10};
    matchModel(model, model, match);
    CHECK(watch.changed().empty());
    cropModel(model, {{5, 5, 5}, {30, 30, 30}});
    withHalfWidth(model, 3);
    withHalfWidth(model, 5);
    resampled(model, 1.5);
    CHECK(watch.changed().empty());
    compareModels({"a", model, {}}, {{"b", model, {}}});
    CHECK(watch.changed().empty());
    const test::TemporaryFolder folder;
    OutputSet outputs;
    writeModel(model, {folder.path("a.vdb"), folder.path("a.obj")}, {}, outputs);
    CHECK(watch.changed().empty());
}

TEST_CASE("makeAnalogyModel: pairs, target, mask and directions stay as they are", "[pipeline][property]") {
    openvdb::initialize();
    MakeOptions make;
    make.exemplar.kind = "dilation";
    make.exemplar.resolution = 48;
    const ModelPair pair = makePair(make);
    const LevelSet target = made("three-tori", 48);
    AnalogyOptions options;
    options.mask = target.attributes.front();
    options.direction.kind = DirectionSource::Kind::Grid;
    auto up = openvdb::Vec3SGrid::create(openvdb::Vec3f(0.2f, 0.1f, 1));
    options.direction.grid = up;
    options.keepDirections = true;
    Watch watch({up});
    watch.add(pair.plain);
    watch.add(pair.textured);
    watch.add(target);
    const AnalogyResult result = makeAnalogyModel({{&pair.plain, &pair.textured}}, target, options);
    CHECK(watch.changed().empty());
    PreviewOptions picture;
    picture.width = picture.height = 32;
    picture.directions = result.directions;
    const Watch drawn({result.directions});
    renderPreview(*target.grid, picture);
    CHECK(drawn.changed().empty());
    CHECK(watch.changed().empty());
}

TEST_CASE("fillHoles: the partial model, the hole and the exemplar stay as they are",
          "[pipeline][property]") {
    const LevelSet model = made("grid", 48);
    const LevelSet hole = boxHole(model, {{18, 18, 18}, {26, 26, 26}});
    Watch watch({});
    watch.add(model);
    watch.add(hole);
    const FillResult result = fillHoles(model, hole, nullptr);
    CHECK(result.model.attributes.size() == 1);
    CHECK(watch.changed().empty());
}

TEST_CASE("makeFilteredGrid: scalar grids stay as they are", "[pipeline][property]") {
    const auto before = fogOf("before", true), after = fogOf("after", true), target = fogOf("target", true);
    for (auto it = after->beginValueOn(); it; ++it) it.setValue(*it * 2);
    const Watch watch({before, after, target});
    const FilterGridResult result = makeFilteredGrid({{before, after}}, target, {});
    CHECK(result.grid->activeVoxelCount() > 1000);
    CHECK(watch.changed().empty());
}
