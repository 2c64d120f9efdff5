#include "libvdbsynth/patch/patch_size.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <cstdlib>

using namespace vdbsynth;

namespace {

PatchField wave(int nx, int ny, double alongX, double alongY) {
    return test::patchFieldFrom({1, nx, ny, 2}, [&](int i, int j, int k) {
        const double x = alongX > 0 ? sine(2 * kPi * i / alongX) : 0,
                     y = alongY > 0 ? sine(2 * kPi * j / alongY) : 0;
        return test::NodeValues{float(x + y + k), 0, 0, 0};
    });
}

// Patches of 6 columns, each of one random distance.
PatchField blocks(int side) {
    return test::patchFieldFrom({1, side, side, 1}, [&](int i, int j, int) {
        return test::NodeValues{float(Random(3, std::uint64_t(i / 6 * 100 + j / 6)).uniform(-1, 1)), 0, 0, 0};
    });
}

}  // namespace

TEST_CASE("patchFeature: the period of a texture that repeats, the larger of both axes'") {
    for (const double period : {6.0, 8.0, 11.0}) {
        const PatchFeature feature = patchFeature(wave(48, 48, period, period));
        CHECK(feature.columns == int(period));
        CHECK(feature.repeats);
    }
    CHECK(patchFeature(wave(48, 48, 6, 11)).columns == 11);
    CHECK(patchFeature(wave(48, 48, 11, 6)).columns == 11);
    const test::EggCrate crate;
    const PatchFeature crates = patchFeature(test::measuredField(test::eggCrateExemplar(crate, 48), 2));
    CHECK(crates.columns == 8);
    CHECK(crates.repeats);
}

TEST_CASE("patchFeature: the size of features that do not repeat") {
    const PatchFeature feature = patchFeature(blocks(240));
    CHECK(!feature.repeats);
    CHECK(feature.columns >= 4);
    CHECK(feature.columns <= 7);
    CHECK(patchFeature(test::noisePatchField({1, 40, 40, 2}, 1)).columns <= 2);
}

TEST_CASE("patchFeature: half the exemplar where nothing varies, along an axis or at all") {
    const PatchFeature flat = patchFeature(wave(30, 20, 0, 0));
    CHECK(flat.columns == 10);
    CHECK(!flat.repeats);
    const PatchFeature grooves = patchFeature(wave(40, 40, 8, 0));
    CHECK(grooves.columns == 20);
    CHECK(!grooves.repeats);
    const PatchFeature one = patchFeature(wave(1, 1, 0, 0));
    CHECK(one.columns == 1);
}

TEST_CASE("patchSide: by hand") {
    const auto side = [](int nx, int ny, int columns) {
        return patchSide(wave(nx, ny, 0, 0), {columns, true});
    };
    CHECK(side(48, 60, 8) == 12);
    CHECK(side(48, 60, 2) == 6);    // at least
    CHECK(side(48, 60, 30) == 32);  // at most
    CHECK(side(60, 48, 30) == 32);
    CHECK(side(6, 6, 3) == 4);
    CHECK(side(1, 9, 1) == 1);
    // Without a period a quarter of the shorter side.
    CHECK(patchSide(wave(48, 60, 0, 0), {2, false}) == 12);
    CHECK(patchSide(wave(48, 60, 0, 0), {10, false}) == 15);
}

TEST_CASE("patchFeature: same for any number of threads, and cancelled", "[patch][tsan]") {
    const PatchField field = blocks(40);
    const PatchFeature one = patchFeature(field, test::onThreads(1)),
                       three = patchFeature(field, test::onThreads(3));
    CHECK(one.columns == three.columns);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { patchFeature(field, ctx); }).code ==
          int(ErrorCode::Cancelled));
}

TEST_CASE("patchSides: as given, or as the exemplar says, and what does not fit") {
    const PatchField field = wave(48, 48, 12, 12);
    const PatchSides given = patchSides(field, 20, 0.3), found = patchSides(field, 0, 0);
    CHECK(given.patch == 20);
    CHECK(given.overlap == 6);
    CHECK(found.patch == patchSide(field, patchFeature(field)));
    CHECK(std::abs(3 * found.overlap - found.patch) <= 1);
    CHECK(patchSides(field, 48, 0.05).overlap == 2);
    CHECK(test::thrownBy([&] { patchSides(field, 49, 0); }).code == int(ErrorCode::Unusable));
    CHECK(test::thrownBy([&] { patchSides(field, 3, 0); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] { patchSides(wave(5, 5, 0, 0), 0, 0); }).code == int(ErrorCode::Unusable));
}
