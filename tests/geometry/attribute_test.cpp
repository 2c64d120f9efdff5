#include "libvdbsynth/geometry/attribute.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

TEST_CASE("groupColumns: colours of bytes and of reals, vectors, texture coordinates, the rest",
          "[geometry][oracle]") {
    const Attributes made = groupColumns({{"heat", 0, {5, 6}},
                                          {"red", 255, {255, 0}},
                                          {"flow_y", 0, {2, 20}},
                                          {"green", 255, {51, 0}},
                                          {"flow_x", 0, {1, 10}},
                                          {"blue", 255, {0, 255}},
                                          {"alpha", 255, {255, 51}},
                                          {"flow_z", 0, {3, NAN}},
                                          {"t", 0, {0.5f, 1}},
                                          {"s", 0, {0.25f, 0}}});
    REQUIRE(made.size() == 5);
    CHECK(findAttribute(made, "Cd")->values == std::vector<float>{1, 0.2f, 0, 0, 0, 1});
    CHECK(findAttribute(made, "Alpha")->values == std::vector<float>{1, 0.2f});
    CHECK(findAttribute(made, "uv")->values == std::vector<float>{0.25f, 0.5f, 0, 1});
    CHECK(findAttribute(made, "flow")->values == std::vector<float>{1, 2, 3, 10, 20, 0});
    CHECK(findAttribute(made, "heat")->values == std::vector<float>{5, 6});
    CHECK(findAttribute(made, "none") == nullptr);
    // Real colours: up to 1 as they are, over 1 they run to 255.
    CHECK(groupColumns({{"r", 0, {0.5f}}, {"g", 0, {1}}, {"b", 0, {0}}})[0].values ==
          std::vector<float>{0.5f, 1, 0});
    CHECK(groupColumns({{"r", 0, {51}}, {"g", 0, {255}}, {"b", 0, {0}}})[0].values ==
          std::vector<float>{0.2f, 1, 0});
    // Two of three are no colour.
    CHECK(groupColumns({{"red", 255, {1}}, {"green", 255, {1}}}).size() == 2);
}

TEST_CASE("selectRows: keeps rows in the order asked for", "[geometry][fast]") {
    const Attributes made = selectRows({{"a", 2, {1, 2, 3, 4, 5, 6}}, {"b", 1, {7, 8, 9}}}, {2, 0});
    CHECK(made[0].values == std::vector<float>{5, 6, 1, 2});
    CHECK(made[1].values == std::vector<float>{9, 7});
}
