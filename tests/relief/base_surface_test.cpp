#include "libvdbsynth/relief/base_surface.h"

#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

BaseOptions withRadius(double radius, BaseKind kind = BaseKind::Twicing) {
    BaseOptions options;
    options.radius = radius;
    options.kind = kind;
    return options;
}

// The largest height of a layer.
double highest(const BaseSurface& base) {
    double most = 0;
    for (const ReliefPoint& point : reliefLayer(base, 2).point)
        most = std::max(most, std::abs(double(point.height)));
    return most;
}

// The share of a wave's amplitude that is left in the relief, by least squares over the box's middle.
double kept(const BaseSurface& base, double wave, double amplitude) {
    const Index3 size = base.distance.box().size();
    double over = 0, under = 0;
    for (int x = size.x / 4; x < size.x * 3 / 4; ++x) {
        Vec3f foot{float(x), float(size.y / 2), float(size.z / 2)};
        foot.z -= sampleTrilinear(base.distance, foot);
        const Vec3f normal = normalized(sampleGradient(base.distance, foot));
        const double s = amplitude * sine(2 * kPi * x / wave);
        over += s * double(reliefAt(base, foot, normal).height);
        under += s * s;
    }
    return over / under;
}

// What a Gaussian of cut-off L leaves to the base of a wave of length w [iso16610].
double passed(double radius, double wave) {
    const double ratio = kCutOff * radius / wave;
    return exponential(-0.69314718055994530942 * ratio * ratio);
}

}  // namespace

TEST_CASE("baseSurface: a plain ball has no relief if the radius is under a fifth", "[relief][oracle]") {
    const double radius = GENERATE(3.0, 6.0, 7.9);
    const BaseSurface base = baseSurface(test::ballField(40, baseMargin(radius)), withRadius(radius));
    CHECK(highest(base) < 0.05);
    CHECK(base.beyond == 0);
}

TEST_CASE("baseSurface: a Gaussian takes sigma^2 / r off a ball", "[relief][oracle]") {
    const BaseSurface base =
        baseSurface(test::ballField(40, baseMargin(6)), withRadius(6, BaseKind::Gaussian));
    CHECK(highest(base) == Approx(36 / 40.0).margin(0.06));
}

TEST_CASE("baseSurface: a wave's relief has the transfer function of the mean", "[relief][oracle]") {
    const double wave = GENERATE(20.0, 40.0, 60.0), radius = GENERATE(3.0, 6.0, 10.0);
    const BrickField scan = test::waveField({240, 8, 128}, wave, wave / 40);
    const double g = passed(radius, wave);
    CAPTURE(wave, radius);
    CHECK(kept(baseSurface(scan, withRadius(radius)), wave, wave / 40) ==
          Approx((1 - g) * (1 - g)).margin(0.02));
    CHECK(kept(baseSurface(scan, withRadius(radius, BaseKind::Gaussian)), wave, wave / 40) ==
          Approx(1 - g).margin(0.02));
}

TEST_CASE("baseSurface: options and scans out of range are refused", "[relief][error]") {
    const BrickField scan = test::ballField(10, 8);
    for (const double radius : {0.5, 1001.0, std::nan("")}) {
        const test::Thrown thrown = test::thrownBy([&] { baseSurface(scan, withRadius(radius)); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`radius`"));
    }
    BaseOptions options;
    options.band = 1;
    CHECK(test::contains(test::thrownBy([&] { baseSurface(scan, options); }).message, "`band`"));
    options = {};
    options.reach = 2;
    CHECK(test::contains(test::thrownBy([&] { baseSurface(scan, options); }).message, "`reach`"));
    const BrickField nothing(IndexBox::fromSize({20, 20, 20}), 3.f);
    CHECK(test::thrownBy([&] { baseSurface(nothing); }).code == int(ErrorCode::EmptyInput));
    const test::Thrown gone = test::thrownBy([&] { baseSurface(test::ballField(3, 60), withRadius(11)); });
    CHECK(gone.code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(gone.message, "smaller"));
}

TEST_CASE("baseSurface: same bits for any number of threads, and cancels", "[relief][determinism]") {
    const BrickField scan = test::waveField({60, 40, 60}, 17, 1);
    CHECK(test::samplesOf(baseSurface(scan, withRadius(5), test::onThreads(1)).distance) ==
          test::samplesOf(baseSurface(scan, withRadius(5), test::onThreads(8)).distance));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              baseSurface(scan, withRadius(5), ctx);
          }).code == int(ErrorCode::Cancelled));
}
