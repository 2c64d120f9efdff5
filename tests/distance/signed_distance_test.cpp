#include "libvdbsynth/distance/signed_distance.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

constexpr Index3 kSize{10, 11, 24};

// A plane at z = 11.5, times a slope; solid below it.
float planeAt(int z, float slope) {
    return std::clamp((float(z) - 11.5f) * slope, -9.f, 9.f);
}
BrickField plane(float slope) {
    return test::fieldFrom(kSize, [=](const Index3& p) { return planeAt(p.z, slope); });
}

// Unsigned distances to a mesh that lies `off` farther from everything.
BrickField toMesh(float off) {
    return test::fieldFrom(kSize, [=](const Index3& p) { return std::abs(planeAt(p.z, 1)) + off; });
}

// By how much a distance that the mesh has `off` too large is moved back.
double kept(double off) {
    return off <= 0.2 ? off : off < 0.4 ? 0.4 - off : 0.0;
}

}  // namespace

TEST_CASE("withSigns: lengths of one field and signs of another, each at its offset", "[distance][oracle]") {
    const BrickField distance =
        test::fieldFrom({20, 20, 20}, [](const Index3& p) { return float(p.x + 2 * p.y + 3 * p.z); });
    const BrickField sign = test::noiseField({20, 20, 20}, 8);
    const Index3 a{1, 2, 3}, b{5, 0, 4}, size{9, 12, 8};
    const BrickField result = withSigns({distance, a}, {sign, b}, size);
    CHECK(result.box() == IndexBox::fromSize(size));
    forEachVoxel(result.box(), [&](const Index3& p) {
        REQUIRE(std::abs(result.at(p)) == distance.at(p + a));
        REQUIRE((result.at(p) < 0) == (sign.at(p + b) < 0));
    });
}

TEST_CASE("keepingDistances: own distances stay by the mesh's and give way beyond 0.2 voxels",
          "[distance][oracle]") {
    for (const float off : {0.f, 0.1f, 0.19f, 0.25f, 0.3f, 0.35f, 0.41f, 0.6f, 1.f})
        for (const float sign : {-1.f, 1.f}) {
            const BrickField mesh = toMesh(sign * off);
            const BrickField result = keepingDistances({mesh, {0, 0, 0}}, {plane(1), {0, 0, 0}}, kSize, 8.f);
            for (int z = 7; z <= 16; ++z) {
                if (std::abs(z - 11.5) < 1) continue;  // where the mesh's own distance would be negative
                const double side = z < 11.5 ? -1 : 1;
                const double expected =
                    side * (std::abs(z - 11.5) + double(sign) * (double(off) - kept(double(off))));
                CAPTURE(off, sign, z);
                CHECK(double(result.at({4, 5, z})) == Approx(expected).margin(1e-5));
            }
        }
}

TEST_CASE("keepingDistances: what is no distance, or beyond the band, is the mesh's", "[distance][oracle]") {
    for (const float slope : {0.5f, 1.5f}) {
        // Within 0.2 of the mesh's beside the surface, but with a gradient that is not 1 long.
        const BrickField result =
            keepingDistances({toMesh(0), {0, 0, 0}}, {plane(slope), {0, 0, 0}}, kSize, 8.f);
        for (int z = 5; z <= 18; ++z) CHECK(result.at({4, 5, z}) == planeAt(z, 1));
    }
    const BrickField narrow = keepingDistances({toMesh(0.1f), {0, 0, 0}}, {plane(1), {0, 0, 0}}, kSize, 4.f);
    CHECK(narrow.at({4, 5, 13}) == 1.5f);
    CHECK(narrow.at({4, 5, 16}) == 4.6f);  // own distances end at 4
    CHECK(narrow.at({4, 5, 7}) == -4.6f);
}

TEST_CASE("keepingDistances: reads both fields at their offsets, and keeps signs", "[distance][property]") {
    const BrickField own = test::ballsField({30, 30, 30}, 5, 6.f);
    const BrickField mesh =
        test::fieldFrom({30, 30, 30}, [&](const Index3& p) { return std::abs(own.at(p)) + 0.05f; });
    BrickField moved = mesh;
    moved.translate({-7, 4, 2});
    const Index3 offset{3, 1, 2}, size{20, 21, 19};
    const BrickField result = keepingDistances({moved, offset + Index3{-7, 4, 2}}, {own, offset}, size, 5.f);
    CHECK(result.box() == IndexBox::fromSize(size));
    std::size_t stayed = 0, all = 0;
    forEachVoxel(result.box(), [&](const Index3& p) {
        const float value = own.at(p + offset);
        REQUIRE((result.at(p) < 0) == (value < 0));
        REQUIRE(std::abs(result.at(p) - value) <= 0.051f);
        if (std::abs(value) >= 3) return;
        stayed += std::abs(result.at(p) - value) < 1e-5f ? 1 : 0;
        ++all;
    });
    CHECK(all > 500);
    CHECK(double(stayed) > 0.8 * double(all));  // not at the kinks between balls
}

TEST_CASE("withSigns, keepingDistances: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const BrickField own = test::ballsField({60, 50, 40}, 5, 6.f);
    const BrickField mesh =
        test::fieldFrom({60, 50, 40}, [&](const Index3& p) { return std::abs(own.at(p)); });
    const auto signs = [&](const RunContext& ctx) {
        return withSigns({mesh, {0, 0, 0}}, {own, {0, 0, 0}}, {60, 50, 40}, ctx);
    };
    const auto keeping = [&](const RunContext& ctx) {
        return keepingDistances({mesh, {0, 0, 0}}, {own, {0, 0, 0}}, {60, 50, 40}, 5.f, ctx);
    };
    CHECK(test::samplesOf(signs(test::onThreads(1))) == test::samplesOf(signs(test::onThreads(4))));
    CHECK(test::samplesOf(keeping(test::onThreads(1))) == test::samplesOf(keeping(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(signs).code == int(ErrorCode::Cancelled));
    CHECK(test::thrownWhenCancelled(keeping).code == int(ErrorCode::Cancelled));
}
