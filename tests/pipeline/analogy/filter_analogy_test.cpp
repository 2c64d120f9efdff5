#include "libvdbsynth/pipeline/analogy/filter_analogy.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Filter.h>
#include <openvdb/tools/Morphology.h>
#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

openvdb::FloatGrid::Ptr fog(std::uint64_t seed, int side) {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
    const BrickField distance = test::ballsField({side, side, side}, seed, 5, 20);
    for (int x = 4; x < side - 4; ++x)
        for (int y = 4; y < side - 4; ++y)
            for (int z = 4; z < side - 4; ++z) {
                const float value = std::clamp(0.5f - distance.inside({x, y, z}) / 2, 0.f, 1.f);
                if (value > 0) grid->tree().setValueOn({x - 20, y, z + 7}, value);
            }
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    return grid;
}

openvdb::FloatGrid::Ptr blurred(const openvdb::FloatGrid& grid) {
    openvdb::FloatGrid::Ptr result = grid.deepCopy();
    openvdb::tools::dilateActiveValues(result->tree(), 4, openvdb::tools::NN_FACE_EDGE_VERTEX);
    openvdb::tools::Filter<openvdb::FloatGrid> filter(*result);
    filter.gaussian(1, 2);
    return result;
}

}  // namespace

TEST_CASE("makeFilteredGrid: OpenVDB's own blur is learnt and done to another fog volume", "[pipeline]") {
    const openvdb::FloatGrid::Ptr before = fog(1, 56), target = fog(2, 48);
    const FilterGridResult result = makeFilteredGrid({{before, blurred(*before)}}, target, {});
    const auto made = openvdb::gridPtrCast<openvdb::FloatGrid>(result.grid);
    const openvdb::FloatGrid::Ptr wanted = blurred(*target);
    CHECK(made->getName() == "density");
    CHECK(made->getGridClass() == openvdb::GRID_FOG_VOLUME);
    CHECK(made->transform() == target->transform());
    double error = 0, change = 0;
    for (auto value = wanted->cbeginValueOn(); value; ++value) {
        error += std::pow(double(made->tree().getValue(value.getCoord()) - value.getValue()), 2);
        change += std::pow(double(target->tree().getValue(value.getCoord()) - value.getValue()), 2);
    }
    CHECK(std::sqrt(error / change) < 0.05);
    CHECK(made->background() == 0);
    CHECK(made->activeVoxelCount() < 3 * wanted->activeVoxelCount());
    for (auto value = made->cbeginValueOn(); value; ++value) REQUIRE(value.getValue() >= 0);
}

TEST_CASE("makeFilteredGrid: what it refuses", "[pipeline][error]") {
    const openvdb::FloatGrid::Ptr before = fog(1, 40), target = fog(2, 40);
    const auto thrown = [&](const openvdb::FloatGrid::Ptr& a, const openvdb::FloatGrid::Ptr& b,
                            const openvdb::FloatGrid::Ptr& c) {
        return test::thrownBy([&] { makeFilteredGrid({{a, b}}, c, {}); });
    };
    openvdb::FloatGrid::Ptr wide = before->deepCopy(), broken = before->deepCopy(),
                            empty = openvdb::FloatGrid::create(0);
    wide->setTransform(openvdb::math::Transform::createLinearTransform(0.2));
    broken->tree().setValueOn({0, 10, 10}, std::nanf(""));
    empty->setTransform(before->transform().copy());
    CHECK(thrown(before, wide, target).code == int(ErrorCode::ShapeMismatch));
    CHECK(thrown(before, broken, target).code == int(ErrorCode::BadData));
    CHECK(thrown(before, before, empty).code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(thrown(empty, before, target).message, "first grid"));
    RunContext small;
    small.maxMemory = 1000;
    CHECK(test::thrownBy([&] {
              makeFilteredGrid({{before, before}}, target, {}, small);
          }).code == int(ErrorCode::Memory));
}
