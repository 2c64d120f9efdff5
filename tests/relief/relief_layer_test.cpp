#include "libvdbsynth/relief/relief_layer.h"

#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// A flat base at z = 16 under a scan.
BaseSurface flatBase(BrickField scan) {
    BaseSurface base;
    base.distance = test::fieldFrom(scan.box().size(),
                                    [](const Index3& p) { return std::clamp(float(p.z) - 16, -6.f, 6.f); });
    base.scan = std::move(scan);
    base.reach = 6;
    return base;
}

BrickField raised(double height) {
    return test::fieldFrom({16, 16, 32},
                           [=](const Index3& p) { return float(std::clamp(p.z - 16 - height, -6.0, 6.0)); });
}

const Vec3f kUp{0, 0, 1};

}  // namespace

TEST_CASE("reliefAt: a raised plane is as high as it was raised", "[relief][fast]") {
    for (const double height : {-4.25, -0.5, 0.0, 0.3, 3.75}) {
        const ReliefPoint point = reliefAt(flatBase(raised(height)), {8, 8, 16}, kUp);
        CHECK(point.height == Approx(height).margin(1e-4));
        CHECK_FALSE(point.folds);
        CHECK(point.slope == Approx(1));
        CHECK(length(point.vector) == 0);
    }
}

TEST_CASE("reliefAt: a crest between samples keeps its height", "[relief][oracle]") {
    const BrickField scan = test::groundField(
        {24, 16, 32}, [](double x, double) { return sine(2 * kPi * (x - 6.5) / 12 + kPi / 2); });
    // Trilinear values say 0.966.
    CHECK(reliefAt(flatBase(scan), {6.5f, 8.5f, 16}, kUp).height == Approx(1).margin(0.005));
}

TEST_CASE("reliefAt: under an overhang the relief is a vector", "[relief][fast]") {
    // Solid below 16 and a bar from 19 to 21 above it.
    const BrickField scan = test::fieldFrom({16, 16, 32}, [](const Index3& p) {
        return std::clamp(std::min(float(p.z) - 15.5f, std::abs(float(p.z) - 20) - 1), -6.f, 6.f);
    });
    const ReliefPoint point = reliefAt(flatBase(scan), {8, 8, 16}, kUp);
    CHECK(point.folds);
    CHECK_FALSE(point.lost);
    CHECK(point.height == Approx(-0.5).margin(1e-3));
    CHECK(point.vector.z == Approx(-0.5).margin(0.01));
}

TEST_CASE("reliefAt: a scan without a surface along the normal is lost there", "[relief][fast]") {
    const BrickField scan(IndexBox::fromSize({16, 16, 32}), 6.f);
    const ReliefPoint point = reliefAt(flatBase(scan), {8, 8, 16}, kUp);
    CHECK(point.lost);
    CHECK(point.folds);
}

TEST_CASE("reliefAt: the other side of a thin wall is not its relief", "[relief][fast]") {
    // Base: a wall from 14 to 16; scan: the same wall, thicker by 1 a side.
    BaseSurface base = flatBase(test::fieldFrom(
        {16, 16, 32}, [](const Index3& p) { return std::clamp(std::abs(float(p.z) - 15) - 2, -6.f, 6.f); }));
    base.distance = test::fieldFrom(
        {16, 16, 32}, [](const Index3& p) { return std::clamp(std::abs(float(p.z) - 15) - 1, -6.f, 6.f); });
    const ReliefPoint point = reliefAt(base, {8, 8, 16}, kUp);
    CHECK(point.height == Approx(1).margin(1e-4));
    CHECK_FALSE(point.folds);
}

TEST_CASE("reliefLayer: counts what it holds, same bits on all threads, cancels", "[relief][determinism]") {
    const BaseSurface base = flatBase(test::waveField({40, 16, 32}, 13, 1.5));
    const ReliefLayer one = reliefLayer(base, 3, test::onThreads(1)),
                      many = reliefLayer(base, 3, test::onThreads(8));
    REQUIRE(one.voxels.size() == 5u * 40 * 16);
    CHECK(one.folded == 0);
    for (std::size_t i = 0; i < one.point.size(); ++i) REQUIRE(one.point[i].height == many.point[i].height);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { reliefLayer(base, 3, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
