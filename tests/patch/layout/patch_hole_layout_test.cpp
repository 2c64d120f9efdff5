#include "libvdbsynth/patch/layout/patch_hole_layout.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/layout/patch_seams.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <numeric>

using namespace vdbsynth;

namespace {

// An egg-crate of 48 columns of half a period of 8, with a hole; its values there are wrong.
struct Holed {
    PatchField field;
    std::vector<std::uint8_t> hole;
    BarredColumns barred;

    Holed(PatchField measured, int i0, int i1, int j0, int j1)
        : field(std::move(measured)),
          hole(marked(field.lattice, i0, i1, j0, j1)),
          barred(field.lattice, hole) {
        for (std::size_t c = 0; c < hole.size(); ++c)
            if (hole[c])
                std::fill_n(field.values.begin() + std::ptrdiff_t(c * field.columnLength()),
                            field.columnLength(), 0.f);
    }
    static std::vector<std::uint8_t> marked(const PatchLattice& l, int i0, int i1, int j0, int j1) {
        std::vector<std::uint8_t> hole(l.columns(), 0);
        for (int i = i0; i < i1; ++i)
            for (int j = j0; j < j1; ++j) hole[l.column(i, j)] = 1;
        return hole;
    }
    LayoutOptions options(int patch, int overlap) const {
        LayoutOptions made;
        made.patch = patch;
        made.overlap = overlap;
        made.barred = &barred;
        return made;
    }
    PatchArrangement lay(const LayoutOptions& o, const RunContext& ctx = {}) const {
        return layIntoHole(field, field.lattice.nx, field.lattice.ny, hole, o, ctx);
    }
};

Holed crate(int i0, int i1, int j0, int j1) {
    static const PatchField field = test::measuredField(test::eggCrateExemplar({}, 80), 2);
    return {field, i0, i1, j0, j1};
}

}  // namespace

TEST_CASE("layIntoHole: covers the hole, copies nothing of it, and leaves what is far") {
    const Holed holed = crate(12, 25, 20, 24);
    const PatchArrangement sheet = holed.lay(holed.options(12, 3));
    const PatchLattice& l = sheet.lattice;
    REQUIRE(sheet.patches.size() >= 2);
    CHECK(sheet.patches[0].fine.x == 0);
    const auto wide = widenedColumns(holed.hole, l.nx, l.ny, 3);
    for (int i = 0; i < l.nx; ++i)
        for (int j = 0; j < l.ny; ++j)
            for (int k = 0; k < l.nz; ++k) {
                const std::int32_t label = sheet.label[l.column(i, j) * std::size_t(l.nz) + std::size_t(k)];
                REQUIRE((label >= 0 && label < std::int32_t(sheet.patches.size())));
                const PatchPlace from = sourceColumn(sheet, sheet.patches[std::size_t(label)], i, j);
                REQUIRE_FALSE(holed.hole[l.column(from.i, from.j)]);
                if (!wide[l.column(i, j)]) REQUIRE(label == 0);
            }
    // The crate's period is known: copies fit, so that seams cost little.
    const auto costs = seamCosts(holed.field, sheet, 0, 0, l.nx, l.ny);
    const double sum = std::accumulate(costs.begin(), costs.end(), 0.0);
    CHECK(sum / double(l.nz) < 0.25 * 2 * (13 + 4 + 12));
}

TEST_CASE("layIntoHole: a hole that one patch covers gets one, a hole at the edge too, two parts two") {
    const Holed middle = crate(18, 21, 18, 21), edge = crate(0, 4, 30, 34);
    LayoutOptions options = middle.options(12, 3);
    options.repairs = 0;
    const PatchArrangement one = middle.lay(options);
    REQUIRE(one.patches.size() == 2);
    CHECK(one.patches[1].at == PatchPlace{13, 13});
    options.barred = &edge.barred;
    const PatchArrangement side = edge.lay(options);
    REQUIRE(side.patches.size() == 2);
    CHECK(side.patches[1].at.i == 0);
    Holed two = crate(8, 10, 8, 10);
    const auto more = Holed::marked(two.field.lattice, 30, 32, 30, 32);
    for (std::size_t c = 0; c < more.size(); ++c) two.hole[c] |= more[c];
    two.barred = BarredColumns(two.field.lattice, two.hole);
    options.barred = &two.barred;
    CHECK(two.lay(options).patches.size() == 3);
}

TEST_CASE("layIntoHole: the same for any number of threads, and cancels") {
    const Holed holed = crate(12, 25, 20, 30);
    const LayoutOptions options = holed.options(12, 3);
    const PatchArrangement a = holed.lay(options, test::onThreads(1)),
                           b = holed.lay(options, test::onThreads(4));
    CHECK(a.label == b.label);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { holed.lay(options, ctx); }).code ==
          int(ErrorCode::Cancelled));
}

TEST_CASE("layIntoHole: refuses what cannot be") {
    const Holed holed = crate(12, 25, 20, 24);
    const int nx = holed.field.lattice.nx, ny = holed.field.lattice.ny;
    LayoutOptions options = holed.options(12, 3);
    const auto with = [&](const std::vector<std::uint8_t>& hole, const LayoutOptions& o) {
        return layIntoHole(holed.field, nx, ny, hole, o);
    };
    const std::vector<std::uint8_t> none(holed.hole.size(), 0), all(holed.hole.size(), 1);
    CHECK_THROWS_WITH(with(none, options), Catch::Contains("no column"));
    CHECK_THROWS_WITH(with(all, options), Catch::Contains("whole sheet"));
    CHECK_THROWS_WITH(with({1, 0}, options), Catch::Contains("differ in size"));
    options.patch = 60;
    CHECK_THROWS_WITH(with(holed.hole, options), Catch::Contains("larger than the sheet"));
    options = holed.options(12, 12);
    CHECK_THROWS_WITH(with(holed.hole, options), Catch::Contains("wider than its overlap"));
    options = holed.options(12, 3);
    const BarredColumns every(holed.field.lattice, all);
    options.barred = &every;
    CHECK_THROWS_WITH(with(holed.hole, options), Catch::Contains("no place"));
    options.barred = nullptr;
    CHECK_THROWS_WITH(with(holed.hole, options), Catch::Contains("barred"));
}

TEST_CASE("widenedColumns: squares around marked columns, within the lattice") {
    std::vector<std::uint8_t> one(35, 0);
    one[1 * 5 + 1] = 1;
    const auto wide = widenedColumns(one, 7, 5, 2);
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 5; ++j) CHECK(int(wide[std::size_t(i * 5 + j)]) == (i <= 3 && j <= 3 ? 1 : 0));
    CHECK(widenedColumns(one, 7, 5, 0) == one);
}
