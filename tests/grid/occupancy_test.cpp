#include "libvdbsynth/grid/occupancy.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

bool same(const Occupancy& a, const Occupancy& b) {
    if (a.size() != b.size()) return false;
    for (int x = 0; x < a.size().x; ++x)
        for (int y = 0; y < a.size().y; ++y)
            if (!std::equal(a.row(x, y), a.row(x, y) + a.rowWords(), b.row(x, y))) return false;
    return true;
}

}  // namespace

TEST_CASE("Occupancy: voxels by hand", "[grid][oracle]") {
    Occupancy solid({2, 3, 65});
    CHECK(solid.count() == 0);
    CHECK(solid.volume() == 2 * 3 * 65);
    CHECK(solid.rowWords() == 2);
    CHECK(solid.memoryBytes() == 2 * 3 * 2 * 8);
    solid.set(1, 2, 64);
    solid.set(1, 2, 64);
    solid.set(0, 0, 3);
    CHECK(solid.count() == 2);
    CHECK(solid.at(1, 2, 64));
    CHECK_FALSE(solid.at(1, 2, 63));
    CHECK(*solid.row(0, 0) == 8);
    CHECK(solid.row(1, 2)[1] == 1);
}

TEST_CASE("Occupancy: bits are the field's signs, windows and counts agree", "[grid][oracle]") {
    const BrickField field = test::noiseField({21, 9, 130}, 3);
    const Occupancy solid = Occupancy::fromField(field);
    std::uint64_t expected = 0, inWindow = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        REQUIRE(solid.at(p.x, p.y, p.z) == (field.at(p) < 0));
        expected += field.at(p) < 0;
    });
    CHECK(solid.count() == expected);
    CHECK(solid.complement().count() == 21 * 9 * 130 - expected);
    const IndexBox box{{2, 3, 61}, {20, 8, 127}};
    const Occupancy window = solid.window(box);
    CHECK(window.size() == Index3{19, 6, 67});
    forEachVoxel(box, [&](const Index3& p) {
        const Index3 q = p - box.min;
        REQUIRE(window.at(q.x, q.y, q.z) == solid.at(p.x, p.y, p.z));
        inWindow += solid.at(p.x, p.y, p.z);
    });
    CHECK(window.count() == inWindow);
}

TEST_CASE("Occupancy: the complement's complement and the whole window are the solid itself",
          "[grid][property]") {
    for (const int z : {1, 63, 64, 65, 130}) {
        const Index3 size{5, 4, z};
        const Occupancy solid = Occupancy::fromField(test::noiseField(size, 9));
        const Occupancy other = solid.complement();
        CHECK(same(other.complement(), solid));
        CHECK(same(solid.window(IndexBox::fromSize(size)), solid));
        CHECK(solid.count() + other.count() == std::uint64_t(solid.volume()));
        CHECK(countPairs(solid, other, {0, 0, 0}) == 0);
        CHECK(countPairs(solid, solid, {0, 0, 0}) == solid.count());
        // Bits beyond a row's end are 0.
        const Occupancy full = Occupancy(size).complement();
        if (z % 64 != 0) CHECK(full.row(4, 3)[full.rowWords() - 1] >> (z % 64) == 0);
        CHECK(full.count() == std::uint64_t(full.volume()));
    }
}

TEST_CASE("countPairs: as counted voxel by voxel, for shifts of every sign", "[grid][oracle]") {
    const Index3 size{7, 6, 140};
    const Occupancy a = Occupancy::fromField(test::noiseField(size, 1));
    const Occupancy b = Occupancy::fromField(test::noiseField(size, 2));
    for (const Index3& shift :
         {Index3{0, 0, 0}, Index3{1, -2, 3}, Index3{-3, 1, 64}, Index3{2, 2, -70}, Index3{0, 0, 139}}) {
        std::uint64_t expected = 0;
        forEachVoxel(IndexBox::fromSize(size), [&](const Index3& p) {
            const Index3 q = p + shift;
            if (IndexBox::fromSize(size).contains(q) && a.at(p.x, p.y, p.z) && b.at(q.x, q.y, q.z))
                ++expected;
        });
        CHECK(countPairs(a, b, shift) == expected);
        CHECK(countPairs(b, a, Index3{0, 0, 0} - shift) == expected);
    }
    // Shifts out of the box leave no pair.
    for (const Index3& shift : {Index3{7, 0, 0}, Index3{0, -6, 1}, Index3{0, 0, 140}, Index3{1, 1, -200}})
        CHECK(countPairs(a, b, shift) == 0);
}

TEST_CASE("Occupancy: same bits for any number of threads, and cancel is heard", "[grid][threads][cancel]") {
    const BrickField field = test::ballsField({50, 40, 70}, 3, 3.f);
    const auto made = [&](const RunContext& ctx) { return Occupancy::fromField(field, ctx); };
    CHECK(same(made(test::onThreads(1)), made(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
}
