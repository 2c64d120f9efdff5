#include "libvdbsynth/patch/scanline/point_pairing.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/points/point_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kReach = 3;  // [standard deviations] of theta

// Mean length and direction of the pairs around a target.
struct Coherence {
    double length = 0;
    Vec3d direction;
    bool any = false;
};

class Pairer {
public:
    Pairer(const PairingPoints& sources, const PairingPoints& targets, double spacing,
           const PairingOptions& options)
        : mSources(sources),
          mTargets(targets),
          mSpacing(spacing),
          mOptions(options),
          mLeastCosine(cosine(options.limits.normal * kPi / 180)),
          mSourceCells(sources.points, std::max(options.limits.position, 1e-6) * spacing),
          mTargetCells(targets.points, std::max(kReach * options.coherence, 1e-6) * spacing) {}

    std::vector<std::int32_t> run() const {
        std::vector<std::int32_t> pairs = pairOnce(nullptr);
        for (int round = 0; round < mOptions.rounds; ++round) pairs = pairOnce(&pairs);
        return pairs;
    }

    double cost(const std::vector<std::int32_t>& pairs) const {
        double sum = 0;
        for (std::size_t q = 0; q < pairs.size(); ++q)
            if (pairs[q] >= 0)
                sum += own(std::size_t(pairs[q]), q) + coherent(std::size_t(pairs[q]), q, around(q, pairs));
        return sum;
    }

private:
    std::vector<std::int32_t> pairOnce(const std::vector<std::int32_t>* before) const {
        std::vector<std::uint8_t> taken(mSources.points.size(), 0);
        std::vector<std::int32_t> pairs(mTargets.points.size(), -1);
        for (std::size_t q = 0; q < pairs.size(); ++q) {
            const Coherence mean = before ? around(q, *before) : Coherence{};
            double least = kInfinite;
            mSourceCells.near(cast<double>(mTargets.points[q]), [&](std::uint32_t s) {
                if (taken[s]) return;
                double cost = own(s, q);
                if (cost < kInfinite && before) cost += coherent(s, q, mean);
                if (cost < least || (cost == least && cost < kInfinite && std::int32_t(s) < pairs[q])) {
                    least = cost;
                    pairs[q] = std::int32_t(s);
                }
            });
            if (pairs[q] >= 0) taken[std::size_t(pairs[q])] = 1;
        }
        return pairs;
    }

    Vec3d apart(std::size_t s, std::size_t q) const {
        return cast<double>(mSources.points[s] - mTargets.points[q]) * (1 / mSpacing);
    }

    // c(s, q)
    double own(std::size_t s, std::size_t q) const {
        const PairingWeights& w = mOptions.weights;
        const PairingLimits& most = mOptions.limits;
        const Vec3d between = apart(s, q);
        const double squared = dot(between, between);
        if (squared > most.position * most.position) return kInfinite;
        const double together = double(dot(mSources.normals[s], mTargets.normals[q]));
        if (together < mLeastCosine) return kInfinite;
        const double variation = double(mSources.variation[s] - mTargets.variation[q]);
        if (std::abs(variation) > most.variation) return kInfinite;
        return w.position * squared + w.normal / 2 * (1 - together) + w.variation * variation * variation;
    }

    // g(s, q, pi)
    double coherent(std::size_t s, std::size_t q, const Coherence& mean) const {
        if (!mean.any) return 0;
        const PairingWeights& w = mOptions.weights;
        const Vec3d between = apart(s, q);
        const double far = length(between);
        const double together = far > 0 ? dot(mean.direction, between) / far : 0;
        return w.length * std::abs(far - mean.length) + w.direction / 2 * (1 - together);
    }

    Coherence around(std::size_t q, const std::vector<std::int32_t>& pairs) const {
        Coherence mean;
        double sum = 0;
        Vec3d direction;
        const double width = mOptions.coherence * mSpacing;
        mTargetCells.near(cast<double>(mTargets.points[q]), [&](std::uint32_t r) {
            if (r == q || pairs[r] < 0) return;
            const Vec3d away = cast<double>(mTargets.points[r] - mTargets.points[q]);
            const double squared = dot(away, away) / (width * width);
            if (squared > kReach * kReach) return;
            const double theta = exponential(-squared / 2);
            const Vec3d between = apart(std::size_t(pairs[r]), r);
            sum += theta;
            mean.length += theta * length(between);
            direction = direction + between * theta;
        });
        if (sum <= 0) return mean;
        mean.any = true;
        mean.length /= sum;
        mean.direction = normalized(direction);
        return mean;
    }

    const PairingPoints& mSources;
    const PairingPoints& mTargets;
    const double mSpacing;
    const PairingOptions& mOptions;
    const double mLeastCosine;
    const PointCells mSourceCells, mTargetCells;
};

void requirePoints(const PairingPoints& points) {
    if (points.points.size() != points.normals.size() || points.points.size() != points.variation.size())
        throw Error(ErrorCode::ShapeMismatch, "points, normals and variations to pair differ in number");
}

}  // namespace

void validate(const PairingOptions& options) {
    const auto require = [](bool holds, const char* text) {
        if (!holds) throw Error(ErrorCode::InvalidOption, text);
    };
    const PairingWeights& w = options.weights;
    for (const double weight : {w.position, w.normal, w.variation, w.length, w.direction})
        require(weight >= 0 && weight <= 1e6, "weights of pairing must be 0..1e6");
    require(options.limits.position > 0 && options.limits.position <= 100,
            "pairing's limit of position must be above 0, at most 100 spacings");
    require(options.limits.normal >= 0 && options.limits.normal <= 180,
            "pairing's limit of normals must be 0..180 degrees");
    require(options.limits.variation >= 0 && options.limits.variation <= 1,
            "pairing's limit of variation must be 0..1");
    require(options.rounds >= 0 && options.rounds <= 20, "rounds of pairing must be 0..20");
    require(options.coherence > 0 && options.coherence <= 100,
            "pairing's coherence must be above 0, at most 100");
}

std::vector<std::int32_t> pairPoints(const PairingPoints& sources, const PairingPoints& targets,
                                     double spacing, const PairingOptions& options) {
    validate(options);
    requirePoints(sources);
    requirePoints(targets);
    if (!(spacing > 0)) throw Error(ErrorCode::InvalidOption, "the points' spacing must be above 0");
    return Pairer(sources, targets, spacing, options).run();
}

double pairingCost(const PairingPoints& sources, const PairingPoints& targets,
                   const std::vector<std::int32_t>& pairs, double spacing, const PairingOptions& options) {
    return Pairer(sources, targets, spacing, options).cost(pairs);
}

}  // namespace vdbsynth
