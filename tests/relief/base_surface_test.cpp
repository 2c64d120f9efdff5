#include "libvdbsynth/relief/base_surface.h"

#include "libvdbsynth/distance/zero_level.h"
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

TEST_CASE("baseSurface: every kind takes a wave off a ball and leaves the ball", "[relief][property]") {
    const auto scanOf = [](double bump) {
        return test::fieldFrom({117, 117, 117}, [=](const Index3& p) {
            const double x = p.x - 58, y = p.y - 58, z = p.z - 58;
            const double h = bump * sine(0.6 * x) * sine(0.6 * y + 0.5) * sine(0.6 * z + 1);
            return float(std::clamp((std::sqrt(x * x + y * y + z * z) - 32 - h) / 1.05, -3.0, 3.0));
        });
    };
    const BrickField bumpy = scanOf(0.8);
    const BaseKind kind = GENERATE(BaseKind::Twicing, BaseKind::Gaussian, BaseKind::Flow, BaseKind::Normals,
                                   BaseKind::Quadrics);
    CAPTURE(int(kind));
    const BaseSurface base = baseSurface(bumpy, withRadius(5, kind));
    const double shrunk = kind == BaseKind::Gaussian || kind == BaseKind::Flow ? 25 / 32.0 : 0;
    double sum = 0, squares = 0, count = 0;
    for (const Vec3f& p : zeroLevel(base.distance, base.distance.box(), Facing::Outward).points) {
        const double off = double(length(p - Vec3f{58, 58, 58})) - 32 + shrunk;
        sum += off;
        squares += off * off;
        ++count;
    }
    CHECK(sum / count == Approx(0).margin(0.15));
    CHECK(std::sqrt(squares / count) < 0.2);  // the bumps deviate by 0.28
}

TEST_CASE("baseSurface: normals keep the edges of a box, a mean does not", "[relief][property]") {
    // A box of 60 voxels with a wave of 0.6 on its faces.
    const BrickField scan = test::fieldFrom({124, 124, 124}, [](const Index3& p) {
        const Vec3d q{std::abs(p.x - 62.) - 30, std::abs(p.y - 62.) - 30, std::abs(p.z - 62.) - 30};
        const double wave = 0.6 * sine(0.7 * p.x) * sine(0.7 * p.y) * sine(0.7 * p.z);
        const Vec3d out{std::max(q.x, 0.), std::max(q.y, 0.), std::max(q.z, 0.)};
        const double d = length(out) + std::min(0., std::max({q.x, q.y, q.z}));
        return float(std::clamp((d - wave) / 1.05, -3.0, 3.0));
    });
    // The edge at x = y = 32 runs along z; 0 where the base goes through it.
    const auto cut = [&](BaseKind kind) {
        const BaseSurface base = baseSurface(scan, withRadius(5, kind));
        double sum = 0;
        for (int z = 45; z < 80; ++z) sum += double(base.distance.at({32, 32, z}));
        return sum / 35;
    };
    CHECK(cut(BaseKind::Normals) < 1);  // half a sample of its lattice
    CHECK(cut(BaseKind::Gaussian) > 1.5);
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
    for (const BaseKind kind : {BaseKind::Twicing, BaseKind::Flow, BaseKind::Normals, BaseKind::Quadrics})
        CHECK(test::samplesOf(baseSurface(scan, withRadius(5, kind), test::onThreads(1)).distance) ==
              test::samplesOf(baseSurface(scan, withRadius(5, kind), test::onThreads(8)).distance));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              baseSurface(scan, withRadius(5), ctx);
          }).code == int(ErrorCode::Cancelled));
}
