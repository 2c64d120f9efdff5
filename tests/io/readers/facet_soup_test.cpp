#include "libvdbsynth/io/readers/facet_soup.h"

#include <catch2/catch.hpp>

#include <limits>
#include <vector>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

using namespace vdbsynth;

namespace {

void add(FacetSoup& soup, const std::vector<Vec3f>& corners) {
    std::vector<Vec3d> points;
    for (const Vec3f& p : corners) points.push_back(cast<double>(p));
    soup.add(corners.data(), points.data(), corners.size());
}

const Vec3f kA{0, 0, 0}, kB{1, 0, 0}, kC{0, 1, 0}, kD{0, 0, 1};

}  // namespace

TEST_CASE("FacetSoup: equal corners are one vertex, minus zero is zero", "[io][oracle]") {
    FacetSoup soup;
    add(soup, {kA, kB, kC});
    add(soup, {{-0.f, 0, 0}, kC, kD});
    const MeshContent mesh = soup.take("a", {});
    CHECK(mesh.points.size() == 4);
    CHECK(mesh.polygons.corners == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
}

TEST_CASE("FacetSoup: facets without an area of their own become no face", "[io][degenerate]") {
    FacetSoup soup;
    CHECK_FALSE(soup.isClosed());
    add(soup, {kA, kA, kC});
    add(soup, {kA, kB, kA});
    add(soup, {kA, kB, kB, kC, kA});
    CHECK(soup.facets() == 3);
    CHECK(soup.take("a", {}).polygons.sizes == std::vector<std::uint32_t>{3});
}

TEST_CASE("FacetSoup: closed if every edge has an even number of faces", "[io][oracle]") {
    FacetSoup soup;
    add(soup, {kA, kC, kB});
    add(soup, {kA, kB, kD});
    add(soup, {kB, kC, kD});
    CHECK_FALSE(soup.isClosed());
    add(soup, {kA, kD, kC});
    CHECK(soup.isClosed());
}

TEST_CASE("FacetSoup: facets that are not finite are left out, unless they are most", "[io][error]") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
    test::Said said;
    FacetSoup soup;
    add(soup, {kA, kB, kC});
    add(soup, {kA, kB, {nan, 0, 0}});
    CHECK(soup.take("a", said.ctx).polygons.sizes.size() == 1);
    CHECK(said.warned("a: 1 of 2 triangles have a coordinate that is not a finite number"));
    add(soup, {kA, {0, far, 0}, kC});
    const test::Thrown thrown = test::thrownBy([&] { soup.take("a", {}); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "1 of 1 triangles"));
}
