#include "libvdbsynth/distance/winding_field.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

double ballDistance(const Index3& p) {
    return length(Vec3d{p.x + 3.0, p.y - 8.0, p.z - 1.0}) - 30;
}

void fillCube(const Index3& corner, float* values, const std::function<double(const Index3&)>& value) {
    forEachVoxel(IndexBox::cube(corner, 8), [&](const Index3& p) { *values++ = float(value(p)); });
}

// A closed ball of radius 30: its surface is in a cube whose middle is near enough.
WindingFieldSource ballSource() {
    WindingFieldSource source;
    source.hasSurface = [](const Index3& corner, int side) {
        const Index3 middle = corner + Index3{side / 2, side / 2, side / 2};
        return std::abs(ballDistance(middle)) < 0.87 * side + 4;
    };
    source.winding = [](const Index3& p) { return ballDistance(p) < 0 ? 1.0 : 0.0; };
    source.fill = [](const Index3& corner, float* values) { fillCube(corner, values, ballDistance); };
    return source;
}

// No surface at all: a winding number that falls with x, as across a wide opening.
double slope(const Index3& p) {
    return std::clamp(0.5 - (p.x - 30) / 100.0, 0.0, 1.0);
}

}  // namespace

TEST_CASE("openingDistance: nothing at one half, growing to either side, at most the limit",
          "[distance][property]") {
    CHECK(openingDistance(0.5, 3.f) < 0.01f);
    CHECK(openingDistance(0.5, 3.f) >= 0.f);
    CHECK(openingDistance(0, 3.f) == 3.f);
    CHECK(openingDistance(1, 3.f) == 3.f);
    float before = 0;
    for (double off = 0.01; off < 0.8; off += 0.01) {
        const float above = openingDistance(0.5 + off, 3.f);
        CHECK(above >= before);
        CHECK(above <= 3.f);
        CHECK(openingDistance(0.5 - off, 3.f) == Approx(above));
        before = above;
    }
}

TEST_CASE("windingField: of a ball, filled beside its surface and a sign elsewhere", "[distance][oracle]") {
    const IndexBox box{{-40, -30, -35}, {35, 45, 40}};
    const BrickField field = windingField(box, 4.f, ballSource());
    CHECK(field.box() == IndexBox{{-64, -64, -64}, {63, 63, 63}});
    std::size_t near = 0, wrong = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        const float d = float(ballDistance(p)), value = field.at(p);
        near += std::abs(d) < 4 ? 1 : 0;
        wrong += value == d || (std::abs(d) >= 4 && value == (d < 0 ? -4.f : 4.f)) ? 0 : 1;
    });
    CHECK(near > 80000);
    CHECK(wrong == 0);
    CHECK(field.storedBricks() < field.brickCount() / 3);
}

TEST_CASE("windingField: where the winding number comes near one half without a surface it is filled",
          "[distance][oracle]") {
    std::atomic<int> fills{0};
    WindingFieldSource source;
    source.hasSurface = [](const Index3&, int) { return false; };
    source.winding = slope;
    source.fill = [&](const Index3& corner, float* values) {
        ++fills;
        fillCube(corner, values, [](const Index3& p) { return 100 + p.x; });
    };
    const BrickField field = windingField({{-64, 0, 0}, {127, 63, 63}}, 3.f, source);
    std::size_t wrong = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        const double off = slope(p) - 0.5;
        if (std::abs(off) < kWindingMargin / 2) wrong += field.at(p) == float(100 + p.x) ? 0 : 1;
        if (std::abs(off) > kWindingMargin) wrong += field.at(p) == (off > 0 ? -3.f : 3.f) ? 0 : 1;
    });
    CHECK(wrong == 0);
    CHECK(fills >= 3 * 8 * 8);
    CHECK(fills < 6 * 8 * 8);  // of 24 cubes along x
}

TEST_CASE("windingField: without a surface one sign and hardly a winding number, in a box of one voxel",
          "[distance][degenerate]") {
    for (const double winding : {0.0, 1.0}) {
        std::atomic<int> asked{0}, fills{0};
        WindingFieldSource source;
        source.hasSurface = [](const Index3&, int) { return false; };
        source.winding = [&](const Index3&) {
            ++asked;
            return winding;
        };
        source.fill = [&](const Index3&, float*) { ++fills; };
        const BrickField field = windingField({{70, -1, 3}, {70, -1, 3}}, 3.f, source);
        CHECK(field.box() == IndexBox{{64, -64, 0}, {127, -1, 63}});
        CHECK(field.storedBricks() == 0);
        CHECK(field.at({70, -1, 3}) == (winding > 0.5 ? -3.f : 3.f));
        CHECK(asked < 20);
        CHECK(fills == 0);
    }
}

TEST_CASE("windingField: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const auto made = [](const RunContext& ctx) {
        return windingField({{-40, -30, -35}, {35, 45, 40}}, 4.f, ballSource(), ctx);
    };
    CHECK(test::samplesOf(made(test::onThreads(1))) == test::samplesOf(made(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
}
