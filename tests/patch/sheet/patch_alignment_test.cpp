#include "libvdbsynth/patch/sheet/patch_alignment.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_sheets.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

const test::Texture& crates() {
    static const test::Texture texture(test::eggCrateExemplar({}, 48), 2);
    return texture;
}

double align(const test::Texture& texture, PatchArrangement& sheet, const RunContext& ctx = {}) {
    return alignPatches(texture.exemplar, texture.surface, texture.field, sheet, ctx);
}

// The exemplar's first 20 x 20 columns in four patches that meet in the middle.
PatchArrangement cutInFour(const test::Texture& texture, double size) {
    PatchArrangement sheet;
    sheet.lattice = {2, 20, 20, texture.field.lattice.nz};
    for (int n = 0; n < 4; ++n) {
        Random random(8, std::uint64_t(n));
        const PatchPlace at{n / 2 * 6, n % 2 * 6};
        const double x = random.uniform(-size, size), y = random.uniform(-size, size);
        sheet.patches.push_back({at, at, 14, 14, {x, y, 0}, 0});
    }
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            sheet.label.insert(sheet.label.end(), std::size_t(sheet.lattice.nz), i / 10 * 2 + j / 10);
    return sheet;
}

// How far patches are from lying as in the exemplar, but for a move of all.
double apart(const PatchArrangement& sheet) {
    double most = 0;
    for (const LaidPatch& patch : sheet.patches)
        most = std::max(most, length(patch.fine - sheet.patches[0].fine));
    return most;
}

}  // namespace

TEST_CASE("alignPatches: of two that are apart each moves half the way") {
    PatchArrangement sheet = test::cutInTwo(crates(), {0.4, -0.3, 0});
    const double moved = align(crates(), sheet);
    const Vec3d &left = sheet.patches[0].fine, &right = sheet.patches[1].fine;
    CHECK(length(right - left) < 0.05);
    CHECK(length(left - Vec3d{0.2, -0.15, 0}) < 0.05);
    CHECK(moved == Approx(0.25).epsilon(0.1));
}

TEST_CASE("alignPatches: of a ring of patches all fit, and those that fit stay") {
    for (const double size : {0.0, 0.1, 0.5}) {
        PatchArrangement sheet = cutInFour(crates(), size);
        const auto labels = sheet.label;
        const double before = apart(sheet), moved = align(crates(), sheet);
        CAPTURE(size, before);
        CHECK(apart(sheet) <= 0.3 * before + 1e-6);
        CHECK(moved <= 1.5 * size + 1e-9);
        CHECK(sheet.label == labels);
        for (const LaidPatch& patch : sheet.patches) CHECK(patch.fine.z == 0);
        // Once more it fits still better.
        align(crates(), sheet);
        CHECK(apart(sheet) < 0.03);
    }
}

TEST_CASE("alignPatches: no patch goes over one and a half steps, and where nothing tells none moves") {
    PatchArrangement far = test::cutInTwo(crates(), {0, 3.9, 0});  // nearly a period
    align(crates(), far);
    CHECK(std::abs(far.patches[0].fine.y) <= 1.5);
    CHECK(std::abs(far.patches[1].fine.y - 3.9) <= 1.5);
    const test::Texture plane(test::exemplarOf(test::eggCratePoints({16, 0}, 48, 8), 48), 2);
    PatchArrangement flat = test::cutInTwo(plane, {0.4, -0.3, 0});
    CHECK(align(plane, flat) < 1e-6);
    PatchArrangement none;
    none.lattice = plane.field.lattice;
    none.label.assign(none.lattice.nodes(), PatchArrangement::kNone);
    CHECK(align(plane, none) == 0);
    none.patches = {{{0, 0}, {0, 0}, 24, 24, {}, 0}};
    none.label.assign(none.lattice.nodes(), 0);
    CHECK(align(plane, none) == 0);
}

TEST_CASE("alignPatches: same bits for any number of threads, and cancelled", "[patch][tsan]") {
    PatchArrangement one = cutInFour(crates(), 0.4), three = one, cancelled = one;
    CHECK(align(crates(), one, test::onThreads(1)) == align(crates(), three, test::onThreads(3)));
    for (std::size_t p = 0; p < 4; ++p) CHECK(length(one.patches[p].fine - three.patches[p].fine) == 0);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { align(crates(), cancelled, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
