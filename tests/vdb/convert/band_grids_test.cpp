#include "libvdbsynth/vdb/convert/band_grids.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/contexts.h"
#include "tests/support/level_sets.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

void place(const Vec3d& world, float* out) {
    out[0] = float(world.x);
    out[1] = float(world.y);
    out[2] = float(world.z);
    out[3] = float(world.x + world.y);
}

const std::vector<BandValue> kValues{{"Cd", 3}, {"sum", 1}};

}  // namespace

TEST_CASE("bandGrids: every active voxel holds what was read at its place", "[vdb]") {
    const FloatGridPtr level = test::ball();
    const std::vector<GridPtr> grids = bandGrids(*level, kValues, place);
    REQUIRE(grids.size() == 2);
    const auto colour = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[0]);
    const auto sum = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[1]);
    REQUIRE(colour);
    REQUIRE(sum);
    CHECK(colour->getName() == "Cd");
    CHECK(colour->activeVoxelCount() == level->activeVoxelCount());
    CHECK(colour->transform() == level->transform());
    for (auto voxel = level->cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Vec3d world = level->indexToWorld(voxel.getCoord());
        const openvdb::Vec3s value = colour->tree().getValue(voxel.getCoord());
        REQUIRE(double(value[0]) == Approx(world[0]));
        REQUIRE(double(value[2]) == Approx(world[2]));
        REQUIRE(double(sum->tree().getValue(voxel.getCoord())) == Approx(world[0] + world[1]).margin(1e-5));
    }
}

TEST_CASE("bandGrids: a width of two is refused, a stop stops, threads do not matter",
          "[vdb][error][cancel][determinism]") {
    const FloatGridPtr level = test::ball();
    CHECK(test::thrownBy([&] {
              bandGrids(*level, {{"uv", 2}}, place);
          }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              bandGrids(*level, kValues, place, ctx);
          }).code == int(ErrorCode::Cancelled));
    const auto sumOn = [&](int threads) {
        return openvdb::gridPtrCast<openvdb::FloatGrid>(
            bandGrids(*level, kValues, place, test::onThreads(threads))[1]);
    };
    CHECK(levelSetHash(*sumOn(1)) == levelSetHash(*sumOn(3)));
}
