#include "libvdbsynth/distance/rebuild_band.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

double ballDistance(const Index3& p) {
    return length(Vec3d{p.x - 23.3, p.y - 24.1, p.z - 23.8}) - 15;
}
BrickField ball(double slope) {
    return test::fieldFrom(
        {48, 48, 48}, [=](const Index3& p) { return float(std::clamp(slope * ballDistance(p), -3.0, 3.0)); });
}

// A wavy rod of 240 voxels along x: long enough to be rebuilt in parts.
BrickField rod() {
    return test::fieldFrom({240, 24, 24}, [](const Index3& p) {
        const double along = std::max(6.0 - p.x, p.x - 232.0);
        const double across = std::hypot(p.y - 11.5, p.z - 11.5) - 7 + 2 * std::sin(p.x * 0.2);
        return float(std::clamp(std::max(along, across), -3.0, 3.0));
    });
}

FieldReader reading(const BrickField& field) {
    return [&field](const IndexBox&) { return std::make_shared<const BrickField>(field); };
}

}  // namespace

TEST_CASE("rebuiltBand: a field of any slope becomes a field of distances", "[distance][oracle]") {
    for (const double slope : {0.4, 1.0, 2.0}) {
        RebuildOptions options;
        options.halfWidth = 4;
        const BrickField given = ball(slope), band = rebuiltBand(given, options);
        REQUIRE(band.box().contains(given.box().expanded(4)));
        for (int axis = 0; axis < 3; ++axis) {
            CHECK((band.box().min[axis] & 7) == 0);
            CHECK((band.box().max[axis] & 7) == 7);
        }
        double farthest = 0, beside = 0;
        std::size_t wrong = 0;
        forEachVoxel(band.box(), [&](const Index3& p) {
            const double d = ballDistance(p), value = double(band.at(p));
            const double off = std::abs(value - std::clamp(d, -4.0, 4.0));
            wrong += (value < 0) == (d < 0) ? 0 : 1;
            farthest = std::max(farthest, off);
            if (std::abs(d) < 1) beside = std::max(beside, off);
        });
        CAPTURE(slope);
        CHECK(wrong == 0);
        CHECK(beside < 0.06);
        CHECK(farthest < 0.1);
    }
}

TEST_CASE("rebuiltBand: values may be in any unit, own distances stay if they are to",
          "[distance][property]") {
    const BrickField given = ball(1);
    const BrickField world =
        test::fieldFrom({48, 48, 48}, [&](const Index3& p) { return given.at(p) * 0.25f; });
    RebuildOptions options;
    options.keepDistances = true;
    const BrickField band = rebuiltBand(given, options);
    options.voxelSize = 0.25f;
    const BrickField scaled = rebuiltBand(world, options);
    forEachVoxel(band.box(), [&](const Index3& p) {
        REQUIRE(scaled.at(p) == Approx(band.at(p)).margin(1e-3));
        if (given.box().contains(p) && std::abs(given.at(p)) < 1)
            REQUIRE(band.at(p) == Approx(given.at(p)).margin(1e-5));
    });
}

TEST_CASE("rebuiltBand: a cavity without a way out stays a cavity", "[distance][property]") {
    const BrickField shell = test::fieldFrom({48, 48, 48}, [](const Index3& p) {
        const double d = length(Vec3d{p.x - 23.5, p.y - 23.5, p.z - 23.5});
        return std::clamp(float(std::abs(d - 14) - 5), -3.f, 3.f);
    });
    const BrickField band = rebuiltBand(shell, {});
    CHECK(band.at({23, 23, 23}) == 3.f);
    forEachVoxel(shell.box(), [&](const Index3& p) { REQUIRE((band.at(p) < 0) == (shell.at(p) < 0)); });
}

TEST_CASE("rebuildBand: parts tile all that the band touches, with the bits of the whole",
          "[distance][oracle]") {
    const BrickField field = rod();
    const BrickField whole = rebuiltBand(field, {});
    std::vector<IndexBox> boxes;
    std::int64_t voxels = 0;
    IndexBox all = field.box().expanded(4);
    for (const int narrower : {0, 60}) {  // from 60 on it fits one part
        boxes.clear();
        voxels = 0;
        all.min.x += narrower;
        rebuildBand(reading(field), all, {}, [&](const BrickField& part) {
            for (const IndexBox& other : boxes) CHECK(other.intersection(part.box()).empty());
            boxes.push_back(part.box());
            voxels += part.box().volume();
            std::size_t wrong = 0;
            forEachVoxel(part.box(), [&](const Index3& p) {
                if (whole.box().contains(p)) wrong += part.at(p) == whole.at(p) ? 0 : 1;
            });
            CHECK(wrong == 0);
            for (int axis = 0; axis < 3; ++axis) {
                CHECK((part.box().min[axis] & 7) == 0);
                CHECK((part.box().max[axis] & 7) == 7);
            }
        });
        CHECK(boxes.size() == (narrower == 0 ? 2 : 1));
        CHECK(voxels >= all.volume());
        CHECK(std::all_of(boxes.begin(), boxes.end(),
                          [&](const IndexBox& box) { return !box.intersection(all).empty(); }));
    }
}

TEST_CASE("rebuiltBand: nothing to rebuild without a surface, one voxel of solid is a ball",
          "[distance][degenerate]") {
    const IndexBox box = IndexBox::fromSize({9, 9, 9});
    for (const float value : {-2.f, 2.f}) {
        const BrickField none = rebuiltBand(BrickField(box, value), {});
        CHECK(none.storedBricks() == 0);
        CHECK(none.at({4, 4, 4}) == (value < 0 ? -3.f : 3.f));
    }
    BrickField one(box, 1.f);
    const float inside = -1.f;
    one.writeBox({4, 4, 4}, {1, 1, 1}, &inside);
    const BrickField band = rebuiltBand(one, {});
    CHECK(band.at({4, 4, 4}) < 0);
    CHECK(band.at({4, 4, 4}) > -0.6f);
    CHECK(band.at({7, 4, 4}) == Approx(2.6f).margin(0.2f));
    CHECK(band.at({4, 4, 1}) == Approx(band.at({7, 4, 4})).margin(1e-4));
}

TEST_CASE("rebuildBand: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const BrickField field = rod();
    const auto made = [&](const RunContext& ctx) { return rebuiltBand(field, {}, ctx); };
    CHECK(test::samplesOf(made(test::onThreads(1))) == test::samplesOf(made(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
}

namespace {

LatticeMap scaled(double factor) {
    Affine to = kIdentity, from = kIdentity;
    for (std::size_t i : {0, 5, 10}) {
        to[i] = factor;
        from[i] = 1 / factor;
    }
    return {to, from};
}

BrickField resampledBall(double factor, bool keep) {
    const BrickField field = ball(1);
    RebuildOptions options;
    options.voxelSize = float(factor);
    options.keepDistances = keep;
    options.band = 3 / float(factor);
    const int side = int(48 / factor);
    BrickField all;
    resampleBand(reading(field), scaled(factor), {{0, 0, 0}, {side, side, side}}, options,
                 [&](const BrickField& part) {
                     // The ball's own box is one part at these sizes.
                     if (part.box().contains(Index3{side / 2, side / 2, side / 2})) all = part;
                 });
    return all;
}

}  // namespace

TEST_CASE("resampleBand: distances on a finer and on a coarser lattice", "[distance][oracle]") {
    for (const double factor : {0.4, 1.0, 1.7, 4.0})
        for (const bool keep : {false, true}) {
            const BrickField band = resampledBall(factor, keep);
            CAPTURE(factor, keep);
            REQUIRE(!band.box().empty());
            double farthest = 0;
            std::size_t wrong = 0;
            forEachVoxel(band.box(), [&](const Index3& p) {
                const Vec3d place{p.x * factor - 23.3, p.y * factor - 24.1, p.z * factor - 23.8};
                const double d = (length(place) - 15) / factor, value = double(band.at(p));
                if (std::abs(d) > 0.1) wrong += (value < 0) == (d < 0) ? 0 : 1;
                farthest = std::max(farthest, std::abs(value - std::clamp(d, -3.0, 3.0)));
            });
            CHECK(wrong == 0);
            CHECK(farthest < 0.2);
        }
}

TEST_CASE("resampleBand: a closed void stays one", "[distance][hand]") {
    const BrickField hollow = test::fieldFrom({40, 40, 40}, [](const Index3& p) {
        const double r = length(Vec3d{p.x - 19.5, p.y - 19.5, p.z - 19.5});
        return float(std::clamp(std::max(r - 14, 6 - r), -3.0, 3.0));
    });
    for (const double factor : {0.5, 2.0, 3.0}) {
        RebuildOptions options;
        options.voxelSize = float(factor);
        double solid = 0;
        const int side = int(40 / factor);
        resampleBand(reading(hollow), scaled(factor), {{0, 0, 0}, {side, side, side}}, options,
                     [&](const BrickField& part) {
                         forEachVoxel(part.box(), [&](const Index3& p) { solid += part.at(p) < 0 ? 1 : 0; });
                     });
        CAPTURE(factor);
        CHECK(solid * factor * factor * factor == Approx(4.18879 * (14 * 14 * 14 - 6 * 6 * 6)).epsilon(0.03));
    }
}

TEST_CASE("resampleBand: grains of one voxel on a finer lattice have distances on both sides",
          "[distance][property]") {
    const BrickField grains = test::fieldFrom({24, 24, 24}, [](const Index3& p) {
        const bool grain = (p.x * 7 + p.y * 5 + p.z * 3) % 13 == 0;
        return grain ? -0.375f : 0.04f;
    });
    for (const double factor : {0.25, 0.4}) {
        RebuildOptions options;
        options.voxelSize = float(factor);
        const int side = int(24 / factor);
        double steepest = 0;
        resampleBand(reading(grains), scaled(factor), {{0, 0, 0}, {side, side, side}}, options,
                     [&](const BrickField& part) {
                         forEachVoxel(part.box(), [&](const Index3& p) {
                             for (int axis = 0; axis < 3; ++axis) {
                                 Index3 next = p;
                                 if (++next[axis] <= part.box().max[axis])
                                     steepest =
                                         std::max(steepest, std::abs(double(part.at(p) - part.at(next))));
                             }
                         });
                     });
        CAPTURE(factor);
        CHECK(steepest < 1.05);
    }
}

TEST_CASE("resampleBand: the same in parts, and it can be cancelled", "[distance][threads]") {
    const BrickField field = rod();
    const auto solidOf = [&](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        RebuildOptions options;
        options.voxelSize = 0.8f;
        std::vector<float> values;
        resampleBand(
            reading(field), scaled(0.8), {{0, 0, 0}, {300, 30, 30}}, options,
            [&](const BrickField& part) {
                forEachVoxel(part.box(), [&](const Index3& p) { values.push_back(part.at(p)); });
            },
            ctx);
        return values;
    };
    CHECK(solidOf(1) == solidOf(4));
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] {
              resampleBand(
                  reading(field), scaled(1), field.box(), {}, [](const BrickField&) {}, stopped);
          }).code == int(ErrorCode::Cancelled));
}
