#include "libvdbsynth/patch/layout/patch_cut.h"

#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace vdbsynth;

namespace {

PatchArrangement emptySheet(int nx, int ny, int nz) {
    PatchArrangement sheet;
    sheet.lattice = {1, nx, ny, nz};
    sheet.label.assign(sheet.lattice.nodes(), PatchArrangement::kNone);
    return sheet;
}

bool lay(const PatchField& field, const LaidPatch& patch, int core, PatchArrangement& sheet) {
    sheet.patches.push_back(patch);
    return cutIntoSheet(field, std::int32_t(sheet.patches.size()) - 1, core, sheet);
}

std::int32_t labelAt(const PatchArrangement& sheet, int i, int j, int k) {
    return sheet.label[std::size_t(sheet.columnAt(i, j)) * std::size_t(sheet.lattice.nz) + std::size_t(k)];
}

// Patch 0 covers columns 0 to 7 of 12, patch 1 comes over columns 4 to 11.
PatchArrangement sideBySide(const PatchField& field, const PatchPlace& from, int ny) {
    PatchArrangement sheet = emptySheet(12, ny, field.lattice.nz);
    lay(field, {{0, 0}, {0, 0}, 8, ny, {}, 0}, -1, sheet);
    sheet.patches.push_back({from, {4, 0}, 8, ny, {}, 0});
    return sheet;
}

// The header's M of a node under two patches, in whole units.
double mismatch(const PatchField& field, const PatchArrangement& sheet, int i, int j, int k) {
    const LaidPatch &old = sheet.patches[0], &now = sheet.patches[1];
    const auto at = [&](const LaidPatch& p) {
        return double(field.distance(p.from.i + i - p.at.i, p.from.j + j - p.at.j, k));
    };
    const double a = at(old), b = at(now);
    const double apart = std::abs(std::clamp(a, -1.5, 1.5) - std::clamp(b, -1.5, 1.5));
    const double surface = std::abs(a) < 1 || std::abs(b) < 1 ? 0.05 : 0;
    return std::max(1.0, std::round(64 * (apart + surface + 0.005)));
}

// What a labelling of the overlap, columns [from, to), costs.
double costOf(const PatchField& field, const PatchArrangement& sheet, int from, int to) {
    const PatchLattice& l = sheet.lattice;
    double sum = 0;
    const auto pair = [&](int i, int j, int k, int oi, int oj, int ok) {
        if (oi >= to || oj >= l.ny || ok >= l.nz || labelAt(sheet, i, j, k) == labelAt(sheet, oi, oj, ok))
            return;
        sum += mismatch(field, sheet, i, j, k) + mismatch(field, sheet, oi, oj, ok);
    };
    for (int i = from; i < to; ++i)
        for (int j = 0; j < l.ny; ++j)
            for (int k = 0; k < l.nz; ++k) {
                pair(i, j, k, i + 1, j, k);
                pair(i, j, k, i, j + 1, k);
                pair(i, j, k, i, j, k + 1);
            }
    return sum;
}

void setLabel(PatchArrangement& sheet, int i, int j, int k, std::int32_t label) {
    sheet.label[sheet.lattice.column(i, j) * std::size_t(sheet.lattice.nz) + std::size_t(k)] = label;
}

}  // namespace

TEST_CASE("cutIntoSheet: a patch gets all columns where nothing lies, of a tile beyond its end too") {
    const PatchField field = test::noisePatchField({1, 10, 10, 2}, 1);
    PatchArrangement sheet = emptySheet(6, 6, 2);
    CHECK(lay(field, {{2, 3}, {4, 1}, 4, 3, {}, 0}, -1, sheet));
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) CHECK((labelAt(sheet, i, j, 1) == 0) == (i >= 4 && j >= 1 && j < 4));
    PatchArrangement tile = emptySheet(6, 6, 2);
    tile.tile = true;
    CHECK(lay(field, {{2, 3}, {4, 1}, 4, 3, {}, 0}, -1, tile));
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            CHECK((labelAt(tile, i, j, 0) == 0) == ((i >= 4 || i < 2) && j >= 1 && j < 4));
}

TEST_CASE("cutIntoSheet: runs where both agree, by hand") {
    // A wall that only the old patch has in columns 4 and 5, and only the new one in column 7.
    const PatchField field = test::patchFieldFrom({1, 20, 3, 1}, [](int i, int, int) {
        const bool wall = i == 4 || i == 5 || i == 15;
        return test::NodeValues{wall ? -3.f : 3.f, 0, 0, 0};
    });
    PatchArrangement sheet = sideBySide(field, {12, 0}, 3);
    CHECK(cutIntoSheet(field, 1, -1, sheet));
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 12; ++i) {
            CAPTURE(i, j);
            // 5 | 6 costs M(5) + M(6), 6 | 7 as much, 4 | 5 twice that. Of equal ones the new patch gets
            // less.
            CHECK(labelAt(sheet, i, j, 0) == (i < 7 ? 0 : 1));
        }
}

TEST_CASE("cutIntoSheet: a cut may run between two sheets") {
    // The same floor in both; above it, the old patch has a wall right, the new one left.
    const PatchField field = test::patchFieldFrom({1, 20, 4, 7}, [](int i, int, int k) {
        const bool wall = k >= 4 && (i == 6 || i == 13);
        return test::NodeValues{k == 0 || wall ? -3.f : 3.f, 0, 0, 0};
    });
    PatchArrangement sheet = sideBySide(field, {12, 0}, 4);
    CHECK(cutIntoSheet(field, 1, -1, sheet));
    for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 7; ++k) {
            CHECK(labelAt(sheet, 4, j, k) == 0);
            CHECK(labelAt(sheet, 7, j, k) == 1);
        }
    // Neither through the one wall nor through the other: both lie on one side, whole.
    for (int j = 0; j < 4; ++j) CHECK(labelAt(sheet, 5, j, 5) == labelAt(sheet, 6, j, 5));
}

TEST_CASE("cutIntoSheet: the least of all cuts, tried one by one") {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const PatchField field = test::noisePatchField({1, 20, 2, 2}, seed);
        PatchArrangement sheet = sideBySide(field, {12, 0}, 2);
        CHECK(cutIntoSheet(field, 1, -1, sheet));
        const double found = costOf(field, sheet, 4, 8);
        double least = std::numeric_limits<double>::infinity();
        PatchArrangement tried = sheet;
        for (unsigned answers = 0; answers < 256; ++answers) {
            for (int n = 0; n < 8; ++n)
                setLabel(tried, 5 + (n >> 2), n >> 1 & 1, n & 1, std::int32_t(answers >> n & 1));
            least = std::min(least, costOf(field, tried, 4, 8));
        }
        CAPTURE(seed);
        CHECK(found == least);
    }
}

TEST_CASE("cutIntoSheet: never above a straight cut, and its sides hold") {
    // The second has over 6000 nodes in its overlap, which are cut by cells of two.
    for (const bool large : {false, true}) {
        const int ny = large ? 50 : 9, nz = large ? 9 : 3, width = large ? 16 : 6;
        const PatchField field = test::noisePatchField({1, 60, ny, nz}, 9);
        PatchArrangement sheet = emptySheet(40, ny, nz);
        lay(field, {{0, 0}, {0, 0}, 20, ny, {}, 0}, -1, sheet);
        const int first = 20 - width;
        CHECK(lay(field, {{35, 0}, {first, 0}, 20, ny, {}, 0}, -1, sheet));
        for (int j = 0; j < ny; ++j)
            for (int k = 0; k < nz; ++k) {
                for (int i = 0; i <= first; ++i) REQUIRE(labelAt(sheet, i, j, k) == 0);
                for (int i = 19; i < first + 20; ++i) REQUIRE(labelAt(sheet, i, j, k) == 1);
                REQUIRE(labelAt(sheet, first + 20, j, k) == PatchArrangement::kNone);
            }
        const double found = costOf(field, sheet, first, 20);
        PatchArrangement straight = sheet;
        for (int at = first + (large ? 2 : 1); at < 20; at += large ? 2 : 1) {
            for (int i = first; i < 20; ++i)
                for (int j = 0; j < ny; ++j)
                    for (int k = 0; k < nz; ++k) setLabel(straight, i, j, k, i < at ? 0 : 1);
            CHECK(found <= costOf(field, straight, first, 20));
        }
        CHECK(found > 0);
    }
}

TEST_CASE("cutIntoSheet: over what is covered only a core gives it anything") {
    const PatchField field = test::noisePatchField({1, 20, 20, 2}, 3);
    PatchArrangement sheet = emptySheet(12, 12, 2);
    lay(field, {{0, 0}, {0, 0}, 12, 12, {}, 0}, -1, sheet);
    const std::vector<std::int32_t> before = sheet.label;
    PatchArrangement without = sheet;
    CHECK(!lay(field, {{8, 8}, {2, 2}, 7, 7, {}, 0}, -1, without));
    CHECK(without.label == before);
    CHECK(lay(field, {{8, 8}, {2, 2}, 7, 7, {}, 0}, 1, sheet));
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
            for (int k = 0; k < 2; ++k) {
                if (i >= 4 && i <= 6 && j >= 4 && j <= 6) CHECK(labelAt(sheet, i, j, k) == 1);
                if (i <= 2 || j <= 2 || i >= 8 || j >= 8) CHECK(labelAt(sheet, i, j, k) == 0);
            }
    // An even side has two middle columns.
    PatchArrangement even = emptySheet(12, 12, 2);
    lay(field, {{0, 0}, {0, 0}, 12, 12, {}, 0}, -1, even);
    CHECK(lay(field, {{8, 8}, {2, 2}, 6, 6, {}, 0}, 0, even));
    for (const int i : {4, 5})
        for (const int j : {4, 5}) CHECK(labelAt(even, i, j, 1) == 1);
}

TEST_CASE("cutIntoSheet: by the distances of patches moved by fractions of a step") {
    // A slope: moved by half a step the new patch's distances are those of the old one at every node.
    const PatchField field = test::patchFieldFrom({1, 20, 3, 1}, [](int i, int, int) {
        return test::NodeValues{i < 10 ? 0.1f * float(i) : 0.1f * float(i - 8) + 0.05f, 0.1f, 0, 0};
    });
    PatchArrangement sheet = emptySheet(12, 3, 1);
    lay(field, {{0, 0}, {0, 0}, 8, 3, {}, 0}, -1, sheet);
    CHECK(lay(field, {{12, 0}, {4, 0}, 8, 3, {0.5, 0, 0}, 0}, -1, sheet));
    // So all cuts cost the same, and the new patch gets what it must.
    for (int i = 0; i < 12; ++i) CHECK(labelAt(sheet, i, 1, 0) == (i < 7 ? 0 : 1));
}
