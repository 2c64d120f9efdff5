#include "libvdbsynth/relief/base_scale.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/relief/base_surface_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kSmallest = 2;            // [voxels] first radius
constexpr double kSmallestShare = 0.01;    // of the longest side: finer ones take long
constexpr double kNoise = 1. / 3;          // [voxels] deviation that a lattice may make
constexpr double kNearlySmallest = 0.25;   // of the growth
constexpr double kShown = 0.5;             // [voxels] deviation of a relief that can be seen
constexpr double kGap = 2;                 // growth under which there is a gap
constexpr double kShareOfLongest = 0.025;  // the radius without a gap
constexpr double kStepRadius = 1.4;        // samples a radius: variances need no more
constexpr int kLargestStep = 64;

// Steps up to 4 as a base's; above twice as wide ones of means.
int stepOf(double radius) {
    const int step = std::max(1, int(radius / kStepRadius));
    if (step <= 4) return step;
    int doubled = 4;
    while (2 * doubled <= std::min(step, kLargestStep)) doubled *= 2;
    return doubled;
}

double deviationAt(const SmoothField& distances, const Mesh& surface, double radius, const RunContext& ctx) {
    const SmoothField smooth = smoothedDistances(distances, BaseKind::Twicing, radius, ctx);
    double sum = 0;
    for (const float h : distancesFromBase(smooth, surface, ctx)) sum += double(h) * double(h);
    return std::sqrt(sum / double(surface.points.size()));
}

// Half an octave apart.
std::vector<double> radiiOf(double longest) {
    std::vector<double> radii;
    const double smallest = std::max(kSmallest, longest * kSmallestShare);
    for (int k = 0;; ++k) {
        const double radius = smallest * double(1 << (k / 2)) * (k % 2 ? std::sqrt(2.0) : 1);
        if (radius > largestBaseRadius(longest)) return radii;
        radii.push_back(radius);
    }
}

// Of radii with one step the distances are the same; those of steps over 4 are made of each other.
std::vector<double> deviationsOf(const BrickField& scan, const Mesh& surface,
                                 const std::vector<double>& radii, float band, const RunContext& ctx) {
    Stage stage(ctx, "finding the relief's scale", std::max<std::size_t>(1, radii.size()));
    // The farthest that distances on each voxel and each step are needed for.
    const auto reachOf = [&](int step) {
        double most = 0;
        for (const double radius : radii)
            if (std::min(4, stepOf(radius)) == step) most = std::max(most, 5 * radius);
        return float(most);
    };
    float reach = 0;
    for (int step = 1; step <= 4; ++step)
        if (reachOf(step) > 0) reach = std::max(reach, wideReach(step, reachOf(step)));
    const WideDistances wide = radii.empty() ? WideDistances{} : wideDistances(scan, band, reach, ctx);
    std::vector<double> deviations;
    SmoothField distances;
    distances.step = 0;
    for (const double radius : radii) {
        const int step = stepOf(radius);
        if (step > distances.step && distances.step < 4)
            distances = latticeDistances(wide, std::min(4, step), reachOf(std::min(4, step)), ctx);
        while (distances.step < step) distances = coarserMeans(distances, ctx);
        deviations.push_back(deviationAt(distances, surface, radius, ctx));
        stage.advance();
    }
    return deviations;
}

// Growth of the variance over the octave around each radius but the first and last.
std::vector<double> growths(const std::vector<double>& deviation) {
    std::vector<double> growth;
    for (std::size_t i = 1; i + 1 < deviation.size(); ++i)
        growth.push_back(2 * (logarithm2(std::max(1e-9, deviation[i + 1])) -
                              logarithm2(std::max(1e-9, deviation[i - 1]))));
    return growth;
}

void choose(BaseScale& scale, double longest) {
    const std::vector<double> growth = growths(scale.deviation);
    double least = 1e9;
    for (std::size_t i = 0; i < growth.size(); ++i)
        if (scale.deviation[i + 1] >= kNoise) least = std::min(least, growth[i]);
    for (std::size_t i = 0; i < growth.size() && least < kGap; ++i) {
        if (scale.deviation[i + 1] < kNoise || growth[i] > least + kNearlySmallest) continue;
        scale.radius = scale.radii[i + 1];
        scale.gap = true;
        scale.reason = "the relief's variance grows least there, " +
                       roundedText(exponential(growth[i] * 0.6931471805599453), 3) +
                       " times an octave; its deviation is " + roundedText(scale.deviation[i + 1], 3) +
                       " voxels";
        return;
    }
    scale.radius = std::clamp(longest * kShareOfLongest, 1.0, std::max(1.0, largestBaseRadius(longest)));
    // On a coarse model, or one of large bumps, a 40th shows nothing.
    for (std::size_t i = 0; i < scale.radii.size(); ++i) {
        if (scale.radii[i] <= scale.radius || scale.deviation[i] < kShown) continue;
        if (i > 0 && scale.deviation[i - 1] >= kShown) break;
        scale.radius = scale.radii[i];
        scale.reason =
            "the first at which the relief's deviation is over half a voxel, as its spectrum has no gap";
        return;
    }
    scale.reason = least > 1e8 ? "a 40th of the model, as no relief stands out of the lattice's noise"
                               : "a 40th of the model, as the relief's spectrum has no gap";
}

}  // namespace

double largestBaseRadius(double longest) {
    return std::min(longest / 10, 1000.0);
}

BaseScale findBaseRadius(const BrickField& scan, double longest, float band, const RunContext& ctx) {
    requireOption(longest >= 1 && longest < 1e9, "longest", roundedText(longest, 6), "at least 1 [voxels]");
    requireField(&scan, "the scan");
    const Mesh surface = zeroLevel(scan, scan.box(), Facing::Outward, ctx);
    if (surface.faceCount() == 0) throw Error(ErrorCode::EmptyInput, "the scan has no surface");
    BaseScale scale;
    scale.radii = radiiOf(longest);
    scale.deviation = deviationsOf(scan, surface, scale.radii, band, ctx);
    choose(scale, longest);
    return scale;
}

}  // namespace vdbsynth
