#include "libvdbsynth/pipeline/patch/patch_onto_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_sources.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include <cstring>

using namespace vdbsynth;

namespace {

LevelSet ballModel(float radius) {
    openvdb::initialize();
    LevelSet model;
    model.grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, openvdb::Vec3f(40, -20, 10),
                                                                          1.f, 3.f);
    model.domain = solidBox(*model.grid, "the ball");
    stampLevelSet(model);
    return model;
}

bool sameBits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

}  // namespace

TEST_CASE("patchOntoMapFrom: reads what was written, and repeats it bit for bit", "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource(PatchPlane::YZ);
    PatchOntoOptions options;
    for (const double scale : {1.0, 0.8}) {
        options.onto.scale = scale;
        options.onto.heightOffset = scale < 1 ? 1.5 : 0;
        const PatchedModel patched = patchOnto(source, ballModel(30), options);
        const auto map = patchOntoMapFrom("map.vdb", patchOntoMapGrids(source, patched, options));
        REQUIRE(map);
        CHECK(map->plane == PatchPlane::YZ);
        CHECK(map->arrangement.label == patched.result.arrangement.label);
        const PatchedModel again = repeatPatchOnto(source, *map, test::onThreads(3));
        CHECK(sameBits(again.result.sheet.points, patched.result.sheet.points));
        CHECK(sameBits(again.result.sheet.normals, patched.result.sheet.normals));
        CHECK(again.result.sheet.source == patched.result.sheet.source);
        CHECK(again.result.sheet.patch == patched.result.sheet.patch);
        CHECK(length(again.origin - patched.origin) == 0);
    }
}

TEST_CASE("patchOntoMapFrom: none without labels, and damaged ones are refused", "[pipeline][patch]") {
    openvdb::initialize();
    CHECK_FALSE(patchOntoMapFrom("map.vdb", {openvdb::FloatGrid::create()}));
    const PatchSource source = test::eggCrateSource();
    const PatchOntoOptions options;
    const PatchedModel patched = patchOnto(source, ballModel(24), options);
    const auto damaged = [&](const auto& change) {
        auto grids = patchOntoMapGrids(source, patched, options);
        change(*openvdb::gridPtrCast<openvdb::Int32Grid>(grids[0]),
               *openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[1]));
        return test::thrownBy([&] { patchOntoMapFrom("map.vdb", grids); }).code;
    };
    const int bad = int(ErrorCode::BadData);
    CHECK(damaged([](auto& labels, auto&) { labels.removeMeta("vdbsynth:onto"); }) == bad);
    CHECK(damaged([](auto& labels, auto&) { labels.removeMeta("vdbsynth:patches"); }) == bad);
    CHECK(damaged([](auto& labels, auto&) { labels.getAccessor().setValue({0, 0, 0}, 100000); }) == bad);
    CHECK(damaged([](auto& labels, auto&) { labels.getAccessor().setValue({0, 0, 0}, -7); }) == bad);
    CHECK(damaged([](auto&, auto& sites) { sites.clear(); }) == bad);
    CHECK(damaged([](auto&, auto& sites) {
              sites.getAccessor().setValue({0, 0, 1}, openvdb::Vec3s(5, 0, 0));
          }) == bad);
    CHECK_THROWS_WITH(patchOntoMapFrom("map.vdb", {patchOntoMapGrids(source, patched, options)[0]}),
                      Catch::Contains("no sites"));
    // A site far from the patch that it names, and an exemplar of another height.
    auto map = patchOntoMapFrom("map.vdb", patchOntoMapGrids(source, patched, options));
    PatchSource higher = source;
    higher.exemplar.size.z *= 2;
    CHECK(test::thrownBy([&] { repeatPatchOnto(higher, *map); }).code == int(ErrorCode::ShapeMismatch));
    std::fill(map->arrangement.label.begin(), map->arrangement.label.end(), 0);
    CHECK(test::thrownBy([&] { repeatPatchOnto(source, *map); }).code == int(ErrorCode::ShapeMismatch));
}
