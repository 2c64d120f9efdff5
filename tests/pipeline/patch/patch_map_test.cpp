#include "libvdbsynth/pipeline/patch/patch_map.h"

#include "libvdbsynth/pipeline/patch/patch.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include <cstring>

#include "tests/support/makers.h"
#include "tests/support/patch_sources.h"

using namespace vdbsynth;

TEST_CASE("patchMapFrom: reads what patchMapGrid wrote, and repeats it bit for bit", "[pipeline][patch]") {
    openvdb::initialize();
    const PatchSource source = test::eggCrateSource();
    for (const bool tile : {false, true}) {
        PatchOptions options;
        options.width = 60;
        options.depth = 48;
        options.tile = tile;
        const PatchSheet sheet = makePatchSheet(source, options);
        const auto map = patchMapFrom("map.vdb", {patchMapGrid(source, sheet, options)});
        REQUIRE(map);
        CHECK(map->arrangement.label == sheet.result.arrangement.label);
        CHECK(map->arrangement.patches.size() == sheet.result.patches);
        CHECK(map->plane == source.exemplar.plane);
        const PatchSheet again = repeatPatchSheet(source, *map);
        REQUIRE(again.result.sheet.size() == sheet.result.sheet.size());
        CHECK(std::memcmp(again.result.sheet.points.data(), sheet.result.sheet.points.data(),
                          sheet.result.sheet.size() * sizeof(Vec3f)) == 0);
        CHECK(again.result.sheet.source == sheet.result.sheet.source);
    }
}

TEST_CASE("patchMapFrom: none without labels, and damaged ones are refused", "[pipeline][patch]") {
    openvdb::initialize();
    CHECK_FALSE(patchMapFrom("map.vdb", {openvdb::FloatGrid::create()}));
    const PatchSource source = test::eggCrateSource();
    PatchOptions options;
    options.width = options.depth = 48;
    const PatchSheet sheet = makePatchSheet(source, options);
    const auto damaged = [&](const auto& change) {
        const GridPtr grid = patchMapGrid(source, sheet, options);
        change(*openvdb::gridPtrCast<openvdb::Int32Grid>(grid));
        return test::thrownBy([&] { patchMapFrom("map.vdb", {grid}); });
    };
    CHECK(damaged([](openvdb::Int32Grid& grid) { grid.removeMeta("vdbsynth:sheet"); }).code ==
          int(ErrorCode::BadData));
    CHECK(damaged([](openvdb::Int32Grid& grid) { grid.removeMeta("vdbsynth:patches"); }).code ==
          int(ErrorCode::BadData));
    CHECK(damaged([](openvdb::Int32Grid& grid) {
              grid.getAccessor().setValue({0, 0, 0}, 100000);
          }).code == int(ErrorCode::BadData));
    CHECK(damaged([](openvdb::Int32Grid& grid) {
              grid.getAccessor().setValue({0, 0, 0}, -1);
          }).code == int(ErrorCode::BadData));
}

TEST_CASE("repeatPatchSheet: a smaller exemplar is refused, the paper's method has no map",
          "[pipeline][patch]") {
    openvdb::initialize();
    const PatchSource source = test::eggCrateSource();
    PatchOptions options;
    options.width = options.depth = 48;
    const PatchSheet sheet = makePatchSheet(source, options);
    const auto map = patchMapFrom("map.vdb", {patchMapGrid(source, sheet, options)});
    PatchSource small = source;
    small.exemplar.size.x /= 3;
    CHECK(test::thrownBy([&] { repeatPatchSheet(small, *map); }).code == int(ErrorCode::ShapeMismatch));
    PatchSheet paper = sheet;
    paper.result.arrangement.patches.clear();
    CHECK(test::thrownBy([&] { patchMapGrid(source, paper, options); }).code == int(ErrorCode::Unusable));
}
