#include "libvdbsynth/vdb/control_grids.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

ControlFrame frameOver(const IndexBox& box, const openvdb::FloatGrid& like) {
    ControlFrame frame;
    frame.box = frame.period = box;
    frame.like = &like;
    return frame;
}

}  // namespace

TEST_CASE("sampledScalar: read in the world, between voxels, and round a period", "[pipeline][oracle]") {
    openvdb::initialize();
    const auto like = openvdb::FloatGrid::create(3.f);
    like->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    // A coarser grid, moved: its value is the world's x.
    auto ramp = openvdb::FloatGrid::create(0.f);
    ramp->setTransform(openvdb::math::Transform::createLinearTransform(2));
    ramp->transform().postTranslate({1, 0, 0});
    for (int x = -5; x < 20; ++x)
        for (int y = -3; y < 9; ++y)
            for (int z = -3; z < 9; ++z) ramp->tree().setValueOn({x, y, z}, float(2 * x + 1));
    ControlFrame frame = frameOver({{2, 1, 0}, {41, 9, 9}}, *like);
    const BrickField field = sampledScalar(*ramp, frame, "`guide`");
    CHECK(field.at({0, 0, 0}) == Approx(1.0));
    CHECK(field.at({39, 4, 4}) == Approx(20.5));
    frame.tiles = {true, false, false};
    frame.period = {{10, 1, 0}, {29, 9, 9}};
    const BrickField tiled = sampledScalar(*ramp, frame, "`guide`");
    CHECK(tiled.at({0, 0, 0}) == Approx(11.0));   // voxel 2 is voxel 22
    CHECK(tiled.at({39, 0, 0}) == Approx(10.5));  // voxel 41 is voxel 21
    CHECK(test::thrownBy([&] { sampledScalar(*openvdb::Vec3SGrid::create(), frame, "`guide`"); }).code ==
          int(ErrorCode::BadData));
}

TEST_CASE("wantedVariants: numbers, turns and scales of every fourth voxel", "[pipeline][oracle]") {
    openvdb::initialize();
    const auto like = openvdb::FloatGrid::create(3.f);
    const ControlFrame frame = frameOver({{0, 0, 0}, {15, 7, 3}}, *like);
    auto exemplarMap = openvdb::Int32Grid::create(0);
    exemplarMap->fill(openvdb::CoordBBox({8, 0, 0}, {15, 7, 3}), 2);
    auto turn = openvdb::Vec3SGrid::create(openvdb::Vec3f(0.1f, 0, 0));
    auto angle = openvdb::FloatGrid::create(0.5f);
    auto scale = openvdb::FloatGrid::create(0.f);
    scale->fill(openvdb::CoordBBox({0, 4, 0}, {15, 7, 3}), 2.f);
    const auto wanted = wantedVariants(exemplarMap.get(), turn.get(), scale.get(), 3, frame);
    REQUIRE(wanted.size() == 8);
    CHECK((wanted[0].exemplar == 0 && wanted[7].exemplar == 2));
    CHECK(wanted[0].rotation.x == Approx(0.1));
    CHECK((wanted[0].scale == 1 && wanted[1].scale == 2));
    CHECK(wantedVariants(nullptr, angle.get(), nullptr, 1, frame)[3].rotation.z == Approx(0.5));
    // A level set: the second inside.
    auto solid = openvdb::FloatGrid::create(3.f);
    solid->setGridClass(openvdb::GRID_LEVEL_SET);
    solid->fill(openvdb::CoordBBox({0, 0, 0}, {7, 7, 3}), -1.f);
    const auto sides = wantedVariants(solid.get(), nullptr, nullptr, 2, frame);
    CHECK((sides[0].exemplar == 1 && sides[7].exemplar == 0));
    const auto error = [&](const openvdb::GridBase* a, const openvdb::GridBase* b,
                           const openvdb::GridBase* c) {
        return test::thrownBy([&] { wantedVariants(a, b, c, 2, frame); });
    };
    CHECK(test::contains(error(exemplarMap.get(), nullptr, nullptr).message, "`exemplarMap`: 2.0"));
    CHECK(error(exemplarMap.get(), nullptr, nullptr).code == int(ErrorCode::Unusable));
    scale->fill(openvdb::CoordBBox({0, 0, 0}, {15, 7, 3}), 7.f);
    CHECK(test::contains(error(nullptr, nullptr, scale.get()).message, "`scaleMap`: 7.0"));
    auto wild = openvdb::FloatGrid::create(std::numeric_limits<float>::quiet_NaN());
    CHECK(error(nullptr, wild.get(), nullptr).code == int(ErrorCode::Unusable));
    CHECK(error(turn.get(), nullptr, nullptr).code == int(ErrorCode::BadData));
}

TEST_CASE("fieldOfNumbers: every voxel has the number of its four", "[pipeline][oracle]") {
    const BrickField field = fieldOfNumbers({3, 1, 4, 1, 5, 9, 2, 6}, {{10, 10, 10}, {15, 17, 16}});
    CHECK(field.box().size() == Index3{6, 8, 7});
    CHECK(field.at({0, 0, 3}) == 3.f);
    CHECK(field.at({0, 4, 4}) == 1.f);
    CHECK(field.at({5, 7, 6}) == 6.f);
}
