#include "libvdbsynth/grid/voxel_table.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("VoxelTable: holds exactly the wanted voxels, each with its number", "[grid][property]") {
    const BrickField field = test::ballsField({21, 34, 19}, 4, 3.f);
    const auto wanted = [](float d) { return std::abs(d) < 1; };
    const VoxelTable table = VoxelTable::where(field, wanted);
    REQUIRE(table.size() > 100);
    std::size_t count = 0;
    for (int x = -1; x <= 21; ++x)
        for (int y = -1; y <= 34; ++y)
            for (int z = -1; z <= 19; ++z) {
                const Index3 p{x, y, z};
                const std::int32_t number = table.find(p);
                const bool in = field.box().contains(p) && wanted(field.at(p));
                REQUIRE((number >= 0) == in);
                if (!in) continue;
                REQUIRE(table[std::size_t(number)] == p);
                ++count;
            }
    CHECK(count == table.size());
}

TEST_CASE("VoxelTable: the same numbers for any threads, nothing, and all of a constant field", "[grid]") {
    const BrickField field = test::ballsField({40, 24, 33}, 9, 3.f);
    RunContext one;
    one.threads = 1;
    const auto wanted = [](float d) { return d < 0.5f; };
    CHECK(VoxelTable::where(field, wanted).voxels() == VoxelTable::where(field, wanted, one).voxels());
    const BrickField constant(IndexBox::fromSize({9, 8, 7}), 2.f);
    CHECK(VoxelTable::where(constant, [](float) { return true; }).size() == 9 * 8 * 7);
    CHECK(VoxelTable::where(constant, [](float) { return false; }).size() == 0);
}
