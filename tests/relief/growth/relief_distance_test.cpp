#include "libvdbsynth/relief/growth/relief_distance.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "tests/support/makers.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

// A ball of radius 9 about (12, 13, 14), its band 3 wide.
BrickField ballBand(const Index3& corner = {0, 0, 0}) {
    const IndexBox box{corner, corner + Index3{26, 29, 31}};
    return BrickField::fromVoxels(box, {}, [&](const Index3& p) {
        const Index3 q = p - corner;
        const float x = float(q.x - 12), y = float(q.y - 13), z = float(q.z - 14);
        return std::clamp(std::sqrt(x * x + y * y + z * z) - 9, -3.f, 3.f);
    });
}

}  // namespace

TEST_CASE("ReliefDistance: the square of sampleTrilinear, at most the half-width's") {
    const BrickField band = ballBand();
    const ReliefDistance distance(band, {0, 0, 0}, 1, 3);
    for (std::uint64_t i = 0; i < 20000; ++i) {
        Random random(1, i);
        const Vec3f p{float(random.uniform(0, 26)), float(random.uniform(0, 29)),
                      float(random.uniform(0, 31))};
        const float d = sampleTrilinear(band, p);
        REQUIRE(distance.squared(p) == Approx(double(std::min(d * d, 9.f))).margin(1e-5));
    }
}

TEST_CASE("ReliefDistance: beyond the box, and no number, counts as the half-width") {
    const ReliefDistance distance(ballBand(), {0, 0, 0}, 1, 3);
    for (const Vec3f& p : {Vec3f{-0.1f, 13, 5}, Vec3f{12, 29.1f, 14}, Vec3f{12, 13, 1e30f},
                           Vec3f{-1e30f, 0, 0}, Vec3f{std::nanf(""), 13, 5}})
        CHECK(distance.squared(p) == 9);
    CHECK(distance.squared({12, 13, 5}) == Approx(0).margin(1e-6));
    // A smaller half-width than the field's clamps.
    CHECK(ReliefDistance(ballBand(), {0, 0, 0}, 1, 1).squared({12, 13, 3}) == 1);
}

TEST_CASE("ReliefDistance: any corner, origin and voxel size") {
    const ReliefDistance moved(ballBand({-40, 7, 3}), {100, 200, 300}, 0.5, 3);
    const ReliefDistance plain(ballBand(), {0, 0, 0}, 1, 3);
    const Vec3f place{5.25f, 9.5f, 12.75f};
    const Vec3f world = Vec3f{100, 200, 300} + (place + Vec3f{-40, 7, 3}) * 0.5f;
    CHECK(moved.squared(moved.toVoxels(world)) == Approx(double(plain.squared(place))));
}

TEST_CASE("ReliefDistance: every error") {
    const auto codeOf = [](const BrickField& band, double voxel, float halfWidth) {
        return test::thrownBy([&] { ReliefDistance(band, {}, voxel, halfWidth); }).code;
    };
    CHECK(codeOf({}, 1, 3) == int(ErrorCode::InvalidOption));
    CHECK(codeOf(ballBand(), 0, 3) == int(ErrorCode::InvalidOption));
    CHECK(codeOf(ballBand(), 1, 0) == int(ErrorCode::InvalidOption));
    CHECK(codeOf(ballBand(), 1, INFINITY) == int(ErrorCode::InvalidOption));
    BrickField bad = ballBand();
    const float nothing = NAN;
    bad.writeBox({3, 3, 3}, {1, 1, 1}, &nothing);
    CHECK(codeOf(bad, 1, 3) == int(ErrorCode::BadData));
}
