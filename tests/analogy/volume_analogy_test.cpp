#include "libvdbsynth/analogy/volume_analogy.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libvdbsynth/analogy/analogy_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "tests/support/shapes.h"

using namespace vdbsynth;

namespace {

FrameField framesAlong(std::shared_ptr<const BrickField> field, const Vec3f& direction) {
    SurfaceShell shell = surfaceShell(*field);
    DirectionField directions = directionField(shell, std::vector<Vec3f>(shell.size(), direction));
    SweepDistance sweep = sweepDistance(shell, directions.tangent);
    return FrameField(std::move(field), std::move(shell), std::move(directions), std::move(sweep));
}

struct Setting {
    std::shared_ptr<const BrickField> plain, textured, target;
    FrameField plainFrames, targetFrames;
    AnalogyPair pair() const { return {plain, textured, &plainFrames, plain->box()}; }
};

// A plane and the same with grooves along x, eight voxels apart; a plane to put them on, its x and y swapped.
Setting grooves() {
    const auto plain = test::planeField(48, 20);
    const auto textured = test::shapeField({48, 48, 48}, [](const Vec3d& p) {
        return p.z - 20 + 1.5 * (1 + std::cos(2 * 3.14159265358979 * p.y / 8));
    });
    const auto target = test::planeField(40, 19.5);
    return {plain, textured, target, framesAlong(plain, {1, 0, 0}), framesAlong(target, {0, 1, 0})};
}

VolumeAnalogyOptions levels(int count) {
    VolumeAnalogyOptions options;
    options.levels = count;
    return options;
}

// The result's field.
BrickField read(const VolumeAnalogyResult& made, const std::shared_ptr<const BrickField>& textured,
                const BrickField& target) {
    return readAnalogy(made.sources, made.depths, target.box(), {{textured, {0, 0, 0}, 1}}, target);
}

}  // namespace

TEST_CASE("makeAnalogy: dilation of a ball learnt from another is an offset", "[analogy]") {
    const auto plain = test::sphereField(48, 11), textured = test::sphereField(48, 14.5),
               target = test::sphereField(44, 9);
    const FrameField from = framesAlong(plain, {0, 0, 1}), to = framesAlong(target, {0, 0, 1});
    const VolumeAnalogyResult made =
        makeAnalogy({{plain, textured, &from, plain->box()}}, *target, to, levels(2));
    const BrickField distance = read(made, textured, *target);
    std::vector<double> off;
    for (int i = 0; i < 500; ++i) {
        Random random(1, std::uint64_t(i));
        const Vec3f out =
            normalized(Vec3f{float(random.normal()), float(random.normal()), float(random.normal())});
        // Where the ray from the middle leaves the solid.
        float r = 6;
        while (r < 20 && sampleTrilinear(distance, Vec3f{21.5f, 21.5f, 21.5f} + out * r) < 0) r += 0.05f;
        off.push_back(std::abs(double(r) - 9 - 3.5));
    }
    std::sort(off.begin(), off.end());
    CHECK(std::accumulate(off.begin(), off.end(), 0.0) / double(off.size()) < 0.3);
    CHECK(off[off.size() * 95 / 100] < 0.6);
    CHECK(off.back() < 1);
}

TEST_CASE("makeAnalogy: grooves follow the target's direction, at the pair's spacing", "[analogy]") {
    const Setting s = grooves();
    const VolumeAnalogyResult made = makeAnalogy({s.pair()}, *s.target, s.targetFrames, levels(1));
    const BrickField distance = read(made, s.textured, *s.target);
    // Heights differ across x, the grooves' other axis here, and hardly along y.
    std::vector<std::vector<float>> height(40, std::vector<float>(40));
    for (int x = 0; x < 40; ++x)
        for (int y = 0; y < 40; ++y) {
            float z = 8;
            while (z < 30 && sampleTrilinear(distance, {float(x), float(y), z}) < 0) z += 0.1f;
            height[std::size_t(x)][std::size_t(y)] = z;
        }
    double across = 0, along = 0;
    int valleys = 0;
    for (std::size_t x = 8; x < 32; ++x)
        for (std::size_t y = 8; y < 32; ++y) {
            across += std::abs(double(height[x + 1][y] - height[x][y]));
            along += std::abs(double(height[x][y + 1] - height[x][y]));
        }
    for (std::size_t x = 5; x < 35; ++x) valleys += height[x][20] < 18 && height[x - 1][20] >= 18;
    CHECK(across > 4 * along);
    CHECK(valleys >= 3);
    CHECK(valleys <= 5);
    REQUIRE(made.sources.size() > 1000);
    for (std::size_t i = 0; i < made.sources.size(); ++i) {
        const Source& source = *made.sources.strongest(i);
        CHECK(s.plain->box().contains(nearestVoxel(source)));
        CHECK(source.exemplar == 0);
    }
}

TEST_CASE("makeAnalogy: the same bits for any threads, other bits for another seed", "[analogy][tsan]") {
    const Setting s = grooves();
    RunContext one, four, other;
    one.threads = 1;
    four.threads = 4;
    other.seed = 7;
    const auto made = [&](const RunContext& ctx) {
        return test::samplesOf(
            read(makeAnalogy({s.pair()}, *s.target, s.targetFrames, levels(2), ctx), s.textured, *s.target));
    };
    const std::vector<float> a = made(one);
    CHECK(a == made(four));
    CHECK(a != made(other));
}

TEST_CASE("makeAnalogy: refuses what it cannot work with, and stops when asked to", "[analogy]") {
    const Setting s = grooves();
    const auto code = [&](const VolumeAnalogyOptions& options, const RunContext& ctx = {}) {
        return test::thrownBy([&] { makeAnalogy({s.pair()}, *s.target, s.targetFrames, options, ctx); }).code;
    };
    VolumeAnalogyOptions options;
    options.levels = 7;
    CHECK(code(options) == int(ErrorCode::InvalidOption));
    for (int sweeps : {0, 11, -1}) {
        options = {};
        options.sweeps = sweeps;
        CHECK(code(options) == int(ErrorCode::InvalidOption));
    }
    options = {};
    options.half = 5;
    CHECK(code(options) == int(ErrorCode::InvalidOption));
    options = {};
    options.coherence = -1;
    CHECK(code(options) == int(ErrorCode::InvalidOption));
    CHECK(code(levels(5)) == int(ErrorCode::Unusable));  // 48 voxels are three at the coarsest
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(code(levels(1), stopped) == int(ErrorCode::Cancelled));
}

TEST_CASE("usefulLevels: thin things hold fewer", "[analogy]") {
    // A level has to be 36 voxels wide: two are no use to a field of 64.
    for (const auto& [side, levels] : {std::pair{144, 3}, std::pair{96, 2}, std::pair{64, 1}}) {
        const auto flat = test::planeField(side, 20), step = test::planeField(side, 32);
        const FrameField along = framesAlong(flat, {1, 0, 0});
        CHECK(usefulLevels({{flat, step, &along, flat->box()}}) == levels);
    }
    const auto plain = test::planeField(96, 20);
    const auto needles = test::shapeField({96, 96, 96}, [](const Vec3d& p) {
        const double x = std::fmod(p.x, 12) - 6, y = std::fmod(p.y, 12) - 6;
        return std::min(p.z - 20, std::max(p.z - 30, std::sqrt(x * x + y * y) - 1.2));
    });
    const FrameField frames = framesAlong(plain, {1, 0, 0});
    CHECK(usefulLevels({{plain, needles, &frames, plain->box()}}) < 3);
}

TEST_CASE("makeAnalogy: curvature-adapted neighbourhoods, same bits for any number of threads",
          "[analogy][determinism]") {
    // On balls: on a plane nothing bends.
    const auto plain = test::sphereField(48, 14), target = test::sphereField(44, 11);
    const auto textured = test::shapeField({48, 48, 48}, [](const Vec3d& p) {
        return length(p - Vec3d{23.5, 23.5, 23.5}) - 14 +
               1.5 * (1 + std::cos(2 * 3.14159265358979 * p.z / 8));
    });
    const Setting s{plain, textured, target, framesAlong(plain, {0, 0, 1}), framesAlong(target, {0, 0, 1})};
    VolumeAnalogyOptions adapted = levels(1), straight = levels(1);
    adapted.curvatureAdapted = true;
    straight.curvatureAdapted = false;
    RunContext one, three;
    one.threads = 1;
    three.threads = 3;
    const auto made = [&](const VolumeAnalogyOptions& options, const RunContext& ctx) {
        return test::samplesOf(
            read(makeAnalogy({s.pair()}, *s.target, s.targetFrames, options, ctx), s.textured, *s.target));
    };
    const std::vector<float> once = made(adapted, one);
    CHECK(once == made(adapted, three));
    CHECK(once != made(straight, one));
}
