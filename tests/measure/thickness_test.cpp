#include "libvdbsynth/measure/thickness.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <numeric>

using namespace vdbsynth;

namespace {

BrickField distances(const Index3& size, float band, const std::function<double(const Vec3d&)>& distance) {
    return test::fieldFrom(size, [&](const Index3& p) {
        return float(
            std::clamp(distance({double(p.x), double(p.y), double(p.z)}), -double(band), double(band)));
    });
}

ThicknessSummary solidSummary(const BrickField& field, int coarsening = 1) {
    return summarize(localThickness(distancesToSurface(field, 3, coarsening), coarsening, Phase::Solid),
                     field.box(), 40);
}

}  // namespace

TEST_CASE("localThickness: a ball is as thick as its diameter, everywhere", "[measure][oracle]") {
    for (double radius : {5.0, 11.5, 26.0}) {  // the last one is drawn on a coarser lattice
        const BrickField field = distances({64, 64, 64}, 3, [&](const Vec3d& p) {
            return length(p - Vec3d{31.6, 32.2, 31.9}) - radius;
        });
        const ThicknessSummary summary = solidSummary(field);
        CHECK(summary.largest == Approx(2 * radius).margin(1.0));
        CHECK(summary.mean == Approx(2 * radius).margin(1.0));
        CHECK(summary.deviation < 0.06 * radius);
    }
}

TEST_CASE("localThickness: slabs, cylinders and the space between", "[measure][oracle]") {
    const BrickField slab =
        distances({60, 60, 60}, 3, [](const Vec3d& p) { return std::abs(p.z - 29.7) - 6.3; });
    CHECK(solidSummary(slab).mean == Approx(12.6).margin(1.0));
    CHECK(solidSummary(slab).deviation < 0.3);
    const BrickField cylinder =
        distances({64, 64, 40}, 3, [](const Vec3d& p) { return std::hypot(p.x - 31.7, p.y - 32.2) - 13.2; });
    CHECK(solidSummary(cylinder).mean == Approx(26.4).margin(1.0));
    const BrickField gap =
        distances({60, 60, 60}, 3, [](const Vec3d& p) { return 5.2 - std::abs(p.z - 29.7); });
    CHECK(summarize(localThickness(distancesToSurface(gap, 3, 1), 1, Phase::Void), gap.box(), 40).mean ==
          Approx(10.4).margin(1.0));
}

TEST_CASE("localThickness: at half the resolution the same within a voxel and a half", "[measure][oracle]") {
    const BrickField slab =
        distances({60, 60, 60}, 3, [](const Vec3d& p) { return std::abs(p.z - 29.7) - 6.3; });
    const Thickness half = localThickness(distancesToSurface(slab, 3, 2), 2, Phase::Solid);
    CHECK(half.coarsening == 2);
    CHECK(summarize(half, slab.box(), 40).mean == Approx(12.6).margin(1.5));
    const Thickness quarter = localThickness(distancesToSurface(slab, 3, 4), 4, Phase::Solid);
    CHECK(quarter.coarsening == 4);
    CHECK(summarize(quarter, slab.box(), 40).mean == Approx(12.6).margin(2));
    // What is much thicker than the band stays so where samples are wider than it.
    const BrickField large = distances({96, 96, 96}, 3, [](const Vec3d& p) {
        return length(p - Vec3d{47, 48, 46}) - 38;
    });
    for (int coarsening : {1, 2, 4, 8})
        CHECK(solidSummary(large, coarsening).largest == Approx(76).margin(1.0 + 0.3 * coarsening));
}

TEST_CASE("localThickness: is the largest ball that holds the voxel, by search over all balls",
          "[measure][oracle]") {
    const BrickField field = test::ballsField({26, 24, 25}, 8, 3.f, 7);
    const Thickness thickness = localThickness(distancesToSurface(field, 3, 1), 1, Phase::Solid);
    const Distances all = distancesToSurface(field, 3, 1);
    for (int x = 0; x < 26; ++x)
        for (int y = 0; y < 24; ++y)
            for (int z = 0; z < 25; ++z) {
                // The search has balls at voxels only, whose radius is up to 0.87 below the best nearby; and
                // what a ball all but holds counts as held.
                float best = 0, most = 0;
                if (all.at({x, y, z}) < 0)
                    for (int a = 0; a < 26; ++a)
                        for (int b = 0; b < 24; ++b)
                            for (int c = 0; c < 25; ++c) {
                                const float d = -all.at({a, b, c});
                                if (d <= 0) continue;
                                const float apart = length(Vec3f{float(a - x), float(b - y), float(c - z)});
                                if (apart <= d) best = std::max(best, 2 * d);
                                if (apart <= d + 1.25f) most = std::max(most, 2 * d + 1.75f);
                            }
                const std::size_t i = std::size_t((x * 24 + y) * 25 + z);
                REQUIRE(thickness.diameter[i] <= most);
                REQUIRE(thickness.diameter[i] >= best - 0.1f);
            }
}

TEST_CASE("localThickness: the same for any number of threads, shares sum to one", "[measure][determinism]") {
    const BrickField field = test::ballsField({50, 40, 45}, 2, 3.f, 12);
    RunContext one;
    one.threads = 1;
    CHECK(localThickness(distancesToSurface(field, 3, 1, one), 1, Phase::Void, one).diameter ==
          localThickness(distancesToSurface(field, 3, 1), 1, Phase::Void).diameter);
    const ThicknessSummary summary = solidSummary(field);
    CHECK(std::accumulate(summary.share.begin(), summary.share.end(), 0.0) == Approx(1));
    CHECK(solidSummary(BrickField(field.box(), 1.f)).mean == 0);
}
