#include "libvdbsynth/vdb/read/neighbour_pairs.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <set>

using namespace vdbsynth;

namespace {

using Pairs = std::multiset<std::pair<openvdb::Coord, openvdb::Coord>>;

Pairs pairsOf(const openvdb::FloatTree& tree) {
    Pairs pairs;
    const openvdb::FloatGrid::ConstAccessor accessor(tree);
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
        forEachPairOfLeaf(*leaf, accessor, [&](const VoxelPair& pair) {
            CHECK(tree.getValue(pair.a) == pair.valueA);
            CHECK(tree.getValue(pair.b) == pair.valueB);
            CHECK(tree.isValueOn(pair.b) == pair.activeB);
            pairs.insert(std::minmax(pair.a, pair.b));
        });
    return pairs;
}

}  // namespace

TEST_CASE("forEachPairOfLeaf: each pair once, within a leaf and across two", "[vdb][fast]") {
    openvdb::FloatTree tree(1.f);
    tree.setValue({0, 0, 7}, -2.f);
    tree.setValue({0, 0, 8}, -3.f);
    const Pairs pairs = pairsOf(tree);
    CHECK(std::set<std::pair<openvdb::Coord, openvdb::Coord>>(pairs.begin(), pairs.end()).size() ==
          pairs.size());
    // Two leaves side by side: three steps a voxel, the faces at low sides too; not the two active ones.
    CHECK(pairs.size() == 3 * 8 * 8 * 16 + 2 * 8 * 16 + 8 * 8 - 1);
    CHECK(pairs.count({{0, 0, 7}, {0, 0, 8}}) == 0);
    CHECK(pairs.count({{0, 0, 6}, {0, 0, 7}}) == 1);
    CHECK(pairs.count({{-1, 0, 7}, {0, 0, 7}}) == 1);
}

TEST_CASE("forEachPairOfTiles: squares of constant regions against what lies beside them", "[vdb][fast]") {
    openvdb::FloatTree tree(1.f);
    tree.addTile(1, {8, 8, 8}, -1.f, false);
    int squares = 0;
    double area = 0;
    forEachPairOfTiles(tree, [&](const VoxelPair& pair) {
        if ((pair.valueA < 0) == (pair.valueB < 0)) return;
        ++squares;
        area += pair.span * pair.span;
        CHECK(std::abs(pair.a.x() - pair.b.x()) + std::abs(pair.a.y() - pair.b.y()) +
                  std::abs(pair.a.z() - pair.b.z()) ==
              1);
    });
    CHECK(squares == 12);  // from both sides
    CHECK(area == 12 * 64);
}
