#include "libvdbsynth/patch/patch_arrangement.h"

#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// A sheet of 10 x 8 columns of height 2 with two patches of 4 x 4, the second over the upper half of
// column (3, 1).
PatchArrangement twoPatches() {
    PatchArrangement arrangement;
    arrangement.lattice = {0.5, 10, 8, 2};
    arrangement.label.assign(arrangement.lattice.nodes(), PatchArrangement::kNone);
    arrangement.patches = {{{1, 2}, {0, 0}, 4, 4, {}, 0}, {{5, 5}, {3, 1}, 4, 4, {0.25, -0.5, 0}, 0}};
    for (int k = 0; k < 2; ++k) arrangement.label[arrangement.lattice.column(3, 1) * 2 + std::size_t(k)] = k;
    return arrangement;
}

}  // namespace

TEST_CASE("PatchArrangement: columns by hand, of a tile around its ends") {
    PatchArrangement sheet = twoPatches();
    CHECK(sheet.columnAt(3, 1) == 25);
    for (const PatchPlace out : {PatchPlace{-1, 0}, PatchPlace{0, -1}, PatchPlace{10, 0}, PatchPlace{0, 8}})
        CHECK(sheet.columnAt(out.i, out.j) == -1);
    CHECK(sheet.known(25));
    CHECK(!sheet.known(24));
    sheet.tile = true;
    CHECK(sheet.columnAt(13, 9) == 25);
    CHECK(sheet.columnAt(-7, -7) == 25);
    CHECK(sheet.columnAt(-27, -15) == 25);
}

TEST_CASE("shiftOf: from the exemplar to the sheet, by hand") {
    const PatchArrangement sheet = twoPatches();
    CHECK(length(shiftOf(sheet, 0) - Vec3d{-0.5, -1, 0}) < 1e-15);
    CHECK(length(shiftOf(sheet, 1) - Vec3d{-0.875, -2.25, 0}) < 1e-15);
}

TEST_CASE("sourceColumn: by hand, of a tile in the period that is nearest to the patch") {
    PatchArrangement sheet = twoPatches();
    CHECK(sourceColumn(sheet, sheet.patches[1], 3, 1) == PatchPlace{5, 5});
    CHECK(sourceColumn(sheet, sheet.patches[1], 6, 4) == PatchPlace{8, 8});
    CHECK(sourceColumn(sheet, sheet.patches[1], 0, 0) == PatchPlace{2, 4});
    sheet.tile = true;
    const LaidPatch across{{2, 3}, {8, 6}, 4, 4, {}, 0};  // over both ends
    CHECK(sourceColumn(sheet, across, 8, 6) == PatchPlace{2, 3});
    CHECK(sourceColumn(sheet, across, 1, 1) == PatchPlace{5, 6});
    CHECK(sourceColumn(sheet, across, 7, 5) == PatchPlace{1, 2});
    CHECK(sourceColumn(sheet, across, 2, 2) == PatchPlace{6, 7});
}

TEST_CASE("moveColumn: distances by the gradient, clamped, gradients as they are") {
    const float from[8] = {1, 0.5f, 0.25f, 0.8f, 2.9f, -1, 0, 0};
    float moved[8];
    moveColumn(from, 2, {0.5, -1, 2}, moved);
    CHECK(moved[0] == Approx(1 - (0.25 - 0.25 + 1.6)));
    CHECK(moved[4] == 3);
    for (const int v : {1, 2, 3, 5, 6, 7}) CHECK(moved[v] == from[v]);
}

TEST_CASE("readColumn: each node from its own patch") {
    const PatchArrangement sheet = twoPatches();
    const PatchField field = test::noisePatchField({0.5, 10, 10, 2}, 8);
    float values[8], upper[8];
    readColumn(field, sheet, 3, 1, values);
    const float* lower = field.column(4, 3);
    CHECK(std::equal(lower, lower + 4, values));
    moveColumn(field.column(5, 5), 2, sheet.patches[1].fine, upper);
    CHECK(std::equal(upper + 4, upper + 8, values + 4));
    // A tile is read around its ends.
    PatchArrangement tile = sheet;
    tile.tile = true;
    float around[8];
    readColumn(field, tile, 13, -7, around);
    CHECK(std::equal(values, values + 8, around));
}
