#include "libvdbsynth/vdb/mask.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("masks: box, ball, inside and range hold the voxels that they name", "[vdb][oracle]") {
    openvdb::initialize();
    const auto count = [](const GridPtr& grid) { return double(grid->activeVoxelCount()); };
    CHECK(count(boxMask({{-2, 0, 1}, {7, 4, 3}}, 0.5)) == 10 * 5 * 3);
    CHECK(count(ballMask({1, 2, 3}, 5, 0.5)) == Approx(4.18879 * 1000).epsilon(0.02));
    const BrickField field = test::ballsField({40, 40, 40}, 4, 3.f);
    const FloatGridPtr grid = scatterBricks(field, {0, 0, 0}, 1.f, 3.f);
    CHECK(count(insideMask(*grid)) == solidVoxels(*grid));
    const std::vector<float> samples = test::samplesOf(field);
    CHECK(
        count(rangeMask(*grid, -1, 0.5)) ==
        double(std::count_if(samples.begin(), samples.end(), [](float v) { return v >= -1 && v <= 0.5f; })));
    CHECK(test::contains(test::thrownBy([] { ballMask({0, 0, 0}, 0, 1); }).message, "`radius`"));
    CHECK(test::contains(test::thrownBy([&] { rangeMask(*grid, 2, 1); }).message, "`minimum`"));
}

TEST_CASE("gatherMask: 1 where active, for grids of several types, vectors are refused", "[vdb][error]") {
    const BrickField field = gatherMask(*boxMask({{2, 2, 2}, {5, 5, 5}}, 1), {{0, 0, 0}, {9, 9, 9}},
                                        *openvdb::FloatGrid::create());
    for (int x = 0; x < 10; ++x) CHECK(field.at({x, 3, 3}) == (x >= 2 && x <= 5 ? 1.f : 0.f));
    const auto vectors = openvdb::Vec3SGrid::create();
    CHECK(test::thrownBy([&] {
              gatherMask(*vectors, {{0, 0, 0}, {1, 1, 1}}, *openvdb::FloatGrid::create());
          }).code == int(ErrorCode::BadData));
    // A mask of other voxels would lie elsewhere.
    CHECK(test::thrownBy([&] {
              gatherMask(*boxMask({{0, 0, 0}, {1, 1, 1}}, 0.5), {{0, 0, 0}, {1, 1, 1}},
                         *openvdb::FloatGrid::create());
          }).code == int(ErrorCode::ShapeMismatch));
}
