#include "libvdbsynth/vdb/mask.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
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

TEST_CASE("maskOn: a solid of any voxels and band is active where it is inside, on the model's lattice",
          "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr like = openvdb::FloatGrid::create();
    const double radius = 12.2;
    const openvdb::Vec3f middle(20.1f, 19.7f, 20.4f);
    for (const float voxel : {1.f, 0.5f, 1.37f})
        for (const float band : {2.f, 3.f, 8.f}) {
            INFO(voxel << " " << band);
            const auto ball =
                openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(float(radius), middle, voxel, band);
            const GridConstPtr mask = maskOn(ball, *like, "`mask`");
            REQUIRE(mask->transform() == like->transform());
            const BrickField held = gatherMask(*mask, {{0, 0, 0}, {40, 40, 40}}, *like);
            std::size_t wrong = 0;
            forEachVoxel(held.box(), [&](const Index3& p) {
                const double r = (openvdb::Vec3d(p.x, p.y, p.z) - openvdb::Vec3d(middle)).length();
                if (std::abs(r - radius) > 0.05 * double(voxel)) wrong += (held.at(p) > 0) != (r < radius);
            });
            CHECK(wrong == 0);
        }
    // Thinner than the model's voxels.
    const auto dot =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(0.3f, {0.5f, 0.5f, 0.5f}, 0.1f, 3.f);
    CHECK(test::thrownBy([&] { maskOn(dot, *like, "`mask`"); }).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("maskOn: of a mask far larger than the model only what both share is read", "[vdb][error]") {
    openvdb::initialize();
    const FloatGridPtr like =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(4.f, {0, 0, 0}, 1.f, 3.f);
    // A million voxels of the model a side.
    const auto large = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5e5f, {0, 0, 0}, 2e4f, 3.f);
    CHECK(fromBBox(like->evalActiveVoxelBoundingBox()) == activeBox(*maskOn(large, *like, "`mask`")));
    const auto beside = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(4.f, {50, 0, 0}, 0.7f, 3.f);
    const test::Thrown thrown = test::thrownBy([&] { maskOn(beside, *like, "`mask`"); });
    CHECK(thrown.code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(thrown.message, "lies beside the model"));
}

TEST_CASE("maskOn: other grids are active where their nearest voxel is", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr like = openvdb::FloatGrid::create();
    const GridConstPtr own = boxMask({{2, 2, 2}, {5, 5, 5}}, 1);
    CHECK(maskOn(own, *like, "`mask`") == own);
    // Voxels 0 to 9 of half a voxel: nearest to 0, 0.5 .. 4.5.
    const GridConstPtr halves = maskOn(boxMask({{0, 0, 0}, {9, 9, 9}}, 0.5), *like, "`mask`");
    CHECK(activeBox(*halves) == IndexBox{{0, 0, 0}, {4, 4, 4}});
    const auto fog = openvdb::FloatGrid::create(0);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    fog->setTransform(openvdb::math::Transform::createLinearTransform(2));
    fog->fill(openvdb::CoordBBox({1, 1, 1}, {3, 3, 3}), 0.2f);
    CHECK(activeBox(*maskOn(fog, *like, "`mask`")) == IndexBox{{1, 1, 1}, {6, 6, 6}});
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setTransform(openvdb::math::Transform::createLinearTransform(2));
    vectors->tree().setValueOn({0, 0, 0}, openvdb::Vec3f(1));
    CHECK(test::thrownBy([&] { maskOn(vectors, *like, "`mask`"); }).code == int(ErrorCode::BadData));
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
