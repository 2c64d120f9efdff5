#include "libvdbsynth/grid/dense_field.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("denseField: every sample of the field, rows along z, beginning at 0", "[grid][oracle]") {
    BrickField field = test::noiseField({11, 9, 18}, 6);
    field.translate({-4, 30, 7});
    const DenseField dense = denseField(field);
    REQUIRE(dense.size == Index3{11, 9, 18});
    REQUIRE(dense.samples.size() == 11 * 9 * 18);
    std::size_t place = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        const Index3 q = p - field.box().min;
        REQUIRE(dense.at(q) == field.at(p));
        REQUIRE(dense.samples[place++] == field.at(p));
        REQUIRE(dense.row(q.x, q.y, 0)[q.z] == field.at(p));
    });
}

TEST_CASE("denseField: constant regions, one voxel, and no voxel", "[grid][degenerate]") {
    BrickField field(IndexBox::fromSize({20, 20, 20}), 2.5f);
    const float other = -1;
    field.writeBox({17, 3, 9}, {1, 1, 1}, &other);
    const DenseField dense = denseField(field);
    CHECK(std::count(dense.samples.begin(), dense.samples.end(), 2.5f) == 7999);
    CHECK(dense.at({17, 3, 9}) == -1);
    const DenseField one = denseField(BrickField({{5, 5, 5}, {5, 5, 5}}, 3.f));
    CHECK(one.size == Index3{1, 1, 1});
    CHECK(one.samples == std::vector<float>{3});
    CHECK(denseField(BrickField()).samples.empty());
    CHECK(DenseField().samples.empty());
}
