#include "libvdbsynth/patch/scanline/scanline_patches.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/scanline/scanline_steps.h"
#include "libvdbsynth/points/surface_variation.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <cstring>

using namespace vdbsynth;

namespace {

PatchField paperField(const PatchExemplar& exemplar) {
    return test::measuredField(exemplar, 2, PointSetKind::AdamsonAlexa);
}

ScanlineOptions small() {
    ScanlineOptions options;
    options.patch = 12;
    options.margin = 4;
    return options;
}

std::vector<ScanlinePoint> scanlinePoints(const PatchExemplar& exemplar, const PlaneBox& box) {
    const auto variation = surfaceVariation(exemplar.points, exemplar.normals);
    std::vector<ScanlinePoint> points;
    for (std::size_t p = 0; p < exemplar.points.size(); ++p)
        if (box.holds(exemplar.points[p]))
            points.push_back({exemplar.points[p], exemplar.normals[p], variation[p], std::uint32_t(p), 0, 0});
    return points;
}

bool sameBits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0);
}

}  // namespace

TEST_CASE("PointBuckets: gathers, removes and lists by place") {
    PointBuckets sheet(2);
    const Vec3f places[5] = {{5, 1, 0}, {1, 1, 0}, {1, 3, 0}, {-1, -1, 9}, {1.5f, 1, 0}};
    for (std::uint32_t n = 0; n < 5; ++n) sheet.insert({places[n], {0, 0, 1}, 0, n, 0, 0});
    const auto numbers = [](const std::vector<ScanlinePoint>& points) {
        std::vector<std::uint32_t> sources;
        for (const ScanlinePoint& point : points) sources.push_back(point.source);
        return sources;
    };
    CHECK(numbers(sheet.all()) == std::vector<std::uint32_t>{3, 1, 4, 0, 2});
    // A box holds its low sides, not its high ones.
    CHECK(numbers(sheet.gathered({1, 1, 5, 3})) == std::vector<std::uint32_t>{1, 4});
    sheet.removeInside({-2, -2, 1.5, 2});
    CHECK(numbers(sheet.all()) == std::vector<std::uint32_t>{4, 0, 2});
    CHECK(sheet.gathered({100, 100, 200, 200}).empty());
}

TEST_CASE("ScanlinePatch: what a place keeps falls from 1 to 0 across the overlap") {
    const ScanlinePatch both{10, 20, 8, 4, true, true}, left{10, 20, 8, 4, true, false},
        none{10, 20, 8, 4, false, false};
    CHECK(left.kept({10, 30, 0}) == 1);
    CHECK(left.kept({12, 20, 0}) == 0.5);
    CHECK(left.kept({14, 20, 0}) == 0);
    CHECK(left.kept({9, 20, 0}) == 1);  // the margin beyond
    CHECK(both.kept({12, 20, 0}) == 1);
    CHECK(both.kept({13, 23, 0}) == Approx(0.15625));
    CHECK(none.kept({10, 20, 0}) == 0);
    CHECK(both.box().x1 == 22);
    CHECK(both.box().grown(1).y0 == 19);
}

TEST_CASE("warpToNeighbours: a patch over itself is warped by at most 1e-6 spacings") {
    const PatchExemplar exemplar = test::eggCrateExemplar({}, 48);
    const ScanlinePatch patch{8, 8, 24, 8, true, true};
    const auto neighbours = scanlinePoints(exemplar, patch.box().grown(8));
    auto points = neighbours;
    const std::size_t pairs = warpToNeighbours(patch, neighbours, 1, small(), points, {});
    CHECK(pairs > 10);
    for (std::size_t p = 0; p < points.size(); ++p) {
        REQUIRE(length(points[p].point - neighbours[p].point) <= 1e-6f);
        REQUIRE(length(points[p].normal - neighbours[p].normal) <= 1e-5f);
    }
}

TEST_CASE(
    "warpToNeighbours: a patch moved by half a spacing is moved back over the overlap, not in the far "
    "corner") {
    const PatchExemplar exemplar = test::eggCrateExemplar({}, 48);
    const ScanlinePatch patch{8, 8, 24, 8, true, true};
    const auto neighbours = scanlinePoints(exemplar, patch.box().grown(8));
    auto points = neighbours;
    const Vec3f move{0.3f, -0.2f, 0.35f};
    for (ScanlinePoint& point : points) point.point = point.point + move;
    warpToNeighbours(patch, neighbours, 1, small(), points, {});
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3f& was = neighbours[p].point;
        const float off = length(points[p].point - was);
        if (patch.kept(was) > 0.2 && was.x > 9 && was.y > 9 && was.x < 30 && was.y < 30) REQUIRE(off < 0.1f);
        if (was.x > 38 && was.y > 38 && was.x < 41 && was.y < 41) REQUIRE(off > 0.3f);
    }
}

TEST_CASE("warpToNeighbours: with fewer than four pairs nothing is warped") {
    const PatchExemplar exemplar = test::eggCrateExemplar({}, 48);
    const ScanlinePatch patch{8, 8, 24, 8, true, true};
    auto points = scanlinePoints(exemplar, patch.box());
    const auto before = points;
    const std::vector<ScanlinePoint> three(points.begin(), points.begin() + 3);
    CHECK(warpToNeighbours(patch, three, 1, small(), points, {}) < 4);
    CHECK(warpToNeighbours(patch, {}, 1, small(), points, {}) == 0);
    for (std::size_t p = 0; p < points.size(); ++p) REQUIRE(length(points[p].point - before[p].point) == 0);
}

TEST_CASE("blendToNeighbours: points go to the surface by what a place keeps") {
    const PatchExemplar exemplar = test::exemplarOf(test::eggCratePoints({16, 0}, 48, 8), 48);
    const PointSetSurface surface(exemplar.points, exemplar.normals);
    const ScanlinePatch patch{8, 8, 24, 8, true, false};
    auto points = scanlinePoints(exemplar, patch.box());
    const float floor = points[0].point.z;
    for (ScanlinePoint& point : points) point.point.z += 0.8f;
    const auto before = points;
    blendToNeighbours(patch, surface, points, {});
    for (std::size_t p = 0; p < points.size(); ++p) {
        const double kept = patch.kept(before[p].point);
        REQUIRE(double(points[p].point.z - floor) == Approx(0.8 * (1 - kept)).margin(1e-3));
        REQUIRE(points[p].point.x == Approx(before[p].point.x).margin(1e-3));
        REQUIRE(int(points[p].blended) == (kept > 0 ? 1 : 0));
    }
}

TEST_CASE("scanlinePatches: a plane stays one, evenly covered") {
    const PatchExemplar exemplar = test::exemplarOf(test::eggCratePoints({16, 0}, 48, 8), 48);
    const ScanlineResult made = scanlinePatches(exemplar, paperField(exemplar), {70, 50, 3}, small());
    CHECK(double(made.sheet.size()) == Approx(76 * 56).epsilon(0.03));
    CHECK(made.patches == 6 * 5);
    CHECK(made.unwarped == 0);
    CHECK(made.pairs > 4 * 29);
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const Vec3f& at = made.sheet.points[p];
        REQUIRE(at.z == Approx(exemplar.points[0].z).margin(2e-3));
        REQUIRE((at.x >= -3 && at.y >= -3 && at.x < 73 && at.y < 53));
        REQUIRE(made.sheet.source[p] < exemplar.points.size());
        REQUIRE(made.sheet.patch[p] < 30);
    }
}

TEST_CASE("scanlinePatches: of a texture that repeats the heights are nearly the formula's") {
    // Gently curved: the paper's surface is off by h^2 over the radius.
    const test::EggCrate crate{32, 2};
    const PatchExemplar exemplar = test::eggCrateExemplar(crate, 64);
    ScanlineOptions options = small();
    options.seed = PatchPlace{4, 4};
    options.relax = false;
    const ScanlineResult made = scanlinePatches(exemplar, paperField(exemplar), {64, 64, 0}, options);
    // The seed patch lies a margin, 8, before the corner; both are counted from a corner of the crate.
    double worst = 0, sum = 0;
    for (const Vec3f& p : made.sheet.points) {
        const double off =
            std::abs(double(p.z) - crate.height - 2 - crate.at(double(p.x) + 16, double(p.y) + 16));
        worst = std::max(worst, off);
        sum += off * off;
    }
    CHECK(std::sqrt(sum / double(made.sheet.size())) < 0.3);
    CHECK(worst < 1);
    // The corner is the seed patch's own.
    std::size_t own = 0;
    for (std::size_t p = 0; p < made.sheet.size(); ++p) {
        const Vec3f& at = made.sheet.points[p];
        if (at.x >= 7 || at.y >= 7) continue;
        REQUIRE(made.sheet.patch[p] == 0);
        REQUIRE(length(at + Vec3f{16, 16, 0} - exemplar.points[made.sheet.source[p]]) < 1e-5f);
        ++own;
    }
    CHECK(own > 40);
}

TEST_CASE("scanlinePatches: what is refused") {
    const PatchExemplar exemplar = test::eggCrateExemplar({}, 32);
    const PatchField field = paperField(exemplar);
    const auto refused = [&](const auto& change) {
        ScanlineOptions options = small();
        change(options);
        return test::thrownBy([&] { scanlinePatches(exemplar, field, {20, 20, 0}, options); }).code;
    };
    const int invalid = int(ErrorCode::InvalidOption);
    CHECK(refused([](ScanlineOptions& o) { o.patch = 3; }) == invalid);
    CHECK(refused([](ScanlineOptions& o) { o.margin = 0; }) == invalid);
    CHECK(refused([](ScanlineOptions& o) { o.margin = 12; }) == invalid);
    for (const double bad : {-0.1, 10.1, std::nan("")})
        CHECK(refused([&](ScanlineOptions& o) { o.tolerance = bad; }) == invalid);
    for (const double bad : {-0.1, 0.34, std::nan("")})
        CHECK(refused([&](ScanlineOptions& o) { o.clusterVariation = bad; }) == invalid);
    for (const int bad : {1, 10001})
        CHECK(refused([&](ScanlineOptions& o) { o.clusterPoints = bad; }) == invalid);
    CHECK(refused([](ScanlineOptions& o) { o.pairing.rounds = 21; }) == invalid);
    CHECK(refused([](ScanlineOptions& o) { o.patch = 17; }) == int(ErrorCode::Unusable));
    for (const PatchPlace bad : {PatchPlace{-1, 0}, PatchPlace{0, -1}, PatchPlace{5, 0}, PatchPlace{0, 5}})
        CHECK(refused([&](ScanlineOptions& o) { o.seed = bad; }) == invalid);
    for (const Vec3d size : {Vec3d{0, 5, 0}, Vec3d{5, -1, 0}, Vec3d{std::nan(""), 5, 0}})
        CHECK(test::thrownBy([&] { scanlinePatches(exemplar, field, size, small()); }).code == invalid);
    CHECK(refused([](ScanlineOptions& o) { o.seed = PatchPlace{4, 4}; }) == -1);
}

TEST_CASE("scanlinePatches: same bits for any number of threads, another seed another sheet, cancelled",
          "[patch][tsan]") {
    const PatchExemplar exemplar = test::eggCrateExemplar({13.3, 3}, 40);
    const PatchField field = paperField(exemplar);
    const auto made = [&](int threads, std::uint64_t seed) {
        RunContext ctx = test::onThreads(threads);
        ctx.seed = seed;
        return scanlinePatches(exemplar, field, {40, 30, 2}, small(), ctx).sheet;
    };
    const SheetPoints one = made(1, 0), three = made(3, 0), other = made(2, 1);
    CHECK(sameBits(one.points, three.points));
    CHECK(sameBits(one.normals, three.normals));
    CHECK(one.source == three.source);
    CHECK(one.patch == three.patch);
    CHECK(!sameBits(one.points, other.points));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              scanlinePatches(exemplar, field, {40, 30, 2}, small(), ctx);
          }).code == int(ErrorCode::Cancelled));
}
