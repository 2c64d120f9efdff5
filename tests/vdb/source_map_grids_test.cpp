#include "libvdbsynth/vdb/source_map_grids.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

LevelSet made(const char* kind, int resolution = 40) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    return makeModel(options);
}

SynthOptions sized(double x, double y, double z) {
    SynthOptions options;
    options.size = TargetSize::multiples(x, y, z);
    return options;
}

// The grids of a map with another one in the place of `vote_source`.
std::vector<GridPtr> withMain(std::vector<GridPtr> grids, const GridPtr& main) {
    grids[2] = main;
    return grids;
}

// A map of one voxel's source over a target of ten, by hand.
SourceMap analogyOfOne() {
    openvdb::initialize();
    SourceMap map;
    map.method = MapMethod::Analogy;
    map.exemplars.resize(2);
    map.exemplars[0] = {{{-20, 0, 0}, {9, 9, 9}}, {{-20, 0, 0}, {9, 9, 9}}, "aa", {true, false}, {}};
    map.exemplars[1] = {{{0, 0, 0}, {9, 9, 9}}, {{0, 0, 0}, {9, 9, 9}}, "bb", {}, {}};
    map.targetBox = map.targetDomain = {{0, 0, 0}, {9, 9, 9}};
    map.target = {"cc", 0.1, true};
    map.analogy.depths = {{-512, true}, {-3, false}};
    map.analogy.strength = 0.1f;
    Source source;
    source.exemplar = 1;
    source.position = {3.25, 4, 5};
    source.rotation = {0.1f, 0, 0};
    source.scale = 1.1f;
    map.elements.add({7, 8, 9}, source);
    return map;
}

const openvdb::FloatGrid& anyGrid() {
    static const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(3.f);
    return *grid;
}

}  // namespace

TEST_CASE("sourceMapGrids: on nearly all of the band the result lies where the map says",
          "[pipeline][property]") {
    const LevelSet exemplar = made("balls", 48);
    const SynthResult result = synthesize(exemplar, sized(2, 1, 1));
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
    const auto source = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grids[0]);
    const auto values = exemplar.grid->getConstAccessor();
    std::size_t near = 0, all = 0;
    for (auto it = source->cbeginValueOn(); it; ++it) {
        const float value = result.model.grid->tree().getValue(it.getCoord());
        if (std::abs(value) > 1) continue;
        const openvdb::Vec3i from = *it;
        CHECK(exemplar.domain.contains(Index3{from.x(), from.y(), from.z()}));
        ++all;
        if (std::abs(value - values.getValue({from.x(), from.y(), from.z()})) < 0.5f) ++near;
    }
    CHECK(double(near) / double(all) > 0.6);
}

TEST_CASE("readSourceMap: files without a map and broken maps are refused", "[pipeline][error]") {
    const test::TemporaryFolder folder;
    const LevelSet exemplar = made("grid");
    writeVdb(folder.path("a.vdb"), {exemplar.grid}, {});
    CHECK(test::contains(test::thrownBy([&] { readSourceMap(folder.path("a.vdb")); }).message,
                         "holds no source map"));
    const SynthResult result = synthesize(exemplar, sized(2, 1, 1));
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
    for (const char* name : {"patch", "stride", "overhang", "kernel", "cut", "exemplar_box", "target_box",
                             "band", "voxel_size"}) {
        INFO(name);
        const GridPtr broken = grids[2]->deepCopyGrid();
        broken->insertMeta(std::string("vdbsynth:map:") + name, openvdb::StringMetadata("-7"));
        writeVdb(folder.path("b.vdb"), withMain(grids, broken), {});
        CHECK(test::thrownBy([&] { readSourceMap(folder.path("b.vdb")); }).code == int(ErrorCode::BadData));
    }
    for (const auto& [name, value] : {std::pair<const char*, const char*>{"variants", "0,0,0,9,1,40,40;"},
                                      {"variants", "7,0,0,0,1,40,40,40;"},
                                      {"exemplars", "2"}}) {
        INFO(name << value);
        const GridPtr broken = grids[2]->deepCopyGrid();
        broken->insertMeta(std::string("vdbsynth:map:") + name, openvdb::StringMetadata(value));
        writeVdb(folder.path("b.vdb"), withMain(grids, broken), {});
        CHECK(test::thrownBy([&] { readSourceMap(folder.path("b.vdb")); }).code == int(ErrorCode::BadData));
    }
    const auto outside = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grids[2]->deepCopyGrid());
    outside->tree().setValueOn({0, 0, 0}, openvdb::Vec3i(100000, 0, 0));
    writeVdb(folder.path("c.vdb"), withMain(grids, outside), {});
    CHECK(test::contains(test::thrownBy([&] { readSourceMap(folder.path("c.vdb")); }).message,
                         "outside the exemplar"));
}

TEST_CASE("sourceMapGrids: an analogy's map comes back as it was, as either kind of grids",
          "[vdb][property]") {
    const SourceMap map = analogyOfOne();
    for (MapTypes types : {MapTypes::Integer, MapTypes::Float}) {
        const std::vector<GridPtr> grids = sourceMapGrids(map, anyGrid(), {}, types);
        CHECK(grids.size() == 5);
        CHECK(grids[0]->isType<openvdb::Vec3IGrid>() == (types == MapTypes::Integer));
        for (const GridPtr& grid : grids)
            if (types == MapTypes::Float)
                CHECK((grid->isType<openvdb::Vec3SGrid>() || grid->isType<openvdb::FloatGrid>()));
        const SourceMap read = sourceMapFrom("m.vdb", grids);
        CHECK(read.method == MapMethod::Analogy);
        CHECK(read.inputs() == 3);
        CHECK(read.exemplars[1].hash == "bb");
        CHECK(read.exemplars[0].cut == map.exemplars[0].cut);
        CHECK(read.target.voxelSize == 0.1);
        CHECK(read.analogy.strength == 0.1f);
        REQUIRE(read.analogy.depths.size() == 2);
        CHECK(read.analogy.depths[1].from == -3);
        REQUIRE(read.elements.size() == 1);
        CHECK(read.elements.voxels()[0] == Index3{7, 8, 9});
        const Source &a = *map.elements.strongest(0), &b = *read.elements.strongest(0);
        CHECK(a.exemplar == b.exemplar);
        CHECK(length(a.position - b.position) == 0);
        CHECK(length(a.rotation - b.rotation) == 0);
        CHECK(a.scale == b.scale);
        CHECK(strongestSourcesIn(grids).size() == 1);
        CHECK(hasSourcesIn(grids, anyGrid()));
    }
    CHECK_FALSE(hasSourcesIn({}, anyGrid()));
    CHECK(strongestSourcesIn({}).empty());
}

TEST_CASE("readSourceMap: a file is parsed once", "[vdb]") {
    const test::TemporaryFolder folder;
    writeVdb(folder.path("m.vdb"), sourceMapGrids(analogyOfOne(), anyGrid()), {});
    int begun = 0;
    RunContext ctx;
    ctx.onProgress = [&](const Progress& progress) { begun += progress.reading && progress.done == 0; };
    CHECK(readSourceMap(folder.path("m.vdb"), ctx).elements.size() == 1);
    CHECK(begun == 1);
}

TEST_CASE("sourceMapFrom: hostile maps of analogies are refused", "[vdb][error]") {
    const auto refused = [](const char* name, const char* value) {
        std::vector<GridPtr> grids = sourceMapGrids(analogyOfOne(), anyGrid());
        grids[0]->insertMeta(std::string("vdbsynth:map:") + name, openvdb::StringMetadata(value));
        const test::Thrown thrown = test::thrownBy([&] { sourceMapFrom("m.vdb", grids); });
        INFO(name << " " << value << ": " << thrown.message);
        return thrown.code == int(ErrorCode::BadData) &&
               test::contains(thrown.message, "m.vdb: its source map");
    };
    CHECK_FALSE(refused("strength", "0.5"));
    for (const auto& [name, value] : {std::pair<const char*, const char*>{"strength", "2"},
                                      {"strength", "0,5"},
                                      {"scale", "nan"},
                                      {"scale", "1e300"},
                                      {"depths", ""},
                                      {"depths", "1,2,3"},
                                      {"depths", "99999999999,1"},
                                      {"target_box", "0,0,0,4294967297,9,9"},
                                      {"target_box", "0,0,0,5,5,5"},
                                      {"cut", "00000"},
                                      {"cut", "00000x"},
                                      {"exemplar_cut", "7"},
                                      {"exemplar_box", "0,0,0,-1,0,0"},
                                      {"exemplars", "65"},
                                      {"exemplars", "1"},
                                      {"kernel", "tent^2"},
                                      {"method", "magic"},
                                      {"format", "3"},
                                      {"target_voxel_size", "-1"},
                                      {"exemplar_transform", "1,2,3"},
                                      {"half_width", "0"}})
        CHECK(refused(name, value));
    std::vector<GridPtr> grids = sourceMapGrids(analogyOfOne(), anyGrid());
    const auto message = [&] { return test::thrownBy([&] { sourceMapFrom("m.vdb", grids); }).message; };
    openvdb::gridPtrCast<openvdb::Vec3IGrid>(grids[0])->tree().setValueOn({7, 8, 9},
                                                                          openvdb::Vec3i(2147483647, 4, 5));
    CHECK(test::contains(message(), "bad source at 7,8,9"));
    grids = sourceMapGrids(analogyOfOne(), anyGrid());
    openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[2])->tree().setValueOn(
        {7, 8, 9}, openvdb::Vec3f(std::numeric_limits<float>::quiet_NaN(), 0, 0));
    CHECK(test::contains(message(), "bad source at 7,8,9"));
    grids = sourceMapGrids(analogyOfOne(), anyGrid());
    openvdb::gridPtrCast<openvdb::Int32Grid>(grids[1])->tree().setValueOn({7, 8, 9}, -3);
    CHECK(test::contains(message(), "bad source at 7,8,9"));
    grids = sourceMapGrids(analogyOfOne(), anyGrid());
    openvdb::gridPtrCast<openvdb::Vec3IGrid>(grids[0])->fill({openvdb::Coord(0), openvdb::Coord(127)},
                                                             openvdb::Vec3i(1));
    CHECK(test::contains(message(), "tiles"));
    CHECK(test::contains(test::thrownBy([] { sourceMapFrom("m.vdb", {}); }).message, "holds no source map"));
    SourceMap far = analogyOfOne();
    far.elements = ElementSources();
    Source source;
    source.position = {1 << 25, 0, 0};
    far.elements.add({0, 0, 0}, source);
    CHECK(test::thrownBy([&] { sourceMapGrids(far, anyGrid(), {}, MapTypes::Float); }).code ==
          int(ErrorCode::Unusable));
}

TEST_CASE("sourceMapFrom: hostile lattices are refused before anything is allocated", "[vdb][error]") {
    const LevelSet exemplar = made("grid");
    const SynthResult result = synthesize(exemplar, sized(2, 1, 1));
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
    // 2^28 blocks along each axis, whose product is 0 in 64 bits.
    const GridPtr wraps = grids[2]->deepCopyGrid();
    for (const auto& [name, value] :
         {std::pair<const char*, const char*>{
              "target_box", "-134217728,-134217728,-134217728,134217727,134217727,134217727"},
          {"patch", "1"},
          {"stride", "1"}})
        wraps->insertMeta(std::string("vdbsynth:map:") + name, openvdb::StringMetadata(value));
    CHECK(test::contains(test::thrownBy([&] { sourceMapFrom("m.vdb", withMain(grids, wraps)); }).message,
                         "blocks instead of"));
    const GridPtr bad = grids[2]->deepCopyGrid();
    bad->insertMeta("vdbsynth:map:overhang", openvdb::StringMetadata("4294967296,0,0"));
    CHECK(test::contains(test::thrownBy([&] { sourceMapFrom("m.vdb", withMain(grids, bad)); }).message,
                         "overhang"));
}
