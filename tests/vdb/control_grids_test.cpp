#include "libvdbsynth/vdb/control_grids.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <algorithm>
#include <cmath>

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

TEST_CASE("sampledWeight: a solid mask is 0 outside and rises inside, whatever its voxels, band and place",
          "[pipeline][property]") {
    openvdb::initialize();
    const auto like = openvdb::FloatGrid::create(12.f);
    like->setTransform(openvdb::math::Transform::createLinearTransform(4));
    like->transform().postTranslate({1, 2, 0});
    const ControlFrame frame = frameOver({{-20, -20, -20}, {20, 20, 20}}, *like);
    for (const double voxel : {0.5, 1.0, 4.0, 9.0})
        for (const float band : {1.5f, 3.f, 8.f}) {
            CAPTURE(voxel, band);
            const auto ball = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                40.f, openvdb::Vec3f(3, 0, -5), float(voxel), band);
            const BrickField weight = sampledWeight(*ball, frame, 0.5f, "`mask`");
            std::size_t wrong = 0;
            forEachVoxel(frame.box, [&](const Index3& p) {
                const openvdb::Vec3d at = like->indexToWorld(openvdb::Vec3d(p.x, p.y, p.z));
                const double depth = 40 - (at - openvdb::Vec3d(3, 0, -5)).length();
                const double share = std::clamp(depth / 12, 0.0, 1.0) / 2;
                const float got = weight.at(p - frame.box.min);
                if (depth < -0.1 * voxel && got != 0) ++wrong;
                if (std::abs(double(got) - share) > 0.05 + 0.01 * voxel) ++wrong;
            });
            CHECK(wrong == 0);
        }
}

TEST_CASE("sampledWeight: fog, truths and distances of no class", "[pipeline][oracle]") {
    openvdb::initialize();
    const auto like = openvdb::FloatGrid::create(3.f);
    const ControlFrame frame = frameOver({{0, 0, 0}, {15, 7, 7}}, *like);
    auto fog = openvdb::FloatGrid::create(0.f);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    fog->fill(openvdb::CoordBBox({8, -9, -9}, {11, 20, 20}), 0.25f);
    fog->fill(openvdb::CoordBBox({12, -9, -9}, {40, 20, 20}), 7.f);
    const BrickField grey = sampledWeight(*fog, frame, 1, "`mask`");
    CHECK((grey.at({7, 3, 3}) == 0 && grey.at({8, 3, 3}) == 0.25f && grey.at({12, 3, 3}) == 1));
    auto truths = openvdb::BoolGrid::create(false);
    truths->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    truths->fill(openvdb::CoordBBox({16, -30, -30}, {60, 60, 60}), true);
    const BrickField sharp = sampledWeight(*truths, frame, 1, "`mask`");
    CHECK((sharp.at({7, 3, 3}) == 0 && sharp.at({8, 3, 3}) == 1));
    const auto ball =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.f, openvdb::Vec3f(4, 4, 4), 0.5f, 3.f);
    ball->setGridClass(openvdb::GRID_UNKNOWN);
    const BrickField solid = sampledWeight(*ball, frame, 1, "`mask`");
    CHECK((solid.at({4, 4, 4}) == 1 && solid.at({11, 4, 4}) == 0 &&
           solid.at({9, 4, 4}) == Approx(1 / 3.0).margin(0.05)));
    auto wild = openvdb::FloatGrid::create(std::numeric_limits<float>::quiet_NaN());
    CHECK(sampledWeight(*wild, frame, 1, "`mask`").at({0, 0, 0}) == 0);
    CHECK(test::thrownBy([&] { sampledWeight(*openvdb::Vec3SGrid::create(), frame, 1, "`mask`"); }).code ==
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

TEST_CASE("wantedVariants: a velocity is no grid of rotations", "[pipeline][error]") {
    openvdb::initialize();
    const auto like = openvdb::FloatGrid::create(3.f);
    const ControlFrame frame = frameOver({{0, 0, 0}, {7, 7, 7}}, *like);
    const auto refused = [&](const openvdb::GridBase& grid) {
        const test::Thrown error = test::thrownBy([&] { wantedVariants(nullptr, &grid, nullptr, 1, frame); });
        return error.code == int(ErrorCode::BadData) && test::contains(error.message, "`rotationMap`") &&
               test::contains(error.message, "rotation vectors");
    };
    const auto turns = openvdb::Vec3SGrid::create(openvdb::Vec3f(0, 0, 1));
    CHECK_FALSE(refused(*turns));
    for (const char* name : {"v", "vel", "Velocity", "particle_velocity"}) {
        turns->setName(name);
        CHECK(refused(*turns));
    }
    turns->setName("turns");
    CHECK_FALSE(refused(*turns));
    turns->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    CHECK(refused(*turns));
    turns->setVectorType(openvdb::VEC_INVARIANT);
    turns->setGridClass(openvdb::GRID_STAGGERED);
    CHECK(refused(*turns));
    // Of the right kind, but over a full turn.
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
    wantedVariants(nullptr, openvdb::FloatGrid::create(7.f).get(), nullptr, 1, frame, ctx);
    CHECK(test::contains(said, "over a full turn"));
}

TEST_CASE("fieldOfNumbers: every voxel has the number of its four", "[pipeline][oracle]") {
    const BrickField field = fieldOfNumbers({3, 1, 4, 1, 5, 9, 2, 6}, {{10, 10, 10}, {15, 17, 16}});
    CHECK(field.box().size() == Index3{6, 8, 7});
    CHECK(field.at({0, 0, 3}) == 3.f);
    CHECK(field.at({0, 4, 4}) == 1.f);
    CHECK(field.at({5, 7, 6}) == 6.f);
}
