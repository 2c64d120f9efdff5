#include "libvdbsynth/map/source_attributes.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// Two vertices with sources, one without.
ElementSources someVertices() {
    Source whole, between;
    whole.position = {3, -4, 5};
    between.exemplar = 2;
    between.position = {-1000000.25, 7.5, 16777215};
    between.rotation = {0, 0, float(kPi / 2)};
    between.scale = 1.5f;
    ElementSources sources(ElementKind::Vertex);
    sources.add({whole});
    sources.add(std::vector<Source>{});
    sources.add({between});
    return sources;
}

AttributeReader reader(bool direction) {
    AttributeReader reader;
    reader.name = "up";
    reader.width = 3;
    reader.direction = direction;
    reader.read = [](std::int32_t exemplar, const Vec3d& position, float* out) {
        if (exemplar == 9) return false;
        out[0] = float(position.x);
        out[1] = float(exemplar);
        out[2] = 1;
        return true;
    };
    return reader;
}

}  // namespace

TEST_CASE("sourceAttributes: to attributes and back it is the same map", "[map][property]") {
    const ElementSources before = someVertices();
    Attributes attributes = sourceAttributes(before);
    CHECK(attributes.size() == 5);  // no weights, all are 1
    attributes.push_back({"Cd", 3, std::vector<float>(9, 0.5f)});
    const ElementSources after = sourcesFromAttributes(attributes, ElementKind::Vertex);
    REQUIRE(after.size() == before.size());
    CHECK(after.strongest(1) == nullptr);
    for (std::size_t i : {0u, 2u}) {
        const Source &a = *before.strongest(i), &b = *after.strongest(i);
        CHECK(a.exemplar == b.exemplar);
        CHECK(length(a.position - b.position) == 0);
        CHECK(length(a.rotation - b.rotation) == 0);
        CHECK(a.scale == b.scale);
    }
}

TEST_CASE("sourcesFromAttributes: what is no map is refused", "[map][error]") {
    const auto message = [](const Attributes& attributes) {
        return test::thrownBy([&] { sourcesFromAttributes(attributes, ElementKind::Point); }).message;
    };
    CHECK(test::contains(message({}), "are missing"));
    const Attributes good = sourceAttributes(someVertices());
    Attributes bad = good;
    bad[0].values.pop_back();
    CHECK(test::contains(message(bad), "\"source\" is not 3 numbers"));
    bad = good;
    bad[1].values[0] = 0.5f;
    CHECK(test::contains(message(bad), "invalid numbers"));
    bad = good;
    bad[0].values[1] = NAN;
    CHECK(test::contains(message(bad), "invalid numbers"));
    CHECK(test::thrownBy([] { sourceAttributes(ElementSources()); }).code == int(ErrorCode::InvalidOption));
    Source far;
    far.position = {3e7, 0, 0};
    ElementSources beyond(ElementKind::Point);
    beyond.add({far});
    CHECK(test::contains(test::thrownBy([&] { sourceAttributes(beyond); }).message, "2^24"));
}

TEST_CASE("transferredAttribute: copied, blended and rotated by hand", "[map][oracle]") {
    Source first, second, nowhere;
    first.position = {2, 0, 0};
    first.weight = 3;
    second.position = {6, 0, 0};
    second.exemplar = 1;
    second.weight = 1;
    nowhere.exemplar = 9;
    nowhere.weight = 8;
    ElementSources points(ElementKind::Point);
    points.add({first, second, nowhere});
    points.add({nowhere});
    using Values = std::vector<float>;
    // The strongest has no value, so the next one's is copied; its weight does not count in the mean.
    CHECK(transferredAttribute(points, reader(false), false).values == Values{2, 0, 1, 0, 0, 0});
    CHECK(transferredAttribute(points, reader(false), true).values == Values{3, 0.25f, 1, 0, 0, 0});
    first.rotation = {0, 0, float(kPi / 2)};
    ElementSources rotated(ElementKind::Point);
    rotated.add({first});
    const Values turned = transferredAttribute(rotated, reader(true), true).values;
    CHECK(turned[0] == Approx(0).margin(1e-6));
    CHECK(turned[1] == Approx(2));
    CHECK(transferredAttribute(rotated, reader(false), true).values[0] == 2);
    AttributeReader wide = reader(false);
    wide.width = 4;
    CHECK(test::thrownBy([&] { transferredAttribute(points, wide, true); }).code ==
          int(ErrorCode::InvalidOption));
}
