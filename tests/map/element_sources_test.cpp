#include "libvdbsynth/map/element_sources.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

namespace {

Source sourceAt(double x, float weight = 1, std::int32_t exemplar = 0) {
    Source source;
    source.exemplar = exemplar;
    source.position = {x, 2 * x, 0.5};
    source.weight = weight;
    return source;
}

}  // namespace

TEST_CASE("ElementSources: elements keep their sources, strongest first, equal ones in order", "[map]") {
    ElementSources points(ElementKind::Point);
    points.add({sourceAt(1, 0.2f), sourceAt(2, 0.5f), sourceAt(3, 0.5f)});
    points.add(std::vector<Source>{});
    points.add({sourceAt(4)});
    REQUIRE(points.size() == 3);
    CHECK(points.voxels().empty());
    std::vector<double> order;
    for (const Source& source : points[0]) order.push_back(source.position.x);
    CHECK(order == std::vector<double>{2, 3, 1});
    CHECK(points.strongest(0)->position.x == 2);
    CHECK(points.strongest(1) == nullptr);
    CHECK(points[1].empty());
    CHECK(points.strongest(2)->position.y == 8);
}

TEST_CASE("ElementSources: voxels are known by their place", "[map]") {
    ElementSources voxels;
    voxels.add({5, -6, 7}, sourceAt(1));
    voxels.add({0, 0, 0}, sourceAt(2));
    REQUIRE(voxels.size() == 2);
    CHECK(voxels.voxels()[0] == Index3{5, -6, 7});
    CHECK(voxels.strongest(1)->position.x == 2);
    const ElementSources copy = voxels;
    voxels = ElementSources(ElementKind::Corner);
    CHECK(copy.strongest(0)->position.x == 1);  // nothing points into what it was copied from
}

TEST_CASE("ElementSources: what is no source, or of another kind, is refused", "[map][error]") {
    ElementSources voxels, corners(ElementKind::Corner);
    const auto code = [](const std::function<void()>& body) { return test::thrownBy(body).code; };
    CHECK(code([&] { voxels.add({sourceAt(1)}); }) == int(ErrorCode::InvalidOption));
    CHECK(code([&] { corners.add({0, 0, 0}, sourceAt(1)); }) == int(ErrorCode::InvalidOption));
    CHECK(code([&] { corners.add({sourceAt(1, 0.f)}); }) == int(ErrorCode::InvalidOption));
    CHECK(code([&] { corners.add({sourceAt(1, NAN)}); }) == int(ErrorCode::InvalidOption));
    CHECK(code([&] { corners.add({sourceAt(INFINITY)}); }) == int(ErrorCode::InvalidOption));
}
