#include "libvdbsynth/math/index_box.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("IndexBox: sizes, membership and intersection with inclusive corners", "[math][fast]") {
    const IndexBox box{{-1, 0, 2}, {1, 0, 5}};
    CHECK(box.size() == Index3{3, 1, 4});
    CHECK(box.volume() == 12);
    CHECK(box.contains(Index3{1, 0, 5}));
    CHECK_FALSE(box.contains(Index3{2, 0, 5}));
    CHECK(box.intersection(IndexBox::cube({0, 0, 0}, 3)) == IndexBox{{0, 0, 2}, {1, 0, 2}});
    CHECK(box.intersection(IndexBox::cube({5, 5, 5}, 2)).empty());
    CHECK(IndexBox().empty());
    CHECK(IndexBox().volume() == 0);
    CHECK(IndexBox::fromSize({2, 3, 4}).expanded(1) == IndexBox{{-1, -1, -1}, {2, 3, 4}});
}

TEST_CASE("Index3: order is x, then y, then z", "[math][fast]") {
    CHECK(Index3{0, 9, 9} < Index3{1, 0, 0});
    CHECK(Index3{1, 0, 9} < Index3{1, 1, 0});
    CHECK(Index3{1, 1, 0} < Index3{1, 1, 1});
    CHECK_FALSE(Index3{1, 1, 1} < Index3{1, 1, 1});
}
