#include "libvdbsynth/grid/voxel_table.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/grid/field_sampling.h"
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

TEST_CASE("sampleTrilinear: exact for a linear field, also across bricks, clamped outside", "[grid]") {
    const BrickField field = test::fieldFrom(
        {20, 20, 20}, [](const Index3& p) { return float(2 * p.x) - float(p.y) + 0.5f * float(p.z); });
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(3, i);
        const Vec3f p{float(random.uniform(0, 19)), float(random.uniform(0, 19)),
                      float(random.uniform(0, 19))};
        CHECK(sampleTrilinear(field, p) == Approx(2 * p.x - p.y + 0.5f * p.z).margin(1e-4));
    }
    const Vec3f gradient = sampleGradient(field, {7.9f, 8.1f, 3});
    CHECK(gradient.x == Approx(2).margin(1e-4));
    CHECK(gradient.y == Approx(-1).margin(1e-4));
    CHECK(gradient.z == Approx(0.5).margin(1e-4));
    CHECK(sampleTrilinear(field, {-5, 3, 2}) == Approx(-2));
}
