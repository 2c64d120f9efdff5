#include "libvdbsynth/distance/distance_transform.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

const Vec3d kCentre{31.4, 30.8, 32.1};

double ballDistance(const Vec3d& p) {
    return length(p - kCentre) - 20;
}
BrickField ball() {
    return test::fieldFrom({64, 64, 64}, [](const Index3& p) {
        return float(std::clamp(ballDistance({double(p.x), double(p.y), double(p.z)}), -3.0, 3.0));
    });
}

}  // namespace

TEST_CASE("distancesToSurface: within a third of a voxel of a ball's true distances", "[distance][oracle]") {
    const BrickField field = ball();
    const Distances all = distancesToSurface(field, 3, 1);
    double worst = 0, sum = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        const double off =
            std::abs(double(all.at(p)) - ballDistance({double(p.x), double(p.y), double(p.z)}));
        worst = std::max(worst, off);
        sum += off;
    });
    CHECK(worst < 0.34);
    CHECK(sum / (64 * 64 * 64) < 0.05);
}

TEST_CASE("distancesToSurface: the nearest foot is the nearest", "[distance][oracle]") {
    // Feet are where single voxels of a surface say; the brute search is over the same feet.
    const Index3 size{17, 13, 15};
    const BrickField solid = test::fieldFrom(size, [](const Index3& p) {
        return Random(2, std::uint64_t((p.x * 50 + p.y) * 50 + p.z)).uniform() < 0.02 ? 0.f : 3.f;
    });
    std::vector<Vec3d> feet;
    forEachVoxel(solid.box(), [&](const Index3& q) {
        if (solid.at(q) == 0) feet.push_back({double(q.x), double(q.y), double(q.z)});
    });
    REQUIRE(feet.size() > 20);
    const Distances outside = distancesToSurface(solid, 0, 1);
    forEachVoxel(solid.box(), [&](const Index3& p) {
        double best = 1e9;
        for (const Vec3d& foot : feet)
            best = std::min(best, length(foot - Vec3d{double(p.x), double(p.y), double(p.z)}));
        REQUIRE(double(outside.at(p)) == Approx(best).margin(1e-4));
    });
}

TEST_CASE("distancesToSurface: on every second and fourth voxel the ball is as far away",
          "[distance][oracle]") {
    for (const int coarsening : {2, 3, 4}) {
        const Distances all = distancesToSurface(ball(), 3, coarsening);
        const int side = (64 + coarsening - 1) / coarsening;
        REQUIRE(all.size == Index3{side, side, side});
        REQUIRE(all.values.size() == std::size_t(side * side * side));
        const double middle = (coarsening - 1) / 2.0;
        double worst = 0;
        // The last sample of a side may have voxels beyond the box.
        forEachVoxel(IndexBox::fromSize({side - 1, side - 1, side - 1}), [&](const Index3& p) {
            const Vec3d at{p.x * coarsening + middle, p.y * coarsening + middle, p.z * coarsening + middle};
            worst = std::max(worst, std::abs(double(all.at(p)) * coarsening - ballDistance(at)));
        });
        CAPTURE(coarsening);
        CHECK(worst < 0.45 * coarsening);
    }
}

TEST_CASE("distancesToSurface: values within the band stay, and solid and void may be exchanged",
          "[distance][property]") {
    const BrickField field = test::ballsField({30, 26, 28}, 7, 6.f);
    const BrickField turned = test::fieldFrom({30, 26, 28}, [&](const Index3& p) {
        return -field.at({p.x, p.y, p.z});
    });
    const Distances all = distancesToSurface(field, 2.5f, 1), other = distancesToSurface(turned, 2.5f, 1);
    forEachVoxel(field.box(), [&](const Index3& p) {
        const float value = field.at(p);
        if (std::abs(value) < 2.5f) REQUIRE(all.at(p) == value);
        REQUIRE((all.at(p) < 0) == (value < 0));
        REQUIRE(other.at(p) == -all.at(p));
    });
}

TEST_CASE("distancesToSurface: without a surface as far as the longest side, also for one voxel",
          "[distance][degenerate]") {
    const IndexBox box = IndexBox::fromSize({17, 13, 15});
    for (float value : distancesToSurface(BrickField(box, -3.f), 0, 1).values) REQUIRE(value == -17);
    for (float value : distancesToSurface(BrickField(box, 3.f), 3, 2).values) REQUIRE(value == 9);
    const IndexBox one = IndexBox::fromSize({1, 1, 1});
    CHECK(distancesToSurface(BrickField(one, 3.f), 3, 1).values == std::vector<float>{1});
    CHECK(distancesToSurface(BrickField(one, -0.25f), 3, 1).values == std::vector<float>{-0.25f});
}

TEST_CASE("distancesToSurface: same bits for any number of threads, memory is asked for, cancel is heard",
          "[distance][threads][error][cancel]") {
    const BrickField field = test::ballsField({60, 50, 40}, 2, 3.f, 12);
    for (const int coarsening : {1, 2}) {
        const auto made = [&](const RunContext& ctx) {
            return distancesToSurface(field, 3, coarsening, ctx).values;
        };
        CHECK(made(test::onThreads(1)) == made(test::onThreads(4)));
        CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
        RunContext small;
        small.maxMemory = 1000;
        CHECK(test::thrownBy([&] { made(small); }).code == int(ErrorCode::Memory));
        small.maxMemory = 60 * 50 * 40 * 8;
        CHECK(test::thrownBy([&] { made(small); }).code == -1);
    }
}
