#include "libvdbsynth/relief/transfer/relief_transfer.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"
#include "tests/support/makers.h"
#include "tests/support/own_base.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace vdbsynth;

namespace {

ReliefTarget targetOf(BrickField distance, float reach) {
    ReliefTarget target;
    target.distance = std::move(distance);
    target.reach = reach;
    makeSites(target);
    return target;
}

ReliefTarget ground(float reach = 8) {
    return targetOf(
        test::fieldFrom({80, 80, 32},
                        [reach](const Index3& p) { return std::clamp(float(p.z) - 15.3f, -reach, reach); }),
        reach);
}

ReliefTarget ball(double radius, float reach = 8) {
    const int side = int(2 * (radius + double(reach))) + 8;
    return targetOf(test::fieldFrom({side, side, side},
                                    [=](const Index3& p) {
                                        const double m = 0.5 * (side - 1);
                                        const double r =
                                            std::sqrt((p.x - m) * (p.x - m) + (p.y - m) * (p.y - m) +
                                                      (p.z - m) * (p.z - m));
                                        return std::clamp(float(r - radius), -reach, reach);
                                    }),
                    reach);
}

// Waves along u: 16 texels long.
ReliefSample waves(float amplitude, int period = 16) {
    SampleImage image{64, 64, 1, true, {}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            image.values.push_back(amplitude * float(sine(2 * kPi * (x + 0.5) / period)));
    return reliefSample(image);
}

std::vector<Vec3f> allAlong(const ReliefTarget& target, const Vec3f& direction) {
    return std::vector<Vec3f>(target.point.size(), direction);
}

// The highest place of the surface over a voxel of the ground.
double heightOver(const BrickField& field, int x, int y) {
    for (int z = field.box().max.z; z > 0; --z) {
        const double below = double(field.at({x, y, z - 1})), above = double(field.at({x, y, z}));
        if (below <= 0) return z - 1 + below / (below - above);
    }
    return 0;
}

}  // namespace

TEST_CASE("relief on its own base: the scan again, to a tenth of a voxel") {
    // Bumps of one and a half voxels on a ball, charts of which overlap.
    const BrickField scan = test::fieldFrom({109, 109, 109}, [](const Index3& q) {
        const Vec3d p{q.x - 54., q.y - 54., q.z - 54.};
        const double r = length(p);
        if (r < 15) return -3.f;
        const Vec3d n = p * (1 / r);
        const double bumps = sine(9 * n.x) * sine(9 * n.y + 1) * sine(9 * n.z + 2);
        return float(std::clamp((r - 30 - 1.6 * bumps) / 1.1, -3.0, 3.0));
    });
    BaseOptions options;
    options.radius = 5;
    options.reach = 8;
    ReliefSampleOptions whole;
    whole.rough = 0;
    const auto base = std::make_shared<const BaseSurface>(baseSurface(scan, options));
    const std::vector<ReliefSample> samples{reliefSample(base, nullptr, whole)};
    REQUIRE(samples.front().charts > 1);
    const ReliefTarget target = test::ownBase(samples.front());
    const BrickField made = reliefOnTarget(target, samples, test::identityMap(target, samples.front()));
    CHECK(test::surfaceError(made, base->scan).rms < 0.1);
    CHECK(test::surfaceError(base->scan, made).rms < 0.1);
    CHECK(test::surfaceError(base->distance, base->scan).rms > 0.3);  // without relief
}

TEST_CASE("relief on a plane: waves along the direction, as high as the sample's") {
    ReliefTarget target = ground();
    target.direction = allAlong(target, {1, 0, 0});
    const std::vector<ReliefSample> samples{waves(2)};
    const ReliefMap map = matchRelief(target, samples);
    const BrickField made = reliefOnTarget(target, samples, map);
    double sum = 0, squares = 0;
    std::size_t count = 0;
    for (int x = 8; x < 72; ++x)  // four waves
        for (int y = 10; y < 70; ++y) {
            const double h = heightOver(made, x, y) - 15.3;
            sum += h;
            squares += h * h;
            ++count;
        }
    CHECK(sum / double(count) == Approx(0).margin(0.1));
    CHECK(std::sqrt(squares / double(count)) == Approx(2 / std::sqrt(2)).epsilon(0.05));
    // Rows across the direction are level.
    for (int x = 20; x < 60; x += 5)
        CHECK(heightOver(made, x, 25) == Approx(heightOver(made, x, 55)).margin(0.25));
}

TEST_CASE("relief of strength 0, and where a site's is 0, keeps the target's bits") {
    ReliefTarget target = ball(20);
    const std::vector<ReliefSample> samples{waves(1.5f)};
    const ReliefMap map = matchRelief(target, samples);
    ReliefTransferOptions options;
    options.strength = 0;
    const auto clamped = [&](const Index3& p) { return std::clamp(target.distance.at(p), -3.f, 3.f); };
    BrickField made = reliefOnTarget(target, samples, map, options);
    std::size_t differ = 0;
    forEachVoxel(made.box(), [&](const Index3& p) { differ += made.at(p) != clamped(p); });
    CHECK(differ == 0);

    // Half the ball is masked.
    const float middle = 0.5f * float(target.distance.box().size().x - 1);
    for (const Vec3f& p : target.point) target.strength.push_back(p.x > middle ? 1.f : 0.f);
    made = reliefOnTarget(target, samples, map);
    std::size_t masked = 0, changed = 0;
    forEachVoxel(made.box(), [&](const Index3& p) {
        if (float(p.x) < middle - 4) masked += made.at(p) != clamped(p);
        if (float(p.x) > middle + 4) changed += made.at(p) != clamped(p);
    });
    CHECK(masked == 0);
    CHECK(changed > 1000);
}

TEST_CASE("relief that carves leaves a wall") {
    // A slab six voxels thick.
    ReliefTarget target = targetOf(
        test::fieldFrom({64, 64, 40},
                        [](const Index3& p) { return std::clamp(std::abs(float(p.z) - 20) - 3, -8.f, 8.f); }),
        8);
    target.direction = allAlong(target, {1, 0, 0});
    const std::vector<ReliefSample> samples{waves(4)};
    const ReliefMap map = matchRelief(target, samples);
    const auto thinnest = [&](double minWall) {
        ReliefTransferOptions options;
        options.minWall = minWall;
        const BrickField made = reliefOnTarget(target, samples, map, options);
        int least = 1000;
        for (int x = 8; x < 56; ++x)
            for (int y = 8; y < 56; ++y) {
                int solid = 0;
                for (int z = 0; z < 40; ++z) solid += made.at({x, y, z}) < 0;
                least = std::min(least, solid);
            }
        return least;
    };
    CHECK(thinnest(0) == 0);
    CHECK(thinnest(4) >= 3);
    CHECK(thinnest(6) >= 5);
}

TEST_CASE("relief on a ball with free directions: amplitude and closed mesh") {
    ReliefTarget target = ball(30);
    const std::vector<ReliefSample> samples{waves(1.5f)};
    const BrickField made = reliefOnTarget(target, samples, matchRelief(target, samples));
    const Mesh mesh = zeroLevel(made, made.box(), Facing::Outward);
    const double m = 0.5 * (target.distance.box().size().x - 1);
    double squares = 0;
    for (const Vec3f& p : mesh.points) {
        const double r = length(cast<double>(p) - Vec3d{m, m, m}) - 30;
        REQUIRE(std::abs(r) < 1.9);
        squares += r * r;
    }
    CHECK(std::sqrt(squares / double(mesh.points.size())) == Approx(1.5 / std::sqrt(2)).epsilon(0.1));
}

TEST_CASE("relief transfer: threads, cancel, every error") {
    const ReliefTarget target = ball(15);
    const std::vector<ReliefSample> samples{waves(1)};
    const ReliefMap one = matchRelief(target, samples, {}, test::onThreads(1)),
                    four = matchRelief(target, samples, {}, test::onThreads(4));
    for (std::size_t i = 0; i < one.coordinate.size(); ++i)
        REQUIRE(one.coordinate[i].x == four.coordinate[i].x);
    CHECK(test::samplesOf(reliefOnTarget(target, samples, one, {}, test::onThreads(1))) ==
          test::samplesOf(reliefOnTarget(target, samples, one, {}, test::onThreads(4))));
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { reliefOnTarget(target, samples, one, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));

    CHECK_THROWS_AS(matchRelief(ReliefTarget{}, samples), Error);
    ReliefTarget wrong = target;
    wrong.strength = {1};
    CHECK_THROWS_AS(matchRelief(wrong, samples), Error);
    wrong = target;
    wrong.reach = 2;
    CHECK_THROWS_AS(reliefOnTarget(wrong, samples, one), Error);
    ReliefMap other = one;
    other.sample.pop_back();
    CHECK_THROWS_AS(reliefOnTarget(target, samples, other), Error);
    for (const auto& change : std::vector<std::function<void(ReliefTransferOptions&)>>{
             [](auto& o) { o.texel = 0; }, [](auto& o) { o.strength = 101; }, [](auto& o) { o.minWall = -1; },
             [](auto& o) { o.synthesis.passes = 21; }}) {
        ReliefTransferOptions options;
        change(options);
        CHECK_THROWS_AS(validate(options), Error);
    }
    ReliefTarget empty;
    empty.distance = BrickField(IndexBox::fromSize({8, 8, 8}), 3);
    CHECK_THROWS_AS(makeSites(empty), Error);
}
