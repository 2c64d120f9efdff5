#include "libvdbsynth/vdb/convert/kept_voxels.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/redistance.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;

TEST_CASE("keepUnchanged: far from a change the target's bits, near it the edit's", "[vdb][property]") {
    openvdb::initialize();
    const auto ball =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(12.f, openvdb::Vec3f(0), 1.f, 3.f);
    const IndexBox box{{-20, -20, -20}, {20, 20, 20}};
    const BrickField before = gatherBricks(*ball, box, 1, 3);
    const auto dented = ball->deepCopy();
    dented->fill(openvdb::CoordBBox({9, -3, -3}, {14, 3, 3}), 2.5f);
    const BrickField after = gatherBricks(*dented, box, 1, 3);
    const FloatGridPtr result = rebuildLevelSet(*dented, 3, "it");
    const FloatGridPtr edit = result->deepCopy();
    const double share = keepUnchanged(*ball, before, after, box.min, 3, 3, *result);
    CHECK((share > 0.7 && share < 1));
    auto kept = result->getConstAccessor();
    std::size_t differ = 0;
    for (auto it = ball->cbeginValueOn(); it; ++it)
        if (it.getCoord().x() < 3 && kept.getValue(it.getCoord()) != *it) ++differ;
    CHECK(differ == 0);
    CHECK(kept.getValue({9, 0, 0}) == edit->tree().getValue({9, 0, 0}));
    CHECK(kept.getValue({9, 0, 0}) > 0);
}

TEST_CASE("keepUnchanged: without a change all comes back, and cancelling works", "[vdb][degenerate]") {
    openvdb::initialize();
    const auto ball =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.f, openvdb::Vec3f(0), 1.f, 3.f);
    const IndexBox box{{-12, -12, -12}, {12, 12, 12}};
    const BrickField field = gatherBricks(*ball, box, 1, 3);
    const FloatGridPtr result = rebuildLevelSet(*ball, 3, "it");
    CHECK(keepUnchanged(*ball, field, field, box.min, 3, 3, *result) == 1);
    for (auto it = ball->cbeginValueOn(); it; ++it) REQUIRE(result->tree().getValue(it.getCoord()) == *it);
    const std::atomic<bool> stop{true};
    RunContext cancelled;
    cancelled.cancel = &stop;
    CHECK(test::thrownBy([&] {
              keepUnchanged(*ball, field, field, box.min, 3, 3, *result, cancelled);
          }).code == int(ErrorCode::Cancelled));
}
