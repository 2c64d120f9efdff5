#include "libvdbsynth/map/exemplar_variant.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {
constexpr std::array<bool, 3> kAll{true, true, true};
}

TEST_CASE("variantOf: a quarter turn is a change of indices", "[synth][oracle]") {
    const BrickField field = test::ballsField({20, 24, 16}, 3, 6.f);
    ExemplarVariant variant;
    variant.rotation = {0, 0, kPi / 2};
    variant.size = variantSize({20, 24, 16}, variant.rotation, 1, kAll);
    REQUIRE(variant.size == Index3{24, 20, 16});
    const BrickField turned = variantOf(field, variant, 6.f);
    // x goes to y, y to -x.
    for (int x = 0; x < 20; ++x)
        for (int y = 0; y < 24; ++y)
            for (int z = 0; z < 16; ++z)
                REQUIRE(turned.at({23 - y, x, z}) == Approx(field.at({x, y, z})).margin(1e-3));
    const BrickField mask = variantMask({20, 24, 16}, variant, nullptr);
    for (float value : test::samplesOf(mask)) REQUIRE(value == 1.f);
}

TEST_CASE("variantOf: a ball twice as large, distances and all", "[synth][oracle]") {
    const auto ball = [](const Index3& size, double radius) {
        return test::fieldFrom(size, [=](const Index3& p) {
            const Vec3d c{(size.x - 1) / 2.0, (size.y - 1) / 2.0, (size.z - 1) / 2.0};
            return float(
                std::clamp(length(Vec3d{double(p.x), double(p.y), double(p.z)} - c) - radius, -8.0, 8.0));
        });
    };
    ExemplarVariant variant;
    variant.scale = 2;
    variant.rotation = {0.3, -1.1, 0.4};
    variant.size = variantSize({40, 40, 40}, variant.rotation, 2, kAll);
    const BrickField large = variantOf(ball({40, 40, 40}, 9), variant, 8.f);
    const BrickField expected = ball(variant.size, 18);
    for (int i = 0; i < variant.size.x; i += 3) {
        const Index3 p{i, variant.size.y / 2 + i % 7, variant.size.z / 2 - i % 5};
        CHECK(large.at(p) == Approx(expected.at(p)).margin(0.15));
    }
    // A corner of the box lies beyond the turned exemplar.
    const BrickField mask = variantMask({40, 40, 40}, variant, nullptr);
    CHECK(mask.at({0, 0, 0}) == 0.f);
    CHECK(mask.at({variant.size.x / 2, variant.size.y / 2, variant.size.z / 2}) == 1.f);
    const BrickField wider =
        variantMask({40, 40, 40}, variant, nullptr, {true, true, true, true, true, true});
    CHECK(wider.at({0, 0, 0}) == 1.f);
    CHECK(variantSize({40, 40, 24}, {0, 0, 0.5}, 1.5, {true, true, false}).z == 24);
}

TEST_CASE("chooseVariants: near everything that is wanted, few", "[synth][property]") {
    std::vector<WantedVariant> wanted;
    for (int i = 0; i < 2000; ++i) wanted.push_back({i % 2, {0, 0, i * 2 * kPi / 2000}, i % 3 ? 1.0 : 1.3});
    const ChosenVariants chosen = chooseVariants(wanted);
    REQUIRE(chosen.number.size() == wanted.size());
    CHECK(chosen.variants.size() <= 48);
    CHECK(chosen.variants.size() > 10);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const ExemplarVariant& variant = chosen.variants[std::size_t(chosen.number[i])];
        REQUIRE(variant.exemplar == wanted[i].exemplar);
        REQUIRE(similarity(variant.rotation, wanted[i].rotation) >=
                cosine(chosen.tolerance * kPi / 360) - 1e-12);
    }
    const ChosenVariants one = chooseVariants({{0, {0, 0, 0}, 1}, {0, {0, 0, 2 * kPi}, 1}});
    CHECK(one.variants.size() == 1);
    CHECK(one.variants.front().plain());
}
