#include "libvdbsynth/distance/crossing_field.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

BoxFill fillFrom(const std::function<float(const Index3&)>& value) {
    return [value](const Index3& corner, const Index3& size, float* out) {
        forEachVoxel({corner, corner + size - Index3{1, 1, 1}}, [&](const Index3& p) { *out++ = value(p); });
    };
}

// A ball of radius 13 about the origin, of values that are no distances.
float ball(const Index3& p) {
    return float(p.x * p.x + p.y * p.y + p.z * p.z) / 26 - 6.5f;
}

}  // namespace

TEST_CASE("crossingField: between two samples of different sign both hold their values",
          "[distance][oracle]") {
    const IndexBox box{{-27, -30, -25}, {29, 26, 31}};
    const BrickField field = crossingField(box, 4.f, {}, fillFrom(ball));
    CHECK(field.box() == box);
    std::size_t crossings = 0, wrong = 0;
    forEachVoxel(box, [&](const Index3& p) {
        const float value = field.at(p), given = ball(p);
        const bool crosses =
            std::any_of(kAllNeighbours.begin(), kAllNeighbours.end(), [&](const Index3& step) {
                return box.contains(p + step) && (ball(p + step) < 0) != (given < 0);
            });
        crossings += crosses ? 1 : 0;
        wrong += value == given || (!crosses && value == (given < 0 ? -4.f : 4.f)) ? 0 : 1;
    });
    CHECK(wrong == 0);
    CHECK(crossings > 3000);
}

TEST_CASE("crossingField: bricks without a change of sign cost nothing", "[distance][property]") {
    const IndexBox box{{-27, -30, -25}, {29, 26, 31}};
    const BrickField field = crossingField(box, 4.f, {}, fillFrom(ball));
    CHECK(field.storedBricks() > 0);
    CHECK(field.storedBricks() < field.brickCount() / 2);
    for (const float value : {-1.f, 0.f, 7.f}) {
        const BrickField constant =
            crossingField(box, 4.f, {}, fillFrom([=](const Index3&) { return value; }));
        CHECK(constant.storedBricks() == 0);
        CHECK(constant.at(box.min) == (value < 0 ? -4.f : 4.f));
        CHECK(constant.at(box.max) == (value < 0 ? -4.f : 4.f));
    }
}

TEST_CASE("crossingField: a level between two bricks is held by both, one within by one",
          "[distance][oracle]") {
    const IndexBox box = IndexBox::fromSize({32, 8, 8});
    const auto slab = [&](float level) {
        return crossingField(box, 3.f, {}, fillFrom([=](const Index3& p) { return float(p.x) - level; }));
    };
    const BrickField between = slab(15.25f);
    const float row[8] = {-3, -7.25f, -0.25f, 0.75f, 8 - 0.25f, 3, 3, 3};
    const int at[8] = {7, 8, 15, 16, 23, 24, 30, 31};
    for (int i = 0; i < 8; ++i) CHECK(between.at({at[i], 3, 4}) == row[i]);
    CHECK(between.storedBricks() == 2);
    CHECK(slab(19.5f).storedBricks() == 1);
}

TEST_CASE("crossingField: one voxel of solid in a box of one voxel", "[distance][degenerate]") {
    const BrickField field = crossingField({{5, 5, 5}, {5, 5, 5}}, 3.f, {},
                                           fillFrom([](const Index3& p) { return p.x == 5 ? -0.5f : 2.f; }));
    CHECK(field.at({5, 5, 5}) == -0.5f);
    CHECK(test::thrownBy([] { crossingField(IndexBox{}, 3.f, {}, fillFrom(ball)); }).code ==
          int(ErrorCode::InvalidOption));
}

TEST_CASE("crossingField: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const auto made = [](const RunContext& ctx) {
        return crossingField({{-40, -40, -40}, {40, 40, 40}}, 4.f, ctx, fillFrom(ball));
    };
    CHECK(test::samplesOf(made(test::onThreads(1))) == test::samplesOf(made(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
}
