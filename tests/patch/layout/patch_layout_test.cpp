#include "libvdbsynth/patch/layout/patch_layout.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/layout/patch_seams.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <numeric>

using namespace vdbsynth;

namespace {

LayoutOptions optionsFor(int patch, int overlap) {
    LayoutOptions options;
    options.patch = patch;
    options.overlap = overlap;
    return options;
}

double seamsOf(const PatchField& field, const PatchArrangement& sheet) {
    const auto costs = seamCosts(field, sheet, 0, 0, sheet.lattice.nx, sheet.lattice.ny);
    return std::accumulate(costs.begin(), costs.end(), 0.0);
}

bool same(const PatchArrangement& a, const PatchArrangement& b) {
    if (a.label != b.label || a.patches.size() != b.patches.size()) return false;
    for (std::size_t p = 0; p < a.patches.size(); ++p)
        if (!(a.patches[p].from == b.patches[p].from) || !(a.patches[p].at == b.patches[p].at) ||
            length(a.patches[p].fine - b.patches[p].fine) != 0 || a.patches[p].cost != b.patches[p].cost)
            return false;
    return true;
}

void requireWhole(const PatchField& field, const PatchArrangement& sheet) {
    for (const std::int32_t label : sheet.label)
        REQUIRE((label >= 0 && label < std::int32_t(sheet.patches.size())));
    for (const LaidPatch& patch : sheet.patches) {
        REQUIRE((patch.from.i >= 0 && patch.from.i + patch.nx <= field.lattice.nx));
        REQUIRE((patch.from.j >= 0 && patch.from.j + patch.ny <= field.lattice.ny));
        REQUIRE(std::max(std::abs(patch.fine.x), std::abs(patch.fine.y)) <= 1);
    }
    // Every node's source is in its patch.
    for (int i = 0; i < sheet.lattice.nx; ++i)
        for (int j = 0; j < sheet.lattice.ny; ++j) {
            const LaidPatch& patch =
                sheet.patches[std::size_t(sheet.label[sheet.lattice.column(i, j) * sheet.lattice.nz])];
            const PatchPlace source = sourceColumn(sheet, patch, i, j);
            REQUIRE((source.i >= patch.from.i && source.i < patch.from.i + patch.nx));
            REQUIRE((source.j >= patch.from.j && source.j < patch.from.j + patch.ny));
        }
}

// How far a shift is from those that take the texture, of a period of 8 columns, into itself.
double offPeriod(const PatchArrangement& sheet, std::size_t patch) {
    const Vec3d shift = (shiftOf(sheet, std::int32_t(patch)) - shiftOf(sheet, 0)) * (1 / sheet.lattice.step);
    const double x = shift.x - 4 * std::round(shift.x / 4), y = shift.y - 4 * std::round(shift.y / 4);
    // Half a period along one axis alone turns it over.
    REQUIRE(int(std::round(shift.x / 4) + std::round(shift.y / 4)) % 2 == 0);
    return std::max(std::abs(x), std::abs(y));
}

const PatchField& crateField() {
    static const PatchField field = test::measuredField(test::eggCrateExemplar({}, 48), 2);
    return field;
}

}  // namespace

TEST_CASE("layPatches: a sheet smaller than a patch is one, and a larger one is covered") {
    const PatchField& field = crateField();
    const PatchArrangement one = layPatches(field, 7, 3, optionsFor(12, 3));
    CHECK(one.patches.size() == 1);
    CHECK(one.patches[0].nx == 7);
    CHECK(one.patches[0].ny == 3);
    requireWhole(field, one);
    CHECK(layPatches(field, 1, 1, optionsFor(12, 3)).patches.size() == 1);
    LayoutOptions options = optionsFor(12, 3);
    options.repairs = 0;
    // Evenly spread: 12, then 9 more each.
    const PatchArrangement sheet = layPatches(field, 30, 12, options);
    REQUIRE(sheet.patches.size() == 3);
    CHECK(sheet.patches[1].at == PatchPlace{9, 0});
    CHECK(sheet.patches[2].at == PatchPlace{18, 0});
    requireWhole(field, sheet);
}

TEST_CASE("layPatches: of a texture that repeats every patch lies in phase, and none continues another") {
    const PatchField& field = crateField();
    for (const bool tile : {false, true}) {
        LayoutOptions options = optionsFor(12, 3);
        options.tile = tile;
        options.repairs = tile ? 2 : 0;
        const PatchArrangement sheet = layPatches(field, 64, 40, options);
        requireWhole(field, sheet);
        for (std::size_t p = 0; p < sheet.patches.size(); ++p) CHECK(offPeriod(sheet, p) < 0.15);
        CHECK(sheet.patches[0].cost == 0);
        if (tile) continue;
        // The next one along y does not take up where the last one ends.
        for (std::size_t p = 1; p < sheet.patches.size(); ++p) {
            const LaidPatch &a = sheet.patches[p - 1], &b = sheet.patches[p];
            if (a.at.i == b.at.i)
                CHECK((b.from.i - a.from.i != b.at.i - a.at.i || b.from.j - a.from.j != b.at.j - a.at.j));
        }
    }
}

TEST_CASE("layPatches: mending seams makes them cheaper, in a tile too") {
    const PatchField field =
        test::measuredField(test::exemplarOf(test::eggCratePoints({13.3, 3}, 60, 8, 0.4), 60, -5, 5), 2);
    for (const bool tile : {false, true}) {
        LayoutOptions options = optionsFor(10, 3);
        options.tile = tile;
        options.repairs = 0;
        const PatchArrangement before = layPatches(field, 60, 50, options);
        options.repairs = 4;
        const PatchArrangement after = layPatches(field, 60, 50, options);
        requireWhole(field, after);
        CHECK(seamsOf(field, after) <= seamsOf(field, before));
        CHECK(after.patches.size() >= before.patches.size());
    }
}

TEST_CASE("layPatches: an exemplar as large as the patch, and one of nothing, still give a sheet") {
    const PatchField small = test::noisePatchField({1, 8, 8, 2}, 3);
    requireWhole(small, layPatches(small, 30, 21, optionsFor(8, 3)));
    const PatchField empty = test::patchFieldFrom({1, 12, 12, 2}, [](int, int, int) {
        return test::NodeValues{3, 0, 0, 0};
    });
    requireWhole(empty, layPatches(empty, 30, 21, optionsFor(8, 3)));
    requireWhole(small, layPatches(small, 9, 9, optionsFor(2, 1)));
}

TEST_CASE("layPatches: what is refused") {
    const PatchField field = test::noisePatchField({1, 12, 10, 2}, 3);
    const auto code = [&](int nx, int ny, const LayoutOptions& options) {
        return test::thrownBy([&] { layPatches(field, nx, ny, options); }).code;
    };
    const int invalid = int(ErrorCode::InvalidOption);
    LayoutOptions good = optionsFor(6, 2);
    CHECK(code(8, 8, good) == -1);
    CHECK(code(0, 8, good) == invalid);
    CHECK(code(8, 0, good) == invalid);
    CHECK(code(8, 8, optionsFor(1, 1)) == invalid);
    CHECK(code(8, 8, optionsFor(6, 0)) == invalid);
    CHECK(code(8, 8, optionsFor(6, 6)) == invalid);
    CHECK(code(8, 8, optionsFor(11, 2)) == int(ErrorCode::Unusable));
    for (const double tolerance : {-0.1, 10.1, std::nan("")}) {
        LayoutOptions bad = good;
        bad.tolerance = tolerance;
        CHECK(code(8, 8, bad) == invalid);
    }
    for (const int repairs : {-1, 21}) {
        LayoutOptions bad = good;
        bad.repairs = repairs;
        CHECK(code(8, 8, bad) == invalid);
    }
    RunContext tight;
    tight.maxMemory = 1000;
    CHECK(test::thrownBy([&] { layPatches(field, 80, 80, good, tight); }).code == int(ErrorCode::Memory));
    LayoutOptions tile = good;
    tile.tile = true;
    CHECK(code(7, 8, tile) == invalid);
    CHECK(code(8, 7, tile) == invalid);
    CHECK(code(8, 8, tile) == -1);
}

TEST_CASE("layPatches: same bits for any number of threads, another seed another sheet, cancelled",
          "[patch][tsan]") {
    const PatchField& field = crateField();
    const LayoutOptions options = optionsFor(12, 3);
    RunContext other = test::onThreads(2);
    other.seed = 5;
    const PatchArrangement one = layPatches(field, 40, 40, options, test::onThreads(1));
    CHECK(same(one, layPatches(field, 40, 40, options, test::onThreads(3))));
    CHECK(!same(one, layPatches(field, 40, 40, options, other)));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              layPatches(field, 40, 40, options, ctx);
          }).code == int(ErrorCode::Cancelled));
}
