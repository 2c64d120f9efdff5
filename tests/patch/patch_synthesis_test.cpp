#include "libvdbsynth/patch/patch_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <limits>

using namespace vdbsynth;

namespace {

PatchOptions sized(double width, double depth) {
    PatchOptions options;
    options.width = width;
    options.depth = depth;
    return options;
}

bool sameBits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0);
}

bool sameSheet(const SheetPoints& a, const SheetPoints& b) {
    return sameBits(a.points, b.points) && sameBits(a.normals, b.normals) && a.source == b.source &&
           a.patch == b.patch && a.blended == b.blended;
}

// How far points are from an egg-crate moved by some phase, whichever fits best.
struct CrateFit {
    double worst = 0, mean = 0, normal = 0;
};

// The distance to z = f(x, y) along the slope's normal, with its sign.
double crateDistance(const test::EggCrate& crate, const Vec3d& p, const Vec3d& phase) {
    const Vec3d slope = crate.slope(p.x - phase.x, p.y - phase.y);
    return (p.z - phase.z - crate.at(p.x - phase.x, p.y - phase.y)) / std::sqrt(1 + dot(slope, slope));
}

double squares(const test::EggCrate& crate, const SheetPoints& sheet, const Vec3d& phase) {
    double sum = 0;
    for (std::size_t p = 0; p < sheet.size(); p += 7) {
        const double off = crateDistance(crate, cast<double>(sheet.points[p]), phase);
        sum += off * off;
    }
    return sum;
}

// From the best phase of a lattice, always half as far along the axes.
Vec3d fittedPhase(const test::EggCrate& crate, const SheetPoints& sheet, double z) {
    Vec3d best;
    double least = std::numeric_limits<double>::infinity();
    const auto tryPhase = [&](const Vec3d& phase) {
        const double sum = squares(crate, sheet, phase);
        if (sum < least) {
            least = sum;
            best = phase;
        }
    };
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) tryPhase({i * crate.period / 8, j * crate.period / 8, z});
    for (double step = crate.period / 16; step > 1e-3; step /= 2)
        for (int repeat = 0; repeat < 2; ++repeat)
            for (int axis = 0; axis < 2; ++axis)
                for (const double sign : {-1.0, 1.0}) {
                    Vec3d phase = best;
                    phase[axis] += sign * step;
                    tryPhase(phase);
                }
    return best;
}

CrateFit fitOf(const test::EggCrate& crate, const SheetPoints& sheet, double z) {
    const Vec3d phase = fittedPhase(crate, sheet, z);
    CrateFit fit;
    for (std::size_t p = 0; p < sheet.size(); ++p) {
        const Vec3d at = cast<double>(sheet.points[p]);
        const double off = std::abs(crateDistance(crate, at, phase));
        fit.worst = std::max(fit.worst, off);
        fit.mean += off / double(sheet.size());
        const Vec3d normal = crate.normal(at.x - phase.x, at.y - phase.y);
        fit.normal = std::max(fit.normal, length(cast<double>(sheet.normals[p]) - normal));
    }
    return fit;
}

// The largest and smallest of the distances to the nearest other point, over points in a box.
struct Gaps {
    double least = 0, most = 0;
};
Gaps gapsOf(const SheetPoints& sheet, double x0, double y0, double x1, double y1) {
    const PointNeighbours neighbours(sheet.points);
    Gaps gaps{std::numeric_limits<double>::infinity(), 0};
    for (const Vec3f& p : sheet.points) {
        if (double(p.x) < x0 || double(p.y) < y0 || double(p.x) > x1 || double(p.y) > y1) continue;
        std::uint32_t number[2];
        float squared[2];
        neighbours.nearest(p, 2, number, squared);
        gaps.least = std::min(gaps.least, std::sqrt(double(squared[1])));
        gaps.most = std::max(gaps.most, std::sqrt(double(squared[1])));
    }
    return gaps;
}

const PatchExemplar& crates() {
    static const PatchExemplar exemplar = test::eggCrateExemplar({16, 1}, 48);
    return exemplar;
}

}  // namespace

TEST_CASE("synthesizePatches: four times a periodic egg-crate is the formula to 0.1 spacings") {
    // 14.7 is no whole number of steps. The last is curved by a radius of 3 spacings, as sharp as points
    // tell.
    for (const test::EggCrate crate :
         {test::EggCrate{16, 1}, test::EggCrate{24, 2}, test::EggCrate{16, 2}, test::EggCrate{14.7, 1}}) {
        const bool hard = crate.height / crate.period > 0.1 || crate.period < 16;
        const int side = 3 * int(crate.period), wide = (hard ? 2 : 4) * side;
        const PatchResult made = synthesizePatches(test::eggCrateExemplar(crate, side), sized(wide, wide));
        const CrateFit fit = fitOf(crate, made.sheet, crate.height + 2);
        CAPTURE(crate.period, crate.height, fit.worst, fit.mean, fit.normal);
        CHECK(fit.worst < (hard ? 0.2 : 0.1));
        CHECK(fit.mean < 0.015);
        CHECK(fit.normal < (hard ? 0.3 : 0.1));
        CHECK(double(made.sheet.size()) == Approx(double(wide) * wide).epsilon(0.03));
        const Gaps gaps = gapsOf(made.sheet, 2, 2, wide - 2, wide - 2);
        CHECK(gaps.least > 0.4);
        CHECK(gaps.most < 1.3);
        CHECK(made.patches == made.arrangement.patches.size());
        CHECK(made.patches > 20);
    }
}

TEST_CASE("synthesizePatches: a tile of it too, and its opposite sides agree") {
    const test::EggCrate crate{16, 1};
    PatchOptions options = sized(192, 192);
    options.tile = true;
    const PatchResult made = synthesizePatches(crates(), options);
    CHECK(made.arrangement.tile);
    const CrateFit fit = fitOf(crate, made.sheet, crate.height + 2);
    CHECK(fit.worst < 0.1);
    for (const Vec3f& p : made.sheet.points) {
        REQUIRE((p.x >= 0 && p.x < 192));
        REQUIRE((p.y >= 0 && p.y < 192));
    }
    // With a border the other side's points lie there, bit for bit but for rounding.
    options.border = 10;
    const PatchResult wide = synthesizePatches(crates(), options);
    CHECK(fitOf(crate, wide.sheet, crate.height + 2).worst < 0.1);
    std::size_t outside = 0;
    const PointNeighbours neighbours(wide.sheet.points);
    for (const Vec3f& p : wide.sheet.points) {
        REQUIRE((p.x >= -10 && p.x < 202));
        REQUIRE((p.y >= -10 && p.y < 202));
        if (p.x >= 0 && p.x < 192 && p.y >= 0 && p.y < 192) continue;
        ++outside;
        const Vec3f within{p.x - 192 * std::floor(p.x / 192), p.y - 192 * std::floor(p.y / 192), p.z};
        std::uint32_t number = 0;
        float squared = 0;
        neighbours.nearest(within, 1, &number, &squared);
        REQUIRE(squared < 1e-8f);
    }
    CHECK(wide.sheet.size() - outside == made.sheet.size());
    // No gap and no clump where both sides meet.
    for (const Gaps& gaps : {gapsOf(wide.sheet, -4, -4, 4, 196), gapsOf(wide.sheet, -4, -4, 196, 4)}) {
        CHECK(gaps.least > 0.4);
        CHECK(gaps.most < 1.3);
    }
}

TEST_CASE("synthesizePatches: the border continues beyond the size, and is as good") {
    const test::EggCrate crate{16, 1};
    PatchOptions options = sized(70, 40);
    options.border = 5;
    const PatchResult made = synthesizePatches(crates(), options);
    Vec3f low{1e9f, 1e9f, 0}, high{-1e9f, -1e9f, 0};
    for (const Vec3f& p : made.sheet.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
    }
    CHECK((low.x >= -5 && low.x < -4));
    CHECK((low.y >= -5 && low.y < -4));
    CHECK((high.x > 74 && high.x < 75));
    CHECK((high.y > 44 && high.y < 45));
    CHECK(fitOf(crate, made.sheet, crate.height + 2).worst < 0.15);
    CHECK(made.step == 2);
    CHECK(made.patch == 24);
    CHECK(made.overlap == 8);
}

TEST_CASE("synthesizePatches: rings stay whole rings, on sheets that face each other") {
    PatchExemplar exemplar = test::exemplarOf(test::ringSheet(4), 64, -4, 4);
    exemplar.kernel = 1;
    const PatchResult made = synthesizePatches(exemplar, sized(128, 96));
    // Every point lies on a torus that lies flat: its distance to a circle of radius 5 about some middle.
    const double floor = 4;
    double worst = 0;
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const Vec3d at = cast<double>(made.sheet.points[p]) - Vec3d{0, 0, floor};
        // By its normal the point is 1.2 from the tube's middle circle, at height 0.
        const Vec3d middle = at - cast<double>(made.sheet.normals[p]) * 1.2;
        worst = std::max(worst, std::abs(middle.z));
    }
    CHECK(worst < 0.35);
    CHECK(made.sheet.size() > 5000);
}

TEST_CASE("synthesizePatches: without warp, blend and repairs the points are the exemplar's") {
    PatchOptions options = sized(60, 60);
    options.warp = options.blend = false;
    options.repairs = 0;
    const PatchResult made = synthesizePatches(crates(), options);
    CHECK(made.borders.warps == 0);
    // More is laid than was asked for, the same on both sides.
    const Vec3d begin{30.0 - made.arrangement.lattice.nx, 30.0 - made.arrangement.lattice.ny, 0};
    CHECK(begin.x <= -7);
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const Vec3d moved =
            cast<double>(made.sheet.points[p]) - begin - shiftOf(made.arrangement, made.sheet.patch[p]);
        REQUIRE(length(moved - cast<double>(crates().points[made.sheet.source[p]])) < 1e-4);
        REQUIRE(made.sheet.blended[p] == 0);
    }
}

TEST_CASE("synthesizePatches: by the paper, with its own weights or given ones") {
    PatchOptions options = sized(60, 60);
    options.method = PatchMethod::Paper;
    options.seedPlace = Vec3d{4, 6, -3};
    const PatchResult fitted = synthesizePatches(crates(), options);
    CHECK(fitted.arrangement.patches.empty());
    CHECK(fitted.patches > 9);
    CHECK(fitted.pairs > fitted.patches);
    CHECK(fitted.weights.position == 1);
    CHECK(double(fitted.sheet.size()) == Approx(3600).epsilon(0.05));
    options.weights = PairingWeights{};
    const PatchResult given = synthesizePatches(crates(), options);
    CHECK(given.weights.variation == PairingWeights{}.variation);
    CHECK(!sameSheet(given.sheet, fitted.sheet));
}

TEST_CASE("repeatPatches: gives the run's own points bit for bit") {
    for (const bool tile : {false, true}) {
        PatchOptions options = sized(96, 64);
        options.tile = tile;
        options.border = 3;
        options.overlap = 0.3;
        const PatchResult made = synthesizePatches(crates(), options);
        const SheetResult again = repeatPatches(crates(), made.arrangement, options);
        CHECK(sameSheet(again.sheet, made.sheet));
        CHECK(again.borders.apartAfter == made.borders.apartAfter);
    }
}

TEST_CASE("repeatPatches: of another exemplar of the same box, and refused of one that is too small") {
    const PatchOptions options = sized(60, 60);
    const PatchResult made = synthesizePatches(crates(), options);
    const PatchExemplar flat = test::exemplarOf(test::eggCratePoints({16, 0.5}, 48, 8), 48, -3, 3);
    const SheetResult other = repeatPatches(flat, made.arrangement, options);
    const CrateFit fit = fitOf({16, 0.5}, other.sheet, 3);
    CHECK(fit.worst < 0.1);
    CHECK(test::thrownBy([&] {
              repeatPatches(test::eggCrateExemplar({16, 1}, 24), made.arrangement, options);
          }).code == int(ErrorCode::ShapeMismatch));
    CHECK(test::thrownBy([&] {
              repeatPatches(test::exemplarOf(test::eggCratePoints({16, 1}, 48, 8), 48, -20, 20),
                            made.arrangement, options);
          }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("fieldStep: two spacings, or more for a wide exemplar, or as told") {
    PatchOptions options = sized(1, 1);
    CHECK(fieldStep(crates(), options) == 2);
    PatchExemplar wide = crates();
    wide.size.y = 720;
    CHECK(fieldStep(wide, options) == 10);
    options.step = 3;
    CHECK(fieldStep(wide, options) == 3);
    wide.spacing = 0.5;
    CHECK(fieldStep(wide, options) == 1.5);
}

TEST_CASE("synthesizePatches: what is refused") {
    const auto refused = [](const auto& change) {
        PatchOptions options = sized(60, 60);
        change(options);
        return test::thrownBy([&] { synthesizePatches(crates(), options); }).code;
    };
    const int invalid = int(ErrorCode::InvalidOption), unusable = int(ErrorCode::Unusable);
    for (const double bad : {-1.0, std::nan("")}) {
        CHECK(refused([&](PatchOptions& o) { o.width = bad; }) == invalid);
        CHECK(refused([&](PatchOptions& o) { o.depth = bad; }) == invalid);
        CHECK(refused([&](PatchOptions& o) { o.border = bad; }) == invalid);
        CHECK(refused([&](PatchOptions& o) { o.patch = bad; }) == invalid);
        CHECK(refused([&](PatchOptions& o) { o.overlap = bad; }) == invalid);
        CHECK(refused([&](PatchOptions& o) { o.tolerance = bad; }) == invalid);
        CHECK(refused([&](PatchOptions& o) { o.step = bad; }) == invalid);
    }
    CHECK(refused([](PatchOptions& o) { o.width = 0; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.overlap = 0.04; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.overlap = 0.81; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.tolerance = 11; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.step = 0.4; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.step = 65; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.repairs = 21; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.repairs = -1; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.rounds = 21; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.weights = PairingWeights{-1, 0, 0, 0, 0}; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.limits.position = 0; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.patch = 50; }) == unusable);
    CHECK(refused([](PatchOptions& o) { o.patch = 5; }) == invalid);
    CHECK(refused([](PatchOptions& o) { o.step = 24; }) == unusable);  // an exemplar of two columns
    for (const double bad : {20.0, 61.0})  // under 4/3 of a patch, and no whole steps
        CHECK(refused([&](PatchOptions& o) {
                  o.tile = true;
                  o.width = bad;
              }) == invalid);
    CHECK(refused([](PatchOptions& o) {
              o.method = PatchMethod::Paper;
              o.seedPlace = Vec3d{40, 0, 0};
          }) == invalid);
}

TEST_CASE("synthesizePatches: same bits for any number of threads, another seed another sheet, cancelled",
          "[patch][tsan]") {
    for (const PatchMethod method : {PatchMethod::Default, PatchMethod::Paper}) {
        PatchOptions options = sized(60, 50);
        options.method = method;
        RunContext other = test::onThreads(2);
        other.seed = 9;
        const PatchResult one = synthesizePatches(crates(), options, test::onThreads(1));
        CHECK(sameSheet(one.sheet, synthesizePatches(crates(), options, test::onThreads(3)).sheet));
        CHECK(!sameSheet(one.sheet, synthesizePatches(crates(), options, other).sheet));
        CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
                  synthesizePatches(crates(), options, ctx);
              }).code == int(ErrorCode::Cancelled));
    }
}
