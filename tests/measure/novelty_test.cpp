#include "libvdbsynth/measure/novelty.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("measureNovelty: runs, seams and use, counted by hand", "[measure][oracle]") {
    // A row of six voxels: three from one place, two from another, one alone.
    std::vector<SourcedVoxel> voxels;
    const int sources[6] = {10, 11, 12, 40, 41, 90};
    for (int x = 0; x < 6; ++x) voxels.push_back({{x, 0, 0}, {sources[x], 5, 5}, 0});
    // The field's slope along x changes at 2 and 4 only, between different runs.
    const float heights[8] = {0, 1, 2, 3, 6, 9, 10, 11};
    const BrickField field =
        test::fieldFrom({8, 8, 8}, [&](const Index3& p) { return heights[std::min(7, p.x)]; });
    // An exemplar of a plane at z = 5: 2 layers of 100 x 10 are near it; one of the sources lies outside the
    // box.
    const BrickField exemplar =
        test::fieldFrom({100, 10, 16}, [](const Index3& p) { return float(p.z) - 5.f; });
    const IndexBox counted{{0, 0, 0}, {89, 9, 15}};
    const Novelty n = measureNovelty(voxels, 10, field, exemplar, counted);
    CHECK(n.voxels == 6);
    CHECK(n.verbatimShare == Approx(0.5));  // 5 of the 10 looked at
    CHECK(n.meanRun == Approx(2.5));
    CHECK(n.largestRun == 3);
    CHECK(n.exemplarUsed == Approx(5.0 / (90 * 10 * 3)));
    CHECK(n.largestShare == Approx(3.0 / (90 * 10 * 3)));
    CHECK(n.seamShare == Approx(2.0 / 5));
    // Gradients at 0..5: (0.5 at the clamped face) 0.5 1 1 2 3 2; seams 2-3, 4-5: 1, 1; inside 0.5, 0, 1.
    CHECK(n.seamRatio == Approx(1.0 / 0.5));
    CHECK(measureNovelty({}, 0, field, exemplar, counted).voxels == 0);
}

TEST_CASE("measureNovelty: another exemplar's voxels are another run", "[measure][oracle]") {
    std::vector<SourcedVoxel> voxels{{{0, 0, 0}, {0, 0, 0}, 0}, {{0, 0, 1}, {0, 0, 1}, 1}};
    const BrickField flat(IndexBox::fromSize({8, 8, 8}), 0.f);
    const Novelty n = measureNovelty(voxels, 2, flat, flat, flat.box());
    CHECK(n.largestRun == 0);
    CHECK(n.seamShare == 1);
}

TEST_CASE("verifiedShare: counts values within a quarter voxel of their source's", "[measure][oracle]") {
    const BrickField exemplar = test::fieldFrom({8, 8, 8}, [](const Index3& p) { return float(p.z) - 3.5f; });
    const BrickField result = test::fieldFrom(
        {8, 8, 8}, [](const Index3& p) { return float(p.z) - 3.5f + (p.x < 4 ? 0.2f : 0.3f); });
    std::vector<SourcedVoxel> voxels;
    for (int x = 0; x < 8; ++x) voxels.push_back({{x, 1, 3}, {2, 2, 3}, 0});
    CHECK(verifiedShare(voxels, result, exemplar) == Approx(0.5));
    voxels.push_back({{0, 0, 0}, {100, 0, 0}, 0});  // points outside
    CHECK(verifiedShare(voxels, result, exemplar) == Approx(4.0 / 9));
    CHECK(verifiedShare({}, result, exemplar) == 0);
}

TEST_CASE("sourcesByMatching: finds a copy whole and no run of size in another sample",
          "[measure][property]") {
    const auto exemplar = std::make_shared<const BrickField>(test::ballsField({64, 64, 64}, 1, 3.f, 60));
    const Index3 shift{7, 5, 11};
    const auto copy = std::make_shared<const BrickField>(
        test::fieldFrom({40, 40, 40}, [&](const Index3& p) { return exemplar->at(p + shift); }));
    const MatchedSources found = sourcesByMatching(copy, copy->box(), exemplar, exemplar->box());
    REQUIRE(found.looked > 1000);
    std::size_t right = 0;
    for (const SourcedVoxel& v : found.voxels) right += v.source - v.place == shift;
    CHECK(double(right) > 0.97 * double(found.looked));
    const Novelty n = measureNovelty(found.voxels, found.looked, *copy, *exemplar, exemplar->box());
    CHECK(n.verbatimShare > 0.97);
    CHECK(n.largestRun > 0.3 * double(found.looked));

    const auto other = std::make_shared<const BrickField>(test::ballsField({64, 64, 64}, 2, 3.f, 60));
    const MatchedSources none = sourcesByMatching(other, other->box(), exemplar, exemplar->box());
    // One ball is as good as another; no arrangement of them comes twice.
    const Novelty fresh = measureNovelty(none.voxels, none.looked, *other, *exemplar, exemplar->box());
    CHECK(fresh.largestRun < 0.1 * double(none.looked));
}

TEST_CASE("sourcesByMatching: of a large shell a compact piece of its surface, not the hollow middle",
          "[measure][property]") {
    const auto shell =
        std::make_shared<const BrickField>(test::fieldFrom({200, 200, 200}, [](const Index3& p) {
            const Vec3f d{float(p.x) - 99.3f, float(p.y) - 99.6f, float(p.z) - 99.1f};
            return std::clamp(length(d) - 90.f, -3.f, 3.f);
        }));
    const MatchedSources found = sourcesByMatching(shell, shell->box(), shell, shell->box());
    CHECK(found.looked > 20000);
    // Of 6000 patches at most, each with 4^3 voxels, and in one piece.
    CHECK(found.looked < 6000 * 64);
    CHECK(double(found.box.volume()) < 0.75 * double(shell->box().volume()));
    const Novelty n = measureNovelty(found.voxels, found.looked, *shell, *shell, shell->box());
    CHECK(n.verbatimShare > 0.9);
    CHECK(n.exemplarUsed < 1);
}
