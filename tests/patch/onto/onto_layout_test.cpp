#include "libvdbsynth/patch/onto/onto_layout.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

const PatchField& crateField() {
    static const PatchField field = test::measuredField(test::eggCrateExemplar({}, 48), 2);
    return field;
}

const OntoSurface& square() {
    static const OntoSurface surface = test::surfaceAlong(test::squareShape(90, 2), {1, 0, 0}, 2);
    return surface;
}

OntoLayoutOptions optionsFor(int patch, int overlap) {
    OntoLayoutOptions options;
    options.patch = patch;
    options.overlap = overlap;
    return options;
}

void requireWhole(const OntoArrangement& made, double radius) {
    for (std::size_t n = 0; n < made.label.size(); ++n) {
        REQUIRE((made.label[n] >= 0 && made.label[n] < std::int32_t(made.patches.size())));
        const OntoPatch& patch = made.patches[std::size_t(made.label[n])];
        const std::ptrdiff_t member = patch.disk.find(std::uint32_t(n / std::size_t(made.nz)));
        REQUIRE(member >= 0);
        REQUIRE(double(length(patch.disk.at[std::size_t(member)])) <= radius + 1e-3);
    }
    for (const OntoPatch& patch : made.patches) {
        REQUIRE(std::abs(length(patch.turn) - 1) < 1e-4f);
        REQUIRE((patch.from.x >= radius - 1e-6 && patch.from.x <= 48 - radius + 1e-6));
        REQUIRE((patch.from.y >= radius - 1e-6 && patch.from.y <= 48 - radius + 1e-6));
    }
}

bool same(const OntoArrangement& a, const OntoArrangement& b) {
    if (a.label != b.label || a.patches.size() != b.patches.size()) return false;
    for (std::size_t p = 0; p < a.patches.size(); ++p)
        if (a.patches[p].from.x != b.patches[p].from.x || a.patches[p].from.y != b.patches[p].from.y ||
            length(a.patches[p].turn - b.patches[p].turn) != 0 ||
            a.patches[p].disk.centre != b.patches[p].disk.centre)
            return false;
    return true;
}

}  // namespace

TEST_CASE("layOntoSurface: a square, a ball and two parts are covered by what the exemplar holds") {
    const OntoArrangement plane = layOntoSurface(square(), crateField(), optionsFor(14, 4));
    requireWhole(plane, 14);
    CHECK(plane.patches.size() >= 8);
    CHECK(plane.patches.size() < 80);
    const OntoSurface ball =
        ontoSurface(test::spiralSphere(2500, 28).point, test::spiralSphere(2500, 28).normal, {}, 2);
    requireWhole(layOntoSurface(ball, crateField(), optionsFor(12, 3)), 12);
    test::PointShape far = test::squareShape(30, 2);
    for (Vec3f& p : far.point) p = p + Vec3f{1000, 0, 5};
    const OntoSurface two = test::surfaceAlong(test::joined(test::squareShape(30, 2), far), {1, 0, 0}, 2);
    requireWhole(layOntoSurface(two, crateField(), optionsFor(12, 3)), 12);
}

TEST_CASE("layOntoSurface: patches of a periodic texture on a plane keep its phase") {
    OntoLayoutOptions options = optionsFor(14, 4);
    const OntoArrangement made = layOntoSurface(square(), crateField(), options);
    // In the egg-crate of period 16 a shift by whole periods, or by half of one along both axes, is none.
    const auto phaseOf = [&](const OntoPatch& patch) {
        const Vec3f at = square().sites.point[patch.disk.centre];
        return PlanePlace{(double(at.x) - patch.from.x) / 8, (double(at.y) - patch.from.y) / 8};
    };
    const PlanePlace first = phaseOf(made.patches[0]);
    std::size_t right = 0;
    for (const OntoPatch& patch : made.patches) {
        const PlanePlace phase = phaseOf(patch);
        const double x = phase.x - first.x, y = phase.y - first.y;
        const bool whole = std::abs(x - std::round(x)) < 0.12 && std::abs(y - std::round(y)) < 0.12 &&
                           int(std::round(x) + std::round(y)) % 2 == 0;
        right += whole && patch.turn.x > 0.998f ? 1 : 0;
    }
    CHECK(double(right) >= 0.9 * double(made.patches.size()));
}

TEST_CASE("layOntoSurface: what is out of range") {
    const auto code = [](OntoLayoutOptions options) {
        return test::thrownBy([&] { layOntoSurface(square(), crateField(), options); }).code;
    };
    CHECK(code(optionsFor(3, 1)) == int(ErrorCode::InvalidOption));
    CHECK(code(optionsFor(12, 0)) == int(ErrorCode::InvalidOption));
    CHECK(code(optionsFor(12, 6)) == int(ErrorCode::InvalidOption));
    CHECK(code(optionsFor(40, 3)) == int(ErrorCode::Unusable));
    OntoLayoutOptions options = optionsFor(12, 3);
    options.tolerance = -1;
    CHECK(code(options) == int(ErrorCode::InvalidOption));
    options = optionsFor(12, 3);
    options.repairs = 21;
    CHECK(code(options) == int(ErrorCode::InvalidOption));
    RunContext small;
    small.maxMemory = 100;
    CHECK(test::thrownBy([&] { layOntoSurface(square(), crateField(), optionsFor(12, 3), small); }).code ==
          int(ErrorCode::Memory));
}

TEST_CASE("layOntoSurface: the seed decides, threads do not, and it can be cancelled") {
    const auto run = [&](const RunContext& ctx) {
        return layOntoSurface(square(), crateField(), optionsFor(14, 4), ctx);
    };
    const OntoArrangement one = run(test::onThreads(1));
    CHECK(same(one, run(test::onThreads(4))));
    RunContext other;
    other.seed = 7;
    CHECK(!same(one, run(other)));
    CHECK(test::thrownWhenCancelled(run).code == int(ErrorCode::Cancelled));
}
