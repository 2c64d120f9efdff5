#include "libvdbsynth/patch/sheet/border_blend.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// Two halves of a plane that miss each other by a step in height.
SheetPoints halves(double apart) {
    SheetPoints sheet;
    const test::PointShape plane = test::latticePlane(60);
    for (std::size_t p = 0; p < plane.point.size(); ++p) {
        const bool right = plane.point[p].x >= 30;
        sheet.points.push_back(plane.point[p] + Vec3f{0, 0, right ? float(apart) : 0});
        sheet.normals.push_back(plane.normal[p]);
        sheet.source.push_back(std::uint32_t(p));
        sheet.patch.push_back(right ? 1 : 0);
        sheet.blended.push_back(0);
    }
    return sheet;
}

std::vector<std::uint8_t> ringsOf(const SheetPoints& sheet) {
    std::vector<std::uint8_t> ring;
    for (const Vec3f& p : sheet.points) ring.push_back(std::uint8_t(std::abs(p.x - 29.5f) / 2));
    return ring;
}

const BlendOptions kBlend{2, 1, 2, false};

}  // namespace

TEST_CASE("blendNearBorders: moves what is within two rings, to between both sides") {
    SheetPoints sheet = halves(0.6);
    const SheetPoints before = sheet;
    blendNearBorders(ringsOf(sheet), kBlend, sheet);
    REQUIRE(sheet.size() == before.size());
    const auto ring = ringsOf(before);
    for (std::size_t p = 0; p < sheet.size(); ++p) {
        const bool moves = ring[p] < 2;
        REQUIRE(sheet.blended[p] == (moves ? 1 : 0));
        if (!moves) REQUIRE(length(sheet.points[p] - before.points[p]) == 0);
        REQUIRE((sheet.points[p].z > -0.05f && sheet.points[p].z < 0.65f));
    }
    // Across the border the jump is a fraction of what it was.
    float jump = 0;
    for (std::size_t p = 0; p + 1 < sheet.size(); ++p)
        if (before.points[p].x == 29 && before.points[p + 1].x == 30 && before.points[p].y > 10 &&
            before.points[p].y < 50)
            jump = std::max(jump, std::abs(sheet.points[p].z - sheet.points[p + 1].z));
    CHECK(jump < 0.25f);
    CHECK(blendSupport(kBlend) == 2 + 4 + 1);
}

TEST_CASE("blendNearBorders: sides that agree stay, and nothing near a border changes nothing") {
    SheetPoints sheet = halves(0);
    blendNearBorders(ringsOf(sheet), kBlend, sheet);
    for (const Vec3f& p : sheet.points) REQUIRE(std::abs(p.z) < 1e-4f);
    SheetPoints far = halves(0.6);
    const SheetPoints before = far;
    blendNearBorders(std::vector<std::uint8_t>(far.size(), 100), kBlend, far);
    for (std::size_t p = 0; p < far.size(); ++p) REQUIRE(length(far.points[p] - before.points[p]) == 0);
}

TEST_CASE("blendNearBorders: doubled points are thinned, on any number of threads, unless cancelled") {
    BlendOptions even = kBlend;
    even.even = true;
    const auto run = [&](const RunContext& ctx) {
        SheetPoints sheet = halves(0.2), twice = sheet;
        for (std::size_t p = 0; p < sheet.size(); ++p) {
            if (std::abs(sheet.points[p].x - 29.5f) > 3) continue;
            twice.points.push_back(sheet.points[p] + Vec3f{0.1f, 0, 0.05f});
            twice.normals.push_back(sheet.normals[p]);
            twice.source.push_back(sheet.source[p]);
            twice.patch.push_back(1 - sheet.patch[p]);
            twice.blended.push_back(0);
        }
        blendNearBorders(ringsOf(twice), even, twice, ctx);
        return twice;
    };
    const SheetPoints one = run(test::onThreads(1)), four = run(test::onThreads(4));
    CHECK(one.size() < 3700);
    CHECK(one.size() > 3500);
    REQUIRE(one.size() == four.size());
    for (std::size_t p = 0; p < one.size(); ++p) REQUIRE(length(one.points[p] - four.points[p]) == 0);
    CHECK(test::thrownWhenCancelled(run).code == int(ErrorCode::Cancelled));
}
