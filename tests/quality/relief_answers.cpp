// Answers that are known: a plain ball, a sine, a cylinder, a torus, an undercut.
#include "tests/quality/relief_answers.h"

#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"
#include "libvdbsynth/relief/transfer/relief_transfer.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

namespace vdbsynth::quality {
namespace {

void plainBall() {
    const LevelSet ball = asModel(fieldOf({93, 93, 93}, 3, [](const Vec3d& p) { return length(p) - 40; }));
    ReliefExtractOptions options;
    options.baseRadius = 7.5;
    const ReliefStatistics s = extractRelief(ball, options).statistics;
    say("ball_relief", std::max(std::abs(s.lowest), std::abs(s.highest)));
}

// A sine along x of 24 voxels' wavelength on a plane, amplitude 0.6, that continues beyond the box.
void sineOnPlane() {
    constexpr double kWave = 24, kAmplitude = 0.6, kRadius = 6;
    const BrickField scan = test::fieldFrom({192, 64, 64}, [](const Index3& p) {
        const double t = 2 * kPi * p.x / kWave, slope = kAmplitude * 2 * kPi / kWave * cosine(t);
        const double d = (p.z - 31.7 - kAmplitude * sine(t)) / std::sqrt(1 + slope * slope);
        return float(std::clamp(d, -3.0, 3.0));
    });
    BaseOptions options;
    options.radius = kRadius;
    const BaseSurface base = baseSurface(scan, options);
    const ReliefStatistics s = reliefStatistics(base, {{48, 8, 0}, {143, 55, 63}});  // four whole waves
    const double ratio = kCutOff * kRadius / kWave, g = exponential(-0.69314718056 * ratio * ratio);
    const double wanted = kAmplitude * (1 - g) * (1 - g);
    say("sine_transfer_error", std::abs(s.sq * std::sqrt(2.0) - wanted) / kAmplitude);
    say("sine_sa_error", std::abs(s.sa / (wanted * 2 / kPi) - 1));
    say("sine_sq_error", std::abs(s.sq * std::sqrt(2.0) / wanted - 1));
    say("sine_sku_error", std::abs(s.sku / 1.5 - 1));
}

ReliefSource waves(int side, int period, double height) {
    ReliefSource source;
    source.heights = {side, side, 1, true, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            source.heights.values.push_back(float(0.5 + 0.5 * sine(2 * kPi * (x + 0.5) / period)));
    source.height = height;
    return source;
}

// Height over the target at vertices of the result's surface within 2 voxels' angle of the ring.
struct Ring {
    double amplitude = 0, wave = 0;  // of the wave number that is strongest
};
Ring strongest(const LevelSet& made, const Distance& height, const std::function<bool(const Vec3d&)>& counts,
               double around, const Vec3d& middle) {
    const BrickField field = gatherNarrowBand(*made.grid, boxOf(*made.grid));
    const Index3 corner = boxOf(*made.grid).min;
    const Mesh mesh = zeroLevel(field, field.box(), Facing::Outward);
    constexpr int kSlots = 1024;
    std::vector<double> sum(kSlots), count(kSlots);
    for (const Vec3f& v : mesh.points) {
        const Vec3d p = cast<double>(v) + at(corner) - middle;
        if (!counts(p)) continue;
        const double turn = arcTangent(p.y, p.x) / (2 * kPi) + 0.5;
        const int slot = std::min(kSlots - 1, int(turn * kSlots));
        sum[std::size_t(slot)] += height(p);
        count[std::size_t(slot)] += 1;
    }
    // Between vertices heights are interpolated: steep flanks have more vertices than crests.
    std::vector<double> mean(kSlots);
    for (int i = 0; i < kSlots; ++i) {
        int low = 0, high = 0;
        while (low < kSlots && count[std::size_t((i - low + kSlots) % kSlots)] == 0) ++low;
        while (high < kSlots && count[std::size_t((i + high) % kSlots)] == 0) ++high;
        if (low == kSlots) return {};
        const std::size_t a = std::size_t((i - low + kSlots) % kSlots), b = std::size_t((i + high) % kSlots);
        const double share = low + high > 0 ? double(low) / (low + high) : 0;
        mean[std::size_t(i)] = sum[a] / count[a] * (1 - share) + sum[b] / count[b] * share;
    }
    Ring ring;
    for (int k = 2; k < 80; ++k) {
        double c = 0, s = 0, n = 0;
        for (int i = 0; i < kSlots; ++i) {
            const double t = 2 * kPi * k * (i + 0.5) / kSlots;
            c += mean[std::size_t(i)] * cosine(t), s += mean[std::size_t(i)] * sine(t), n += 1;
        }
        const double amplitude = 2 * std::sqrt(c * c + s * s) / n;
        if (amplitude > ring.amplitude) ring = {amplitude, around / k};
    }
    return ring;
}

void onCylinder() {
    const Vec3d middle{56, 56, 56};
    const LevelSet target = asModel(fieldOf({113, 113, 113}, 3, [](const Vec3d& p) {
        const double r = std::sqrt(p.x * p.x + p.y * p.y) - 40, z = std::abs(p.z) - 40;
        return r > 0 && z > 0 ? std::sqrt(r * r + z * z) : std::max(r, z);
    }));
    ReliefOptions options = along("around:z");
    options.fit = true;
    const ReliefResult made = transferRelief({waves(64, 16, 3)}, target, nullptr, options);
    const Ring ring = strongest(
        made.model, [](const Vec3d& p) { return std::sqrt(p.x * p.x + p.y * p.y) - 40; },
        [](const Vec3d& p) { return std::abs(p.z) < 25; }, 2 * kPi * 40, middle);
    say("cylinder_wavelength_error", std::abs(ring.wave / (16 * made.fitted) - 1));
    say("cylinder_amplitude_error", std::abs(ring.amplitude / 1.5 - 1));
    say("cylinder_waves", 2 * kPi * 40 / ring.wave);
}

void onTorus() {
    const Vec3d middle{76, 76, 40};
    const auto distance = [](const Vec3d& p) {
        const double r = std::sqrt(p.x * p.x + p.y * p.y) - 48;
        return std::sqrt(r * r + p.z * p.z) - 20;
    };
    const LevelSet target = asModel(fieldOf({153, 153, 81}, 3, distance));
    const ReliefResult made = transferRelief({waves(64, 16, 3)}, target, nullptr, along("around:z"));
    for (const bool outside : {true, false}) {
        const auto counts = [=](const Vec3d& p) {
            const double r = std::sqrt(p.x * p.x + p.y * p.y);
            return std::abs(p.z) < 5 && (outside ? r > 48 : r < 48);
        };
        // Phases slip round a torus, so amplitude is that of the deviation.
        const BrickField field = gatherNarrowBand(*made.model.grid, boxOf(*made.model.grid));
        const Index3 corner = boxOf(*made.model.grid).min;
        double sum = 0, squares = 0, count = 0;
        for (const Vec3f& v : zeroLevel(field, field.box(), Facing::Outward).points) {
            const Vec3d p = cast<double>(v) + at(corner) - middle;
            if (!counts(p)) continue;
            const double h = distance(p);
            sum += h, squares += h * h, count += 1;
        }
        const double amplitude = std::sqrt(2 * (squares / count - sum / count * sum / count));
        say(outside ? "torus_outside_error" : "torus_inside_error", std::abs(amplitude / 1.5 - 1));
    }
}

// Ridges with the profile of a T on a slab: stems 4 wide and 4 high, heads 12 wide and 4 high, 24 apart.
double ridge(double x, double z) {
    const double u = std::abs(x - 24 * std::round(x / 24));
    const auto box = [](double a, double b) {
        return a > 0 && b > 0 ? std::sqrt(a * a + b * b) : std::max(a, b);
    };
    return std::min({z, box(u - 2, std::abs(z - 2) - 3), box(u - 6, std::abs(z - 6) - 2)});
}

void undercut() {
    const Index3 size{240, 96, 64};
    BaseSurface surface;
    surface.reach = 12;
    surface.distance =
        test::fieldFrom(size, [](const Index3& p) { return std::clamp(float(p.z) - 24, -12.f, 12.f); });
    surface.scan = test::fieldFrom(
        size, [](const Index3& p) { return float(std::clamp(ridge(p.x - 119.5, p.z - 24), -12.0, 12.0)); });
    surface.amplitude = 8;
    ReliefSampleOptions whole;
    whole.rough = 0;
    const PlaceDirections directions = [](const std::vector<Vec3f>& place, const std::vector<Vec3f>&) {
        return std::vector<Vec3f>(place.size(), {1, 0, 0});
    };
    const std::vector<ReliefSample> samples{
        reliefSample(std::make_shared<const BaseSurface>(surface), directions, whole)};
    ReliefTarget target;
    target.reach = std::ceil(reliefReach(samples, {})) + 1;
    target.distance = test::fieldFrom({160, 96, 64}, [&](const Index3& p) {
        return std::clamp(float(p.z) - 24.3f, -target.reach, target.reach);
    });
    makeSites(target);
    target.direction.assign(target.point.size(), {1, 0, 0});
    const BrickField made = reliefOnTarget(target, samples, matchRelief(target, samples));
    // Void with solid above it, as a share of the ground.
    const auto hidden = [](const BrickField& field, int x0, int x1, int y0, int y1) {
        double count = 0;
        for (int x = x0; x < x1; ++x)
            for (int y = y0; y < y1; ++y) {
                bool covered = false;
                for (int z = field.box().max.z - 2; z > 24; --z) {
                    covered = covered || field.at({x, y, z}) < 0;
                    count += covered && field.at({x, y, z}) >= 0;
                }
            }
        return count / double((x1 - x0) * (y1 - y0));
    };
    say("undercut_share", hidden(made, 32, 128, 16, 80) / hidden(surface.scan, 72, 168, 16, 80));
    say("undercut_folds", samples.front().folds);
}

}  // namespace

void printRightAnswers() {
    openvdb::initialize();
    plainBall();
    sineOnPlane();
    onCylinder();
    onTorus();
    undercut();
    printBallAnswers();
}

}  // namespace vdbsynth::quality
