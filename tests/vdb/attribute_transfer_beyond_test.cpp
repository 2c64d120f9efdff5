#include "libvdbsynth/vdb/attribute_transfer.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

using namespace vdbsynth;

namespace {

openvdb::FloatGrid::Ptr floats(const char* name) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0.f);
    grid->setName(name);
    return grid;
}

// A number at every voxel of a box that tells its place.
openvdb::FloatGrid::Ptr placesIn(const char* name, const IndexBox& box, float shift = 0) {
    const auto grid = floats(name);
    forEachVoxel(box, [&](const Index3& p) {
        grid->tree().setValueOn(toCoord(p), shift + float(p.x + 100 * p.y + 10000 * p.z));
    });
    return grid;
}

// A level set whose band is two layers of a box along x.
openvdb::FloatGrid::Ptr bandOver(const IndexBox& box) {
    const auto grid = floats("surface");
    IndexBox layer = box;
    layer.max.x = layer.min.x + 1;
    grid->tree().denseFill(toBBox(layer), 1.f, true);
    return grid;
}

// A target of 16 x 8 x 8 that is the exemplar's box from 3, 1, 2 on.
SourceMap shiftedMap() {
    SourceMap map;
    map.targetBox = map.targetDomain = IndexBox::fromSize({16, 8, 8});
    map.exemplars.resize(1);
    map.exemplars[0].box = IndexBox::fromSize({20, 20, 20});
    map.patches.target = map.targetBox.size();
    map.patches.block = 8;
    map.patches.stride = 8;
    map.patches.allocate();
    map.patches.source = {{3, 1, 2}, {11, 1, 2}};
    map.patches.exemplar = {0, 0};
    return map;
}

}  // namespace

TEST_CASE("isBeyondBand: densities of an interior are, values on the band are not", "[vdb]") {
    const IndexBox box = IndexBox::fromSize({16, 8, 8});
    const auto levelSet = bandOver(box);
    CHECK(isBeyondBand(placesIn("density", box), *levelSet));
    CHECK_FALSE(isBeyondBand(placesIn("Cd", IndexBox::fromSize({2, 8, 8})), *levelSet));
    CHECK_FALSE(isBeyondBand(floats("empty"), *levelSet));
    const auto tile = floats("tile");
    tile->tree().addTile(1, {8, 0, 0}, 1.f, true);
    CHECK(isBeyondBand(tile, *levelSet));
}

TEST_CASE("transferAttributes: interiors are transferred whole, other grids on the band only",
          "[vdb][oracle]") {
    LevelSet exemplar;
    exemplar.grid = bandOver(IndexBox::fromSize({20, 20, 20}));
    exemplar.attributes = {placesIn("density", IndexBox::fromSize({20, 20, 20})),
                           placesIn("Cd", IndexBox::fromSize({2, 20, 20}))};
    const auto result = bandOver(IndexBox::fromSize({16, 8, 8}));
    const auto grids = transferAttributes(shiftedMap(), {&exemplar}, *result, AttributeValues::Copied);
    REQUIRE(grids.size() == 2);
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
    REQUIRE(density->getName() == "density");
    CHECK(density->activeVoxelCount() == 16 * 8 * 8);
    forEachVoxel(IndexBox::fromSize({16, 8, 8}), [&](const Index3& p) {
        REQUIRE(density->tree().getValue(toCoord(p)) == float(p.x + 3 + 100 * (p.y + 1) + 10000 * (p.z + 2)));
    });
    CHECK(grids[1]->activeVoxelCount() <= 2 * 8 * 8);
}

TEST_CASE("transferBeyondBand: what is not active in the exemplar is not in the result", "[vdb]") {
    LevelSet exemplar;
    exemplar.grid = bandOver(IndexBox::fromSize({20, 20, 20}));
    exemplar.attributes = {placesIn("density", {{10, 0, 0}, {13, 19, 19}})};
    const auto result = bandOver(IndexBox::fromSize({16, 8, 8}));
    const auto grids = transferBeyondBand(shiftedMap(), {&exemplar}, *result, {});
    REQUIRE(grids.size() == 1);
    CHECK(grids[0]->activeVoxelCount() == 4 * 8 * 8);
    // Nothing to bring: nothing is looked at.
    exemplar.attributes.clear();
    CHECK(transferBeyondBand(shiftedMap(), {&exemplar}, *result, {}).empty());
}

TEST_CASE("noteBandOnly: one line for each grid whose interior cannot be transferred", "[vdb]") {
    LevelSet exemplar;
    exemplar.grid = bandOver(IndexBox::fromSize({20, 20, 20}));
    exemplar.attributes = {placesIn("density", IndexBox::fromSize({20, 20, 20})),
                           placesIn("Cd", IndexBox::fromSize({2, 20, 20}))};
    test::Said said;
    noteBandOnly({&exemplar}, said.ctx);
    CHECK(said.notes.size() == 1);
    CHECK(said.noted("\"density\""));
}

TEST_CASE("laidOver: own grids stay, brought values lie over those of one name and kind", "[vdb]") {
    const auto own = placesIn("density", IndexBox::fromSize({4, 4, 4})),
               other = placesIn("heat", IndexBox::fromSize({4, 4, 4}));
    const auto brought = placesIn("density", {{3, 0, 0}, {5, 3, 3}}, 0.5f);
    const auto grids = laidOver({own, other}, {brought});
    REQUIRE(grids.size() == 2);
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
    CHECK(density->activeVoxelCount() == 6 * 16);
    CHECK(density->tree().getValue({2, 1, 1}) == 10102);
    CHECK(density->tree().getValue({3, 1, 1}) == 10103.5f);
    CHECK(grids[1] == other);
    // The models' own are untouched.
    CHECK(own->tree().getValue({3, 1, 1}) == 10103);
    CHECK(laidOver({}, {brought}).size() == 1);
}

TEST_CASE("transferBeyondBand: fog is the mean over the blocks at a voxel, and soft where one has none",
          "[vdb][oracle]") {
    LevelSet exemplar;
    exemplar.grid = bandOver(IndexBox::fromSize({20, 20, 20}));
    const auto fog = floats("density");
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    forEachVoxel({{4, 0, 0}, {9, 19, 19}},
                 [&](const Index3& p) { fog->tree().setValueOn(toCoord(p), float(p.x)); });
    exemplar.attributes = {fog};
    SourceMap map = shiftedMap();
    const auto result = bandOver(IndexBox::fromSize({16, 8, 8}));
    const auto grids = transferBeyondBand(map, {&exemplar}, *result, {});
    REQUIRE(grids.size() == 1);
    CHECK(grids[0]->getGridClass() == openvdb::GRID_FOG_VOLUME);
    const auto made = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
    // One block at each voxel: a copy of x + 3.
    CHECK(made->tree().getValue({1, 3, 3}) == 4);
    CHECK(made->tree().getValue({6, 3, 3}) == 9);
    CHECK_FALSE(made->tree().isValueOn({0, 3, 3}));
    CHECK_FALSE(made->tree().isValueOn({7, 3, 3}));
    CHECK(made->activeVoxelCount() == 6 * 8 * 8);
    // What the band's part made of it is replaced.
    const auto band = placesIn("density", IndexBox::fromSize({2, 8, 8}));
    CHECK(transferBeyondBand(map, {&exemplar}, *result, {band}).size() == 1);
}
