#include "libvdbsynth/measure/local_patches.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/makers.h"

#include <atomic>
#include <bitset>

using namespace vdbsynth;

namespace {

Occupancy ballsIn(const Index3& size, std::uint64_t seed, int balls) {
    return Occupancy::fromField(test::ballsField(size, seed, 3.f, balls));
}

using Bits = std::bitset<11 * 11 * 11>;

// Every fifth patch of 11^3 whose middle 3^3 has both phases, voxel by voxel.
std::vector<Bits> patchesOf(const PatchBits& from) {
    const int pad = from.beyond == Beyond::Void ? 5 : 0;
    const IndexBox box = IndexBox::fromSize(from.solid.size());
    std::vector<Bits> patches;
    forEachVoxel(
        {box.min - Index3{pad, pad, pad}, box.max + Index3{pad - 10, pad - 10, pad - 10}},
        [&](const Index3& corner) {
            Bits patch;
            int middle = 0;
            forEachVoxel(IndexBox::cube({0, 0, 0}, 11), [&](const Index3& p) {
                const Index3 v = corner + p;
                const bool solid = box.contains(v) && from.solid.at(v.x, v.y, v.z);
                patch[latticeIndex(p, {11, 11, 11})] = solid;
                middle += solid && IndexBox::cube({4, 4, 4}, 3).contains(p);
            });
            if (middle > 0 && middle < 27) patches.push_back(patch);
        },
        5);
    return patches;
}

// The definition in measures.h, for up to a thousand patches.
LocalPatches counted(const PatchBits& reference, const PatchBits& other) {
    const std::vector<Bits> among = patchesOf(reference), queries = patchesOf(other);
    REQUIRE((queries.size() > 20 && queries.size() <= 1000));
    LocalPatches all;
    for (const Bits& query : queries) {
        double overlap = 0, score = 0;
        for (const Bits& patch : among) {
            const double both = double((query & patch).count());
            overlap = std::max(overlap, both / double((query | patch).count()));
            score = std::max(score, 2 * both / double(query.count() + patch.count()));
        }
        all.shareIoU += (overlap > 0.95) / double(queries.size());
        all.shareScore += (score > 0.95) / double(queries.size());
        all.meanIoU += overlap / double(queries.size());
    }
    return all;
}

void checkSame(const LocalPatches& a, const LocalPatches& b) {
    CHECK(a.shareIoU == Approx(b.shareIoU).margin(1e-9));
    CHECK(a.shareScore == Approx(b.shareScore).margin(1e-9));
    CHECK(a.meanIoU == Approx(b.meanIoU).margin(1e-9));
}

}  // namespace

TEST_CASE("localPatchSimilarity: as counted voxel by voxel, for textures and for objects",
          "[measure][oracle]") {
    const Occupancy a = ballsIn({48, 50, 51}, 3, 40), b = ballsIn({46, 50, 49}, 4, 40);
    for (Beyond beyond : {Beyond::Unknown, Beyond::Void}) {
        INFO(int(beyond));
        const LocalPatches expected = counted({a, beyond}, {b, beyond});
        CHECK(expected.meanIoU < 0.99);
        checkSame(localPatchSimilarity({a, beyond}, {b, beyond}), expected);
    }
    // Balls of one place in two boxes: most patches of the part match exactly, the others do not.
    const PatchBits whole{a, Beyond::Unknown}, part{a.window({{0, 0, 0}, {47, 49, 40}}), Beyond::Unknown};
    const LocalPatches most = localPatchSimilarity(part, whole);
    checkSame(most, counted(part, whole));
    CHECK(most.shareIoU > 0.5);
    CHECK(most.shareIoU < 1);
}

TEST_CASE("localPatchSimilarity: 1 for a copy, and by hand for slabs of 5 and 6 layers",
          "[measure][oracle]") {
    const Occupancy balls = ballsIn({40, 40, 40}, 3, 12);
    const LocalPatches same = localPatchSimilarity({balls}, {balls});
    CHECK(same.shareIoU == 1);
    CHECK(same.shareScore == 1);
    CHECK(same.meanIoU == 1);
    const auto slab = [](int top) {
        return PatchBits{Occupancy::fromField(test::fieldFrom(
                             {11, 11, 11}, [top](const Index3& p) { return p.z < top ? -1.f : 1.f; })),
                         Beyond::Unknown};
    };
    const LocalPatches five = localPatchSimilarity(slab(6), slab(5));
    CHECK(five.meanIoU == Approx(5.0 / 6));
    CHECK(five.shareIoU == 0);
    CHECK(five.shareScore == 0);
}

TEST_CASE("localPatchSimilarity: an F-score over 0.95 needs less overlap", "[measure][oracle]") {
    // 11^2 columns of 6, half a layer less: overlap (726 - 60) / 726 = 0.917, F-score 0.957.
    const auto slab = [](int missing) {
        return PatchBits{Occupancy::fromField(test::fieldFrom({11, 11, 11},
                                                              [missing](const Index3& p) {
                                                                  const int top =
                                                                      p.x * 11 + p.y < missing ? 5 : 6;
                                                                  return p.z < top ? -1.f : 1.f;
                                                              })),
                         Beyond::Unknown};
    };
    const LocalPatches close = localPatchSimilarity(slab(0), slab(60));
    CHECK(close.meanIoU == Approx(666.0 / 726));
    CHECK(close.shareIoU == 0);
    CHECK(close.shareScore == 1);
}

TEST_CASE("localPatchSimilarity: over a thousand patches a sample by the seed, same bits for any threads",
          "[measure][determinism][cancel]") {
    // Noise, so that each of the 216 and 1728 patches counts.
    const auto noise = [](int side) {
        return PatchBits{Occupancy::fromField(test::noiseField({side, side, side}, std::uint64_t(side))),
                         Beyond::Unknown};
    };
    const PatchBits a = noise(36), b = noise(66);
    RunContext one, four, other, stopped;
    one.threads = 1;
    four.threads = 4;
    other.seed = 5;
    const LocalPatches first = localPatchSimilarity(a, b, one), again = localPatchSimilarity(a, b, four);
    CHECK(first.meanIoU == again.meanIoU);
    CHECK(first.shareScore == again.shareScore);
    const LocalPatches drawn = localPatchSimilarity(a, b, other);
    CHECK(drawn.meanIoU != first.meanIoU);
    CHECK(drawn.meanIoU == Approx(first.meanIoU).margin(0.02));
    std::atomic<bool> cancel{true};
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { localPatchSimilarity(a, b, stopped); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("localPatchSimilarity: 0 without patches on either side", "[measure][degenerate]") {
    const Occupancy none({20, 20, 20}), small = ballsIn({10, 10, 10}, 3, 3),
                                        balls = ballsIn({40, 40, 40}, 3, 12);
    CHECK(localPatchSimilarity({none}, {balls}).meanIoU == 0);
    CHECK(localPatchSimilarity({balls}, {none}).meanIoU == 0);
    CHECK(localPatchSimilarity({balls}, {small, Beyond::Unknown}).shareScore == 0);
    // An object's box is padded, so that one voxel is enough for a patch.
    Occupancy voxel({1, 1, 1});
    voxel.set(0, 0, 0);
    CHECK(localPatchSimilarity({voxel, Beyond::Void}, {voxel, Beyond::Void}).meanIoU == 1);
}
