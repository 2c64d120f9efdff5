#include "libvdbsynth/io/readers/texture_seams.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

namespace {

MeshContent twoTriangles() {
    MeshContent content;
    content.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    content.polygons.add(corners, 3);
    content.polygons.add(corners + 3, 3);
    content.attributes = {{"heat", 1, {10, 11, 12, 13}}};
    return content;
}

}  // namespace

TEST_CASE("splitAtSeams: a point with two texture coordinates is duplicated once", "[io][hand]") {
    MeshContent content = twoTriangles();
    CHECK(splitAtSeams(content, {0, 1, 2, 3, 2, kNoTexture}, {0, 0, 1, 0, 1, 1, 0.5f, 0.25f}));
    CHECK(content.polygons.corners == std::vector<std::uint32_t>{0, 1, 2, 4, 2, 3});
    REQUIRE(content.points.size() == 5);
    CHECK(content.points[4].x == 0);
    CHECK(content.attributes[0].values == std::vector<float>{10, 11, 12, 13, 10});
    CHECK(content.attributes[1].name == "uv");
    CHECK(content.attributes[1].values == std::vector<float>{0, 0, 1, 0, 1, 1, 0, 0, 0.5f, 0.25f});
}

TEST_CASE("splitAtSeams: coordinates that are not finite add nothing", "[io][error]") {
    MeshContent content = twoTriangles();
    CHECK_FALSE(splitAtSeams(content, {0, 0, 0, 0, 0, 0}, {NAN, 0}));
    CHECK(content.attributes.size() == 1);
    CHECK(splitAtSeams(content, {1, 1, 1, 1, 1, 1}, {NAN, 0, 1, 0}));
}
