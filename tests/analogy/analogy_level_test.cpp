#include "libvdbsynth/analogy/analogy_level.h"

#include <catch2/catch.hpp>

#include "tests/support/shapes.h"

#include <atomic>
#include <map>

using namespace vdbsynth;

namespace {

FrameField framesAlong(std::shared_ptr<const BrickField> field, const Vec3f& direction) {
    SurfaceShell shell = surfaceShell(*field);
    DirectionField directions = directionField(shell, std::vector<Vec3f>(shell.size(), direction));
    SweepDistance sweep = sweepDistance(shell, directions.tangent);
    return FrameField(std::move(field), std::move(shell), std::move(directions), std::move(sweep));
}

}  // namespace

TEST_CASE("analogyPyramid: distances in voxels of the level, densities of them", "[analogy][oracle]") {
    CHECK(densityOf(0) == 0.5f);
    CHECK(densityOf(-0.5f) == 0.75f);
    CHECK(densityOf(1) == 0);
    CHECK(densityOf(-7) == 1);
    const auto plane = test::planeField(24, 10);
    const AnalogyPyramid pyramid = analogyPyramid(*plane, 3, {});
    REQUIRE((pyramid.distance.size() == 3 && pyramid.density.size() == 3));
    for (int level = 0; level < 3; ++level) {
        const BrickField& distance = pyramid.distance[std::size_t(level)];
        const BrickField& density = pyramid.density[std::size_t(level)];
        CHECK(distance.box().size() == Index3{24 >> level, 24 >> level, 24 >> level});
        forEachVoxel(distance.box(), [&](const Index3& p) {
            const float at = toFinest({0, 0, float(p.z)}, level).z;
            if (std::abs(at - 10) < 8)  // beyond it distances are clamped
                REQUIRE(distance.at(p) == Approx((at - 10) / float(1 << level)).margin(1e-5));
            REQUIRE(density.at(p) == densityOf(distance.at(p)));
        });
    }
}

TEST_CASE("toFinest: the middle of the finest voxels in a coarse one", "[analogy][oracle]") {
    const Vec3f same = toFinest({3, -1, 2.5f}, 0), coarse = toFinest({0, 1, 2}, 2);
    CHECK((same.x == 3 && same.y == -1 && same.z == 2.5f));
    CHECK((coarse.x == 1.5f && coarse.y == 5.5f && coarse.z == 9.5f));
}

TEST_CASE("analogyVoxels: the surface's frames, or the grid's axes in slice order", "[analogy][oracle]") {
    const auto plane = test::planeField(32, 15.5);
    const FrameField frames = framesAlong(plane, {0, 1, 0});
    const VoxelTable table = VoxelTable::where(*plane, [](float d) { return std::abs(d) < 3; }, {});
    const AnalogyVoxels aligned = analogyVoxels(table, frames, 0, true, false, {});
    const AnalogyVoxels naive = analogyVoxels(table, frames, 1, false, false, {});
    REQUIRE(aligned.table.size() == 32 * 32 * 6);
    REQUIRE(naive.frame.size() == table.size());
    const float shift = aligned.sweep[0] - float(aligned.table[0].y);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Frame& f = aligned.frame[i];
        REQUIRE((f.t.y > 0.999f && f.n.z > 0.999f && f.b.x > 0.999f));
        REQUIRE(aligned.sweep[i] - float(aligned.table[i].y) == Approx(shift).margin(0.1));
        REQUIRE((naive.frame[i].t.x == 1 && naive.frame[i].n.z == 1 && naive.frame[i].b.y == -1));
        REQUIRE(naive.sweep[i] == 2 * float(naive.table[i].x) + 0.5f);
        REQUIRE(
            (aligned.curvature[i].tt == 0 && aligned.curvature[i].tb == 0 && aligned.curvature[i].bb == 0));
    }
}

TEST_CASE("analogyVoxels: voxels far from the surface take their neighbours' frames", "[analogy][property]") {
    // Over 12 voxels from the plane distances do not grow, so there is no nearest surface point.
    const auto plane = test::planeField(32, 5.5);
    const FrameField frames = framesAlong(plane, {1, 0, 0});
    std::vector<Index3> voxels;
    for (int z = 31; z >= 6; --z) voxels.push_back({16, 16, z});
    Frame frame;
    float sweep;
    REQUIRE_FALSE(frames.at({16, 16, 31}, frame, sweep));
    REQUIRE(frames.at({16, 16, 6}, frame, sweep));
    const AnalogyVoxels found =
        analogyVoxels(VoxelTable::of(plane->box(), voxels), frames, 0, true, false, {});
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        INFO(voxels[i].z);
        CHECK(found.frame[i].n.z > 0.99f);
        CHECK(found.frame[i].t.x > 0.99f);
        CHECK(found.sweep[i] == Approx(sweep).margin(0.05));
    }
    // A part without any frame keeps the grid's axes.
    const AnalogyVoxels apart =
        analogyVoxels(VoxelTable::of(plane->box(), {{16, 16, 30}, {16, 16, 31}}), frames, 0, true, false, {});
    CHECK((apart.frame[0].t.x == 1 && apart.frame[0].n.z == 1 && apart.sweep[0] == 0));
}

TEST_CASE("analogyVoxels: bends are those of the surface through a voxel", "[analogy][oracle]") {
    const auto curvatures = [](std::shared_ptr<const BrickField> field, const Vec3f& along, int level) {
        const FrameField frames = framesAlong(field, along);
        const BrickField coarse = analogyPyramid(*field, level + 1, {}).distance.back();
        return analogyVoxels(VoxelTable::where(coarse, [](float d) { return d > -0.5f && d < 0.5f; }, {}),
                             frames, level, true, true, {});
    };
    for (int level : {0, 1}) {
        const float expected = float(1 << level) / 15;  // per voxel of the level
        for (const Curvature& curvature : curvatures(test::sphereField(48, 15), {0, 0, 1}, level).curvature) {
            CHECK(curvature.tt == Approx(expected).margin(0.02f));
            CHECK(curvature.bb == Approx(expected).margin(0.02f));
            CHECK(curvature.tb == Approx(0).margin(0.02f));
        }
    }
    // Along a cylinder nothing bends, around it all does.
    const AnalogyVoxels along = curvatures(test::cylinderField(48, 10), {0, 0, 1}, 0);
    REQUIRE(along.curvature.size() > 100);
    for (std::size_t i = 0; i < along.curvature.size(); ++i) {
        if (along.table[i].z < 8 || along.table[i].z > 40) continue;
        CHECK(along.curvature[i].tt == Approx(0).margin(0.02f));
        CHECK(along.curvature[i].bb == Approx(0.1f).margin(0.03f));
    }
}

TEST_CASE("analogyVoxels: curvature ends at its limit", "[analogy][degenerate]") {
    const auto needle = test::cylinderField(24, 2.5);
    const FrameField frames = framesAlong(needle, {0, 0, 1});
    const AnalogyVoxels voxels =
        analogyVoxels(VoxelTable::where(*needle, [](float d) { return std::abs(d) < 0.5f; }, {}), frames, 0,
                      true, true, {});
    REQUIRE(voxels.curvature.size() > 50);
    for (const Curvature& curvature : voxels.curvature) CHECK(curvature.bb == kMostCurvature);
}

TEST_CASE("DepthClasses: open where depths near by do not agree", "[analogy][oracle]") {
    DepthClasses depths(2);
    for (int d = -10; d <= 10; ++d) {
        // A shell three voxels thick with a rough outside: full from -4 to -2, mixed at -1 to 0, else empty.
        depths.add(float(d), d < -4 ? 3.f : d < -1 ? -2.f : d > 0 ? 2.f : 0.f);
    }
    depths.finish();
    for (int d : {-9, -8, 3, 4, 10, 300}) CHECK_FALSE(depths.open(float(d)));
    for (int d : {-6, -5, -4, -3, -2, -1, 0, 1, 2}) CHECK(depths.open(float(d)));
    CHECK_FALSE(depths.full(-8));
    CHECK_FALSE(depths.full(-300));  // beyond what was seen: as the deepest seen
    CHECK_FALSE(depths.full(5));
}

TEST_CASE("DepthClasses: every depth within the radius of a mixed one or of another phase is open",
          "[analogy][property]") {
    using Kind = DepthClasses::Kind;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const int radius = int(seed % 4);
        DepthClasses depths(radius);
        std::map<int, Kind> kinds;
        for (int d = -12; d <= 12; ++d) {
            Random random(seed, std::uint64_t(d + 100));
            const bool full = d < 0, odd = random.below(5) == 0;
            depths.add(float(d) + 0.3f, full ? -1.f : 1.f);
            kinds[d] = full ? Kind::Full : Kind::Empty;
            if (!odd) continue;
            depths.add(float(d), 0.5f);
            kinds[d] = Kind::Mixed;
        }
        depths.finish();
        const auto kindAt = [&](int d) { return kinds[std::clamp(d, -12, 12)]; };
        for (int d = -40; d <= 40; ++d) {
            bool open = false;
            for (int k = -radius; k <= radius; ++k)
                open = open || kindAt(d + k) == Kind::Mixed || kindAt(d + k) != kindAt(d);
            REQUIRE(depths.open(float(d)) == open);
            REQUIRE(depths.full(float(d)) == (kindAt(d) == Kind::Full));
        }
    }
}

TEST_CASE("DepthClasses: runs cover all depths, mixed ones as the plain model", "[analogy][oracle]") {
    DepthClasses depths(1);
    // Empty inside, a shell, mixed on both sides of the plain surface, empty outside.
    for (int d = -9; d <= 9; ++d) depths.add(float(d), d < -5 ? 2.f : d < -2 ? -2.f : d <= 2 ? 0.f : 2.f);
    depths.finish();
    const std::vector<DepthRun> runs = depths.runs();
    REQUIRE(runs.size() == 3);
    CHECK(runs[0].from <= -512);
    CHECK_FALSE(runs[0].full);
    CHECK((runs[1].from == -5 && runs[1].full));
    CHECK((runs[2].from == 0 && !runs[2].full));
    DepthClasses nothing(1);
    nothing.finish();
    const std::vector<DepthRun> plain = nothing.runs();
    REQUIRE(plain.size() == 2);
    CHECK(plain[0].full);
    CHECK((plain[1].from == 0 && !plain[1].full));
}

TEST_CASE("analogyPyramid, analogyVoxels: same bits for any threads, stopped when asked",
          "[analogy][determinism][cancel]") {
    const auto ball = test::sphereField(32, 10);
    const FrameField frames = framesAlong(ball, {0, 0, 1});
    const auto made = [&](const RunContext& ctx) {
        const AnalogyPyramid pyramid = analogyPyramid(*ball, 2, ctx);
        std::vector<float> all = test::samplesOf(pyramid.density[1]);
        const AnalogyVoxels voxels = analogyVoxels(VoxelTable::where(
                                                       *ball, [](float d) { return std::abs(d) < 4; }, ctx),
                                                   frames, 0, true, true, ctx);
        for (std::size_t i = 0; i < voxels.table.size(); ++i)
            all.insert(all.end(), {voxels.frame[i].t.x, voxels.sweep[i], voxels.curvature[i].tb});
        return all;
    };
    RunContext one, four, stopped;
    one.threads = 1;
    four.threads = 4;
    CHECK(made(one) == made(four));
    std::atomic<bool> stop{true};
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { analogyPyramid(*ball, 2, stopped); }).code == int(ErrorCode::Cancelled));
    const VoxelTable table = VoxelTable::where(*ball, [](float d) { return std::abs(d) < 4; }, {});
    CHECK(test::thrownBy([&] { analogyVoxels(table, frames, 0, true, true, stopped); }).code ==
          int(ErrorCode::Cancelled));
}
