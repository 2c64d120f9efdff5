#include "libvdbsynth/grid/islands.h"

#include <catch2/catch.hpp>

#include "tests/support/shapes.h"

using namespace vdbsynth;

namespace {

BrickField withSpeck(const BrickField& field, const Index3& at, float value) {
    BrickField result = field;
    result.writeBox(at, {1, 1, 1}, &value);
    return result;
}

}  // namespace

TEST_CASE("removeIslands: a speck of the solid and one of the void go, the rest stays", "[measure]") {
    const auto ball = test::sphereField(32, 9);
    BrickField field = withSpeck(withSpeck(*ball, {3, 3, 3}, -0.5f), {15, 15, 15}, 0.5f);
    CHECK(removeIslands(field, {27, 27}, false) == 1);
    CHECK(removeIslands(field, {27, 27}, true) == 1);
    CHECK(field.at({3, 3, 3}) > 0);
    CHECK(field.at({15, 15, 15}) < 0);
    CHECK(field.at({15, 15, 20}) == ball->at({15, 15, 20}));
    CHECK(removeIslands(field, {27, 27}, false) == 0);
}

TEST_CASE("islandLimits: no larger than the exemplar's smallest part", "[measure]") {
    const auto specked =
        std::make_shared<const BrickField>(withSpeck(*test::sphereField(32, 9), {3, 3, 3}, -0.5f));
    CHECK(islandLimits({specked}, 64, false).interior == 1);
    CHECK(islandLimits({test::sphereField(32, 9)}, 64, false).interior == 64);
}
