#include "libvdbsynth/patch/layout/patch_seams.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <numeric>

using namespace vdbsynth;

namespace {

// Columns 0 and 1 of three by one of patch 0, the last of patch 1, which is read two columns farther.
PatchArrangement threeColumns() {
    PatchArrangement sheet;
    sheet.lattice = {1, 3, 1, 1};
    sheet.patches = {{{0, 0}, {0, 0}, 3, 1, {}, 0}, {{3, 0}, {1, 0}, 2, 1, {}, 0}};
    sheet.label = {0, 0, 1};
    return sheet;
}

PatchArrangement randomSheet(int nx, int ny, int nz) {
    PatchArrangement sheet;
    sheet.lattice = {1, nx, ny, nz};
    for (int p = 0; p < 3; ++p) sheet.patches.push_back({{p, 2 * p}, {0, 0}, nx, ny, {0.1 * p, 0, 0}, 0});
    for (std::size_t n = 0; n < sheet.lattice.nodes(); ++n)
        sheet.label.push_back(std::int32_t(Random(4, n).below(3)));
    return sheet;
}

}  // namespace

TEST_CASE("seamCosts: by hand") {
    const float distance[6] = {0, 1, 0.5f, -1, -0.25f, 3};
    const PatchField field = test::patchFieldFrom({1, 6, 1, 1}, [&](int i, int, int) {
        return test::NodeValues{distance[i], 0, 0, 0};
    });
    PatchArrangement sheet = threeColumns();
    // Between columns 1 and 2: |1 - (-1)| + |0.5 - (-0.25)|.
    const std::vector<double> costs = seamCosts(field, sheet, 0, 0, 3, 1);
    CHECK(costs == std::vector<double>{0, 2.75, 0});
    // Clamped to 1.5: |1 - (-0.25)| + |0.5 - 1.5|.
    sheet.patches[1].from.i = 4;
    CHECK(seamCosts(field, sheet, 0, 0, 3, 1)[1] == 2.25);
    // What the exemplar does not reach costs 3.
    sheet.patches[1].from.i = 5;
    CHECK(seamCosts(field, sheet, 0, 0, 3, 1)[1] == Approx(0.5 + 3));
    // Of one patch, or beside nothing, there is no seam.
    sheet.label = {0, 0, 0};
    CHECK(seamCosts(field, sheet, 0, 0, 3, 1) == std::vector<double>{0, 0, 0});
    sheet.label = {0, PatchArrangement::kNone, 1};
    CHECK(seamCosts(field, sheet, 0, 0, 3, 1) == std::vector<double>{0, 0, 0});
    // Around the ends of a tile.
    sheet = threeColumns();
    sheet.tile = true;
    const std::vector<double> around = seamCosts(field, sheet, 0, 0, 3, 1);
    CHECK(around[1] == 2.75);
    CHECK(around[2] > 0);
}

TEST_CASE("seamCosts: along z too, and moved by fractions of a step") {
    const PatchField field = test::patchFieldFrom({1, 4, 1, 2}, [](int i, int, int k) {
        return test::NodeValues{0.25f * float(i), k == 0 ? 1.f : 0.f, 0, 0};
    });
    PatchArrangement sheet;
    sheet.lattice = {1, 1, 1, 2};
    sheet.patches = {{{0, 0}, {0, 0}, 1, 1, {}, 0}, {{2, 0}, {0, 0}, 1, 1, {0.25, 0, 0}, 0}};
    sheet.label = {0, 1};
    CHECK(seamCosts(field, sheet, 0, 0, 1, 1) == std::vector<double>{0.25 + 0.5});
}

TEST_CASE("seamCosts: a part is that part of the whole, and beyond the sheet there is none") {
    const PatchField field = test::noisePatchField({1, 14, 14, 3}, 2);
    const PatchArrangement sheet = randomSheet(10, 9, 3);
    const std::vector<double> whole = seamCosts(field, sheet, 0, 0, 10, 9),
                              part = seamCosts(field, sheet, -1, 3, 6, 8);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 8; ++j) {
            const int si = i - 1, sj = j + 3;
            const double wanted = si < 0 || sj >= 9 ? 0 : whole[std::size_t(si * 9 + sj)];
            REQUIRE(part[std::size_t(i * 8 + j)] == wanted);
        }
}

TEST_CASE("seamCosts: same bits for any number of threads, and cancelled", "[patch][tsan]") {
    const PatchField field = test::noisePatchField({1, 50, 50, 3}, 2);
    const PatchArrangement sheet = randomSheet(40, 40, 3);
    CHECK(seamCosts(field, sheet, 0, 0, 40, 40, test::onThreads(1)) ==
          seamCosts(field, sheet, 0, 0, 40, 40, test::onThreads(3)));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              seamCosts(field, sheet, 0, 0, 40, 40, ctx);
          }).code == int(ErrorCode::Cancelled));
}
