#include "libvdbsynth/pipeline/convert/model_unit.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("unitOf, setUnit: recorded, removed, nothing but letters", "[pipeline][oracle]") {
    const auto grid = openvdb::FloatGrid::create(1.f);
    CHECK(unitOf(*grid).empty());
    setUnit(*grid, "um");
    CHECK(unitOf(*grid) == "um");
    setUnit(*grid, "");
    CHECK_FALSE(grid->getMetadata<openvdb::StringMetadata>(kUnitKey));
    for (const char* hostile : {"<b>", "a line\nof its own", "averylongunitindeed"}) {
        setUnit(*grid, hostile);
        CHECK(unitOf(*grid).empty());
    }
    LevelSet model;
    model.grid = grid;
    setUnit(*grid, "mm");
    CHECK(unitOf(inUnit(model, "um")) == "mm");
    setUnit(*grid, "");
    CHECK(unitOf(inUnit(model, "um")) == "um");
    CHECK(unitOf(model).empty());
    grid->insertMeta(kUnitKey, openvdb::Int32Metadata(3));
    CHECK(unitOf(*grid).empty());
}

TEST_CASE("loadModel: a VDB's unit stays with resampling and bands, and goes with another unit",
          "[pipeline][property]") {
    openvdb::initialize();
    const test::TemporaryFolder folder;
    const auto ball = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10.f, {0.f, 0.f, 0.f}, 1.f);
    ball->setName("surface");
    setUnit(*ball, "um");
    writeVdb(folder.path("b.vdb"), {ball}, {});
    ModelOptions options;
    CHECK(unitOf(*loadModel(folder.path("b.vdb"), options).grid) == "um");
    options.voxelSize = 0.7;
    const LevelSet resampled = loadModel(folder.path("b.vdb"), options);
    CHECK(unitOf(*resampled.grid) == "um");
    CHECK(unitOf(*withHalfWidth(resampled, 5).grid) == "um");
    options.voxelSize = 0;
    options.unitScale = 0.001;
    CHECK(unitOf(*loadModel(folder.path("b.vdb"), options).grid).empty());
}
