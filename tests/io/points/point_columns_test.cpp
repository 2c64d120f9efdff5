#include "libvdbsynth/io/points/point_columns.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

using Triple = ColumnRoles::Triple;

PointTable table(std::size_t columns, std::vector<double> values) {
    PointTable made;
    made.columns = columns;
    made.values = std::move(values);
    return made;
}

std::string othersOf(const ColumnRoles& roles) {
    std::string text;
    for (const auto& [column, name] : roles.others) text += std::to_string(column) + name + " ";
    return text;
}

}  // namespace

TEST_CASE("namePlaces: spellings of x, y and z", "[io][hand]") {
    using Names = std::vector<std::string>;
    for (const Names& names :
         {Names{"x", "y", "z"}, Names{"//X", "Y", "Z"}, Names{"id", "X (m)", "Y (m)", "Z (m)"},
          Names{"Points:0", "Points:1", "Points:2"}, Names{"Easting", "Northing", "Elevation"},
          Names{"z", "y", "x"}, Names{"#x", "y", "z"}, Names{"Coord_X", "coord_y", "coord.z"}})
        CHECK(namePlaces(names));
    for (const Names& names : {Names{}, Names{"x", "y"}, Names{"lat", "lon", "alt"}, Names{"a", "b", "c"},
                               Names{"\xff\xfe", "", "z"}})
        CHECK_FALSE(namePlaces(names));
}

TEST_CASE("rolesByName: every column has a place, a meaning or none", "[io][hand]") {
    const ColumnRoles roles = rolesByName({"//Z", "Y", "X", "Red", "Green", "Blue", "NX", "ny", "nz",
                                           "Intensity", "Scalar field #1", "", "t", "t"},
                                          15);
    CHECK(roles.place == Triple{2, 1, 0});
    REQUIRE(roles.colour.size() == 1);
    CHECK(roles.colour[0] == Triple{3, 4, 5});
    REQUIRE(roles.normal.size() == 1);
    CHECK(roles.normal[0] == Triple{6, 7, 8});
    CHECK(othersOf(roles) == "9intensity 10Scalar_field_1 12t 13t_2 ");
    CHECK(roles.left == std::vector<std::size_t>{11, 14});
}

TEST_CASE("rolesByRange: unit vectors, colours, and one more", "[io][hand]") {
    const auto roles = [](std::vector<double> row) {
        std::vector<double> values = row;
        const std::size_t columns = row.size();
        values.insert(values.end(), row.begin(), row.end());
        return rolesByRange(table(columns, values));
    };
    CHECK(othersOf(roles({1, 2, 3})) == "");
    CHECK(othersOf(roles({1, 2, 3, -7})) == "3intensity ");
    CHECK(roles({1, 2, 3, 4, 5}).left == std::vector<std::size_t>{3, 4});
    CHECK(roles({1, 2, 3, 0.6, 0.8, 0}).normal.size() == 1);
    CHECK(roles({1, 2, 3, 200, 100, 50}).colour.size() == 1);
    CHECK(roles({1, 2, 3, -20, 100, 50}).left.size() == 3);
    struct Case {
        std::vector<double> row;
        std::size_t normal, colour;  // first columns, 0 for none
        const char* others;
    };
    for (const Case& c :
         {Case{{1, 2, 3, -1100, 200, 100, 50}, 0, 4, "3intensity "},
          Case{{1, 2, 3, 17, 200, 100, 50}, 0, 4, "3intensity "},
          Case{{1, 2, 3, 0.25, 200, 100, 50}, 0, 4, "3intensity "},
          Case{{1, 2, 3, 200, 100, 50, 0.25}, 0, 3, "6intensity "},
          Case{{1, 2, 3, 200, 100, 50, 3000}, 0, 3, "6intensity "},
          Case{{1, 2, 3, 0, 0, 1, 12}, 3, 0, "6intensity "},
          Case{{1, 2, 3, 12, 0, 0.6, -0.8}, 4, 0, "3intensity "},
          Case{{1, 2, 3, 0, 0, 1, 200, 100, 50}, 3, 6, ""}, Case{{1, 2, 3, 200, 100, 50, 0, 0, -1}, 6, 3, ""},
          Case{{1, 2, 3, 9, 200, 100, 50, 0, 0, -1}, 7, 4, "3intensity "},
          Case{{1, 2, 3, 0, 0, -1, 200, 100, 50, 9}, 3, 6, "9intensity "}}) {
        const ColumnRoles found = roles(c.row);
        CAPTURE(c.row);
        CHECK((found.normal.empty() ? 0 : found.normal[0][0]) == c.normal);
        CHECK((found.colour.empty() ? 0 : found.colour[0][0]) == c.colour);
        CHECK(othersOf(found) == c.others);
    }
    CHECK(roles({0, 0, 0, 0, 0, 0}).colour.size() == 1);  // black, not normals of no length
    const double nan = std::nan("");
    CHECK(rolesByRange(table(6, {nan, nan, nan, nan, nan, nan, 1, 2, 3, 0, 0, 1})).normal.size() == 1);
}

TEST_CASE("contentOf: attributes keep their numbers, doubts are said", "[io][hand]") {
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text + "\n"; };
    PointTable named = table(7, {1, 2, 3, 65535, 0, 13107, -5, 4, 5, 6, 0, 65535, 0, 7});
    named.names = {"x", "y", "z", "r", "g", "b", "heat"};
    const PointContent cloud = contentOf("a", named, ctx);
    CHECK(cloud.points[1].z == 6);
    CHECK(findAttribute(cloud.attributes, "Cd")->values == std::vector<float>{1, 0, 0.2f, 0, 1, 0});
    CHECK(findAttribute(cloud.attributes, "heat")->values == std::vector<float>{-5, 7});
    CHECK(said == "a: colours over 255 read as of 16 bits, 65535 is white\n");
    said.clear();
    named.values[3] = -1;
    CHECK_FALSE(findAttribute(contentOf("a", named, ctx).attributes, "Cd"));
    CHECK(test::contains(said, "colours left out"));
    said.clear();
    CHECK(contentOf("a", table(5, {1, 2, 3, 4, 5}), ctx).attributes.empty());
    CHECK(test::contains(said, "a: columns 4 and 5 left out"));
    CHECK(contentOf("a", table(2, {}), ctx).points.empty());
    CHECK(test::thrownBy([&] { contentOf("a", table(2, {1, 2}), ctx); }).code == int(ErrorCode::BadData));
}
