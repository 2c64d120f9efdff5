#include "libvdbsynth/patch/onto/onto_cut.h"

#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

#include <utility>

using namespace vdbsynth;

namespace {

// A square of sites with two patches: one around its middle, one beside it.
struct Pair {
    OntoSurface surface = test::surfaceAlong(test::squareShape(40, 1), {1, 0, 0}, 1);
    SurfaceDisks disks{surface};
    OntoArrangement arrangement;

    Pair() {
        arrangement.nz = 4;
        arrangement.step = 1;
        arrangement.label.assign(surface.sites.size() * 4, OntoArrangement::kNone);
    }
    OntoPatch patchAt(const Vec3f& place, const PlanePlace& from) {
        OntoPatch patch;
        patch.disk = disks.around(test::siteAt(surface, place), 14);
        patch.radius = 10;
        patch.from = from;
        return patch;
    }
    std::size_t lay(OntoPatch patch, const PatchField& field, double core = 0) {
        arrangement.patches.push_back(std::move(patch));
        return cutOntoSurface(surface, field, std::int32_t(arrangement.patches.size()) - 1, core,
                              arrangement);
    }
};

// A wall over x = `wall`: distances along x.
PatchField wallField(double wall) {
    return test::patchFieldFrom({1, 60, 40, 4}, [&](int i, int, int) {
        return test::NodeValues{float(std::clamp(std::abs(i + 0.5 - wall) - 1, -3.0, 3.0)), 1, 0, 0};
    });
}

}  // namespace

TEST_CASE("cutOntoSurface: the first patch gets its disk, whole columns of it") {
    Pair pair;
    const OntoPatch patch = pair.patchAt({15, 20, 0}, {20, 20});
    const std::size_t given = pair.lay(patch, wallField(20));
    std::size_t within = 0;
    for (std::size_t m = 0; m < patch.disk.size(); ++m) {
        const bool inside = double(length(patch.disk.at[m])) <= patch.radius;
        within += inside ? 4 : 0;
        REQUIRE(pair.arrangement.known(patch.disk.site[m]) == inside);
    }
    CHECK(given == within);
}

TEST_CASE("cutOntoSurface: a cut runs where both agree, and its ends belong to each") {
    Pair pair;
    // Seen from both, a wall stands at x = 20: the first one's middle is over x = 20 - 5 of its exemplar.
    const PatchField field = wallField(20);
    pair.lay(pair.patchAt({15, 20, 0}, {15, 20}), field);
    const std::size_t given = pair.lay(pair.patchAt({25, 20, 0}, {25, 20}), field);
    CHECK(given > 0);
    const auto& label = pair.arrangement.label;
    for (std::uint32_t s = 0; s < pair.surface.sites.size(); ++s) {
        const Vec3f p = pair.surface.sites.point[s];
        const float toFirst = length(p - Vec3f{15, 20, 0}), toSecond = length(p - Vec3f{25, 20, 0});
        for (int k = 0; k < 4; ++k) {
            if (toFirst < 9 && toSecond > 11) REQUIRE(label[s * 4 + std::uint32_t(k)] == 0);
            if (toFirst > 11 && toSecond < 9) REQUIRE(label[s * 4 + std::uint32_t(k)] == 1);
        }
    }
}

TEST_CASE("cutOntoSurface: a core goes to the new patch") {
    Pair pair;
    const PatchField field = wallField(20);
    pair.lay(pair.patchAt({20, 20, 0}, {20, 20}), field);
    const OntoPatch patch = pair.patchAt({20, 20, 0}, {30, 20});
    pair.lay(patch, field, 4);
    for (std::size_t m = 0; m < patch.disk.size(); ++m) {
        if (double(length(patch.disk.at[m])) < 4)
            REQUIRE(pair.arrangement.column(patch.disk.site[m])[0] == 1);
    }
}

TEST_CASE("cutOntoSurface: a large overlap is cut too, the same each time") {
    Pair a, b;
    const PatchField noise = test::noisePatchField({1, 60, 40, 30}, 5);
    for (Pair* pair : {&a, &b}) {
        pair->arrangement.nz = 30;
        pair->arrangement.label.assign(pair->surface.sites.size() * 30, OntoArrangement::kNone);
        pair->lay(pair->patchAt({15, 20, 0}, {15, 20}), noise);
        pair->lay(pair->patchAt({18, 20, 0}, {40, 20}), noise);
    }
    CHECK(a.arrangement.label == b.arrangement.label);
    std::size_t ones = 0;
    for (const std::int32_t label : a.arrangement.label) ones += label == 1 ? 1 : 0;
    CHECK(ones > 0);
}
