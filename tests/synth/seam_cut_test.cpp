#include "libvdbsynth/synth/seam_cut.h"

#include <catch2/catch.hpp>

#include <atomic>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/synth/seam_cells.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// A level, and a map of patches of its one exemplar.
struct Scene {
    BlockSynthesisOptions options;
    SynthesisPass pass;
    PatchMap map;
    PatchLevel level;

    Scene(BrickField exemplar, const Index3& target, int block, double longestRun = 1) {
        options.size = target;
        options.longestRun = longestRun;
        pass = {{std::make_shared<const BrickField>(std::move(exemplar))}, target, block, 1};
        map.target = target;
        map.block = block;
        map.stride = block / 4;
        map.allocate();
    }
    void prepare() { level = patchLevel(pass, options, map, {}, nullptr, {}); }
};

Index3 shiftAt(const PatchMap& cut, std::size_t i) {
    return cut.source[i] - cut.originOf(cut.place(i));
}

// 32 voxels of one thing and behind them 32 of another, which are alike for four from `alike` on.
Scene twoHalves(int alike) {
    Scene scene(test::fieldFrom({64, 16, 16},
                                [alike](const Index3& p) {
                                    const int x = p.x % 32;
                                    if (x >= alike && x < alike + 4) return 0.f;
                                    return p.x < 32 ? -1.f : 1.f;
                                }),
                {32, 16, 16}, 16);
    for (std::size_t i = 0; i < scene.map.source.size(); ++i)
        scene.map.source[i] = {scene.map.originOf(scene.map.place(i)).x + (i < 3 ? 0 : 32), 0, 0};
    scene.prepare();
    return scene;
}

// Sources drawn by patch, as bad as any.
Scene drawn(double longestRun = 1) {
    Scene scene(test::ballsField({40, 40, 40}, 4, 3.f, 40), {48, 44, 40}, 12, longestRun);
    for (std::size_t i = 0; i < scene.map.source.size(); ++i) {
        Random random(9, i / 3);
        scene.map.source[i] = {int(random.below(29)), int(random.below(29)),
                               scene.map.originOf(scene.map.place(i)).z};
    }
    scene.prepare();
    return scene;
}

// What cutSeams makes little, of cells that copy by given shifts.
std::int64_t energy(const Scene& scene, const BrickField& field, const std::vector<Index3>& shifts) {
    const SeamCells cells(scene.map);
    const NearField exemplar(*scene.pass.exemplars.front()), target(field);
    const auto apart = [&](const Index3& cell, const Index3& a, const Index3& b) {
        const Index3 corner = cells.cornerOf(cell);
        if (!exemplar.holds(corner + a) || !exemplar.holds(corner + b)) return a == b ? 0 : 2 * 96 * 8;
        return cellDifference(exemplar, corner + a, exemplar, corner + b);
    };
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < shifts.size(); ++i) {
        const Index3 cell = cells.blocks().place(i), corner = cells.cornerOf(cell);
        sum += cellDifference(target, corner, exemplar, corner + shifts[i]);
        for (int axis = 0; axis < 3; ++axis) {
            Index3 other = cell;
            if (++other[axis] >= cells.count()[axis]) continue;
            const Index3 theirs = shifts[cells.number(other)];
            sum += (axis == 2 ? 16 : 1) * (apart(cell, shifts[i], theirs) + apart(other, shifts[i], theirs));
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("cutSeams: a seam runs where both sides are alike", "[synth]") {
    for (const int alike : {14, 18}) {
        const Scene scene = twoHalves(alike);
        const BrickField none = test::fieldFrom({32, 16, 16}, [](const Index3&) { return 0.f; });
        const PatchMap cut = cutSeams(scene.level, scene.map, none);
        CHECK(cut.stride == 2);
        CHECK(cut.block == 6);
        const SeamCells cells(scene.map);
        for (std::size_t i = 0; i < cut.source.size(); ++i)
            REQUIRE(shiftAt(cut, i) == Index3{cells.cornerOf(cut.place(i)).x < alike + 2 ? 0 : 32, 0, 0});
    }
}

TEST_CASE("cutSeams: costs less than the strongest patches, and copies only what patches cover",
          "[synth][property]") {
    const Scene scene = drawn();
    const BrickField field = voteThroughMap(scene.map, scene.pass.exemplars);
    const PatchMap cut = cutSeams(scene.level, scene.map, field);
    const SeamCells cells(scene.map);
    std::vector<Index3> before, after;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < cut.source.size(); ++i) {
        const std::size_t strongest = cells.strongestPatch(scene.map, cut.place(i));
        before.push_back(scene.map.source[strongest] - scene.map.originOf(scene.map.place(strongest)));
        after.push_back(shiftAt(cut, i));
        changed += before.back() != after.back();
        bool covered = false;
        for (std::size_t p = 0; p < scene.map.source.size() && !covered; ++p)
            covered = scene.map.source[p] - scene.map.originOf(scene.map.place(p)) == after.back() &&
                      cells.inside(scene.map.place(p)).contains(cut.place(i));
        REQUIRE(covered);
    }
    CHECK(changed > cut.source.size() / 50);
    CHECK(double(energy(scene, field, after)) < 0.9 * double(energy(scene, field, before)));
}

TEST_CASE("cutSeams: a piece takes no more than its share", "[synth][property]") {
    // All but every fourth patch copies by one shift; what the others copy fits as well, since slabs go on.
    Scene scene(
        test::fieldFrom({48, 48, 48}, [](const Index3& p) { return std::abs(float(p.x % 16) - 8.f) - 4.f; }),
        {40, 40, 40}, 8, 0.2);
    for (std::size_t i = 0; i < scene.map.source.size(); ++i) {
        const Index3 origin = scene.map.originOf(scene.map.place(i));
        scene.map.source[i] = origin + (i % 4 == 0 ? Index3{0, 1 + int(i / 4) % 8, 2} : Index3{0, 0, 0});
    }
    scene.prepare();
    const BrickField field = voteThroughMap(scene.map, scene.pass.exemplars);
    const auto share = [&](double longestRun) {
        scene.options.longestRun = longestRun;
        const PatchMap cut = cutSeams(scene.level, scene.map, field);
        std::size_t count = 0;
        for (std::size_t i = 0; i < cut.source.size(); ++i) count += shiftAt(cut, i) == Index3{0, 0, 0};
        return double(count) / double(cut.source.size());
    };
    CHECK(share(1) > 0.5);
    // A tenth of the exemplar is a quarter of the target; what no other patch covers stays.
    CHECK(share(0.1) < 0.35);
}

TEST_CASE("cutSeams: same bits for any number of threads, and cancelled", "[synth][threads][cancel]") {
    const Scene scene = drawn(0.3);
    const BrickField field = voteThroughMap(scene.map, scene.pass.exemplars);
    RunContext one, many;
    one.threads = 1;
    many.threads = 4;
    CHECK(cutSeams(scene.level, scene.map, field, one).source ==
          cutSeams(scene.level, scene.map, field, many).source);
    std::atomic<bool> cancel{true};
    RunContext cancelled;
    cancelled.cancel = &cancel;
    try {
        cutSeams(scene.level, scene.map, field, cancelled);
        FAIL("not cancelled");
    } catch (const Error& error) {
        CHECK(error.code() == ErrorCode::Cancelled);
    }
}

TEST_CASE("cutSeams: one patch, and nothing with a surface", "[synth][degenerate]") {
    for (const bool empty : {false, true}) {
        Scene scene(empty ? BrickField(IndexBox::fromSize({9, 9, 9}), 3.f) : test::noiseField({9, 9, 9}, 2),
                    {4, 4, 4}, 4);
        scene.map.source = {{3, 2, 1}};
        scene.prepare();
        const BrickField field = voteThroughMap(scene.map, scene.pass.exemplars);
        const PatchMap cut = cutSeams(scene.level, scene.map, field);
        for (std::size_t i = 0; i < cut.source.size(); ++i) REQUIRE(shiftAt(cut, i) == Index3{3, 2, 1});
        CHECK(test::samplesOf(voteThroughMap(cut, scene.pass.exemplars)) == test::samplesOf(field));
    }
}
