#include "libvdbsynth/measure/patch_distribution.h"

#include "libvdbsynth/math/trigonometry.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

namespace {

std::shared_ptr<const BrickField> shared(BrickField field) {
    return std::make_shared<const BrickField>(std::move(field));
}

PatchSource sourceOf(const std::shared_ptr<const BrickField>& field, std::size_t limit = 30000) {
    PatchSourceOptions options;
    options.box = field->box();
    options.limit = limit;
    return patchSource(field, options);
}

std::vector<float> patchAt(const BrickField& field, const Index3& corner) {
    std::vector<float> samples(kPatchSide * kPatchSide * kPatchSide);
    field.readBox(corner, {kPatchSide, kPatchSide, kPatchSide}, samples.data());
    return samples;
}

double meanSquare(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (double(a[i]) - double(b[i])) * (double(a[i]) - double(b[i]));
    return sum / double(a.size());
}

}  // namespace

TEST_CASE("patchSource: exactly the places whose middle has both signs", "[measure][oracle]") {
    const auto field = shared(test::ballsField({33, 30, 70}, 6, 3.f, 8));
    const PatchSource source = sourceOf(field, 1000000);
    std::vector<Index3> expected;
    for (int x = 0; x <= 33 - kPatchSide; ++x)
        for (int y = 0; y <= 30 - kPatchSide; ++y)
            for (int z = 0; z <= 70 - kPatchSide; ++z) {
                int negative = 0;
                for (int n = 0; n < 64; ++n)
                    negative += field->at({x + 2 + n / 16, y + 2 + n / 4 % 4, z + 2 + n % 4}) < 0;
                if (negative > 0 && negative < 64) expected.push_back({x, y, z});
            }
    CHECK(source.scales.front().places == expected);
    const PatchSource drawn = sourceOf(field, 50);
    CHECK(drawn.scales.front().places.size() == 50);
    for (const Index3& place : drawn.scales.front().places)
        CHECK(std::find(expected.begin(), expected.end(), place) != expected.end());
    CHECK(sourceOf(shared(BrickField(field->box(), 1.f))).scales.empty());
}

TEST_CASE("slicedWasserstein: nothing to itself, and sqrt(2 / pi) times a constant that is added",
          "[measure][oracle]") {
    const auto a = shared(test::ballsField({40, 40, 40}, 6, 3.f, 10));
    const auto b = shared(test::fieldFrom({40, 40, 40}, [&](const Index3& p) { return a->at(p) + 0.1f; }));
    PatchScale ofA = sourceOf(a).scales.front(), ofB = ofA;
    ofB.field = b;
    CHECK(slicedWasserstein(project(ofA, 1000), project(ofA, 1000)) == 0);
    // The sum of a random unit vector's components is normal with variance 1.
    CHECK(slicedWasserstein(project(ofA, 1000), project(ofB, 1000)) ==
          Approx(0.1 * std::sqrt(2 / kPi)).epsilon(0.15));
    CHECK(slicedWasserstein(project(ofA, 1000), Projections{}) == 0);
}

TEST_CASE("within: patches inside a box and those not inside are all of them", "[measure][property]") {
    const auto field = shared(test::ballsField({48, 48, 48}, 6, 3.f, 12));
    const PatchSource source = sourceOf(field);
    for (int scale = 0; scale < 2; ++scale) {
        const Projections all = project(source.scales[std::size_t(scale)], 500);
        const IndexBox box{{0, 0, 0}, {47, 47, 30}};
        const Projections inside = within(all, box, scale), outside = within(all, box, scale, false);
        CHECK(inside.places.size() + outside.places.size() == all.places.size());
        for (const Index3& place : inside.places) CHECK((place.z + kPatchSide) * (1 << scale) <= 31);
        CHECK(inside.values.front().size() == inside.places.size());
    }
}

TEST_CASE("matchPatches: finds what a search over all places finds, and copies at places not drawn",
          "[measure][oracle]") {
    const auto a = shared(test::ballsField({36, 36, 36}, 1, 3.f, 9));
    const auto b = shared(test::ballsField({36, 36, 36}, 2, 3.f, 9));
    const PatchScale from = sourceOf(b, 1000000).scales.front(), to = sourceOf(a, 1000000).scales.front();
    const PatchMatches matches = matchPatches(from, to, 25, 1e30);
    REQUIRE(matches.from.size() == 25);
    for (std::size_t i = 0; i < matches.from.size(); ++i) {
        const std::vector<float> query = patchAt(*b, matches.from[i]);
        double best = 1e30;
        for (const Index3& place : to.places) best = std::min(best, meanSquare(query, patchAt(*a, place)));
        CHECK(matches.costs[i] <= best * (1 + 1e-5));
        CHECK(matches.costs[i] == Approx(meanSquare(query, patchAt(*a, matches.to[i]))).margin(1e-6));
        // Over the places it is exact; downhill from the best may leave them, for less.
        if (std::find(to.places.begin(), to.places.end(), matches.to[i]) != to.places.end())
            CHECK(matches.costs[i] == Approx(best).margin(1e-6));
    }
    const PatchScale few = sourceOf(a, 400).scales.front();
    const PatchMatches copies = matchPatches(to, few, 200, 1e30);
    const auto exact = std::count(copies.costs.begin(), copies.costs.end(), 0.0);
    CHECK(exact > 100);
    CHECK(matchPatches(to, few, 200, 1e-9).mean <= 1e-9);
    RunContext one;
    one.threads = 1;
    CHECK(matchPatches(from, to, 25, 1e30, one).costs == matches.costs);
}
