#include "libvdbsynth/synth/seam_cells.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

PatchMap mapFor(const Index3& target, int block) {
    PatchMap map;
    map.target = target;
    map.block = block;
    map.stride = std::max(1, block / 4);
    map.allocate();
    return map;
}

template <typename Body>
void forEachCell(const Index3& count, const Body& body) {
    for (int x = 0; x < count.x; ++x)
        for (int y = 0; y < count.y; ++y)
            for (int z = 0; z < count.z; ++z) body(Index3{x, y, z});
}

bool inside(const PatchMap& map, const Index3& patch, const PatchMap& blocks, const Index3& cell) {
    return IndexBox::cube(map.originOf(patch), map.block)
        .contains(IndexBox::cube(blocks.originOf(cell), blocks.block));
}

}  // namespace

TEST_CASE("NearField: 64ths of a voxel up to one and a half", "[synth]") {
    const BrickField field = test::fieldFrom({4, 4, 4}, [](const Index3& p) { return float(p.x) - 1.25f; });
    const BrickField far = test::fieldFrom({4, 4, 4}, [](const Index3&) { return -5.f; });
    const NearField a(field), b(far);
    // x - 1.25 clamped against -1.5: 0.25 and 1.25 of 64 each, four samples of each.
    CHECK(cellDifference(a, {0, 0, 0}, b, {1, 1, 1}) == 4 * (16 + 80));
    CHECK(cellDifference(b, {0, 0, 0}, b, {2, 1, 0}) == 0);
    CHECK(a.hasSurface({0, 2, 2}));
    CHECK_FALSE(b.hasSurface({0, 0, 0}));
    CHECK(a.surfaceCells() == 8);
    CHECK(b.surfaceCells() == 0);
    CHECK(a.holds({2, 2, 2}));
    CHECK_FALSE(a.holds({2, 3, 2}));
    CHECK_FALSE(a.holds({-1, 0, 0}));
    // Dense or in bricks is the same.
    CHECK(cellDifference(a, {1, 1, 1}, NearField(denseField(field)), {1, 1, 1}) == 0);
}

TEST_CASE("SeamCells: every cell lies inside a patch, and cells and patches know each other",
          "[synth][property]") {
    for (const int block : {4, 5, 6, 7, 8, 12, 16, 21})
        for (const Index3& target : {Index3{21, 24, 33}, Index3{40, 22, 31}}) {
            CAPTURE(block);
            const PatchMap map = mapFor(target, block);
            const SeamCells cells(map);
            REQUIRE(cells.blocks().block >= 4);
            std::vector<std::vector<Index3>> over(cells.total());
            forEachCell(map.lattice(), [&](const Index3& patch) {
                const IndexBox box = cells.inside(patch);
                forEachCell(cells.count(), [&](const Index3& cell) {
                    if (box.contains(cell) != inside(map, patch, cells.blocks(), cell))
                        FAIL("a patch names the wrong cells");
                    if (box.contains(cell)) over[cells.number(cell)].push_back(patch);
                });
            });
            for (const auto& patches : over) REQUIRE_FALSE(patches.empty());
        }
}

TEST_CASE("SeamCells: the strongest patch is the one that the vote weighs most", "[synth][oracle]") {
    PatchMap map = mapFor({29, 24, 26}, 12);
    for (std::size_t i = 0; i < map.source.size(); ++i)
        map.weight.push_back(float(Random(5, i).uniform(0.1, 1)));
    const SeamCells cells(map);
    forEachCell(cells.count(), [&](const Index3& cell) {
        std::size_t best = 0;
        float most = -1;
        forEachCell(map.lattice(), [&](const Index3& patch) {
            if (!inside(map, patch, cells.blocks(), cell)) return;
            const float say = blockWeight(map, patch, cells.cornerOf(cell) + Index3{1, 1, 1});
            if (say > most * 1.0001f) most = say, best = map.index(patch);
        });
        const std::size_t found = cells.strongestPatch(map, cell);
        const float say = blockWeight(map, map.place(found), cells.cornerOf(cell) + Index3{1, 1, 1});
        if (found != best) REQUIRE(say == Approx(most));
    });
}

TEST_CASE("groupsApart: no two of a group touch, and each box is in one", "[synth][property]") {
    const Index3 count{90, 60, 70};
    std::vector<IndexBox> boxes;
    for (std::uint64_t i = 0; i < 300; ++i) {
        Random random(3, i);
        IndexBox box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = int(random.below(std::uint32_t(count[axis])));
            box.max[axis] = std::min(count[axis] - 1, box.min[axis] + int(random.below(14)));
        }
        boxes.push_back(i % 10 == 9 ? IndexBox{} : box);
    }
    std::vector<int> times(boxes.size(), 0);
    std::size_t largest = 0;
    for (const auto& group : groupsApart(boxes, count)) {
        largest = std::max(largest, group.size());
        for (std::size_t a = 0; a < group.size(); ++a) {
            ++times[std::size_t(group[a])];
            for (std::size_t b = 0; b < a; ++b)
                REQUIRE(boxes[std::size_t(group[a])]
                            .expanded(1)
                            .intersection(boxes[std::size_t(group[b])])
                            .empty());
        }
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) REQUIRE(times[i] == (boxes[i].empty() ? 0 : 1));
    CHECK(largest > 5);
    CHECK(groupsApart({}, count).empty());
}
