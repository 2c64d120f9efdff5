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
