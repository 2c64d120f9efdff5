#include "libvdbsynth/distance/close_field.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

// Signed distance to a domain's faces, half a voxel outside its voxels; of its cut faces only within it.
double capDistance(const Index3& p, const IndexBox& domain, const CutFaces& cut) {
    double most = -1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = domain.min[axis] - 0.5 - p[axis], high = p[axis] - domain.max[axis] - 0.5;
        if (cut[std::size_t(2 * axis)] || low > 0) most = std::max(most, low);
        if (cut[std::size_t(2 * axis + 1)] || high > 0) most = std::max(most, high);
    }
    return most;
}

}  // namespace

TEST_CASE("closeField: a block of solid ends half a voxel outside its faces", "[distance][oracle]") {
    const IndexBox domain{{-2, 3, 5}, {7, 9, 20}};
    const BrickField closed = closeField(BrickField(domain, -9.f), domain, kAllCut, 3.f);
    CHECK(closed.box() == domain.expanded(3));
    CHECK(closed.at({-2, 6, 12}) == -0.5f);
    CHECK(closed.at({-3, 6, 12}) == 0.5f);
    CHECK(closed.at({3, 6, 23}) == 2.5f);
    CHECK(closed.at({3, 6, 12}) == -3.f);  // y is 3.5 voxels from both faces
    forEachVoxel(closed.box(), [&](const Index3& p) {
        const double expected = std::clamp(capDistance(p, domain, kAllCut), -3.0, 3.0);
        REQUIRE(double(closed.at(p)) == expected);
    });
}

TEST_CASE("closeField: a field is changed by caps only, and continues beyond its box", "[distance][oracle]") {
    const BrickField field = test::noiseField({11, 9, 10}, 4);
    const IndexBox domain{{-4, 0, 1}, {12, 8, 7}};  // wider, as wide and narrower than the field
    const CutFaces cuts[] = {{}, {true, false, false, true, false, true}, kAllCut};
    for (const CutFaces& cut : cuts) {
        const BrickField closed = closeField(field, domain, cut, 2.f);
        forEachVoxel(closed.box(), [&](const Index3& p) {
            const double expected = std::max(double(field.at(p)), capDistance(p, domain, cut));
            REQUIRE(double(closed.at(p)) == std::min(expected, 2.0));
        });
    }
}

TEST_CASE("closeField: the unit scales, the limit clamps, and closing twice is closing once",
          "[distance][property]") {
    const BrickField field = test::ballsField({20, 17, 18}, 3, 8.f);
    const BrickField voxels = closeField(field, field.box(), kAllCut, 4.f);
    const BrickField world = closeField(field, field.box(), kAllCut, 4.f, {}, 0.3f);
    forEachVoxel(voxels.box(), [&](const Index3& p) {
        REQUIRE(std::abs(voxels.at(p)) <= 4);
        REQUIRE(world.at(p) == voxels.at(p) * 0.3f);
    });
    const BrickField again = closeField(voxels, field.box(), kAllCut, 4.f);
    CHECK(test::samplesOf(again) == test::samplesOf(voxels));
}

TEST_CASE("closeField: one voxel of solid, and no solid", "[distance][degenerate]") {
    const IndexBox one = IndexBox::fromSize({1, 1, 1});
    const BrickField closed = closeField(BrickField(one, -5.f), one, kAllCut, 3.f);
    forEachVoxel(closed.box(), [&](const Index3& p) {
        REQUIRE((closed.at(p) < 0) == (p == Index3{0, 0, 0}));
    });
    CHECK(closed.at({0, 0, 0}) == -0.5f);
    const BrickField none = closeField(BrickField(one, 5.f), one, kAllCut, 3.f);
    for (float value : test::samplesOf(none)) CHECK(value == 3.f);
}

TEST_CASE("closeField: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const BrickField field = test::ballsField({70, 60, 50}, 3, 8.f);
    const auto closed = [&](const RunContext& ctx) {
        return closeField(field, field.box(), kAllCut, 3.f, ctx);
    };
    CHECK(test::samplesOf(closed(test::onThreads(1))) == test::samplesOf(closed(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(closed).code == int(ErrorCode::Cancelled));
}
