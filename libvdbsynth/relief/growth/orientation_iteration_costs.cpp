#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/smallest_rotation.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/relief/growth/orientation_iteration_steps.h"

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

constexpr double kNoise = 1e-4;  // [voxels^2] differences under it say nothing about directions

// D of one site and angle, divided by the weights: the terms rotated by -angle at the best of the references.
float leastCost(const ReliefMatcher& matcher, const std::vector<ReliefTerm>& terms, const Vec2f& angle,
                const std::vector<std::uint32_t>& references, std::vector<ReliefTerm>& rotated) {
    rotated = terms;
    for (ReliefTerm& term : rotated)
        term.place = {term.place.x * angle.x + term.place.y * angle.y,
                      term.place.y * angle.x - term.place.x * angle.y, term.place.z};
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t s : references)
        least = std::min(least, matcher.cost(matcher.frame(s), rotated, least));
    float weights = 0;
    for (const ReliefTerm& term : terms) weights += term.weight;
    return weights > 0 && !references.empty() ? least / weights : 0;
}

// Costs become what they are over a site's least one, in units of the mean over all sites and angles.
void normalizeCosts(RotationCosts& costs, std::size_t angles) {
    double sum = 0;
    for (std::size_t i = 0; i * angles < costs.cost.size(); ++i) {
        float* cost = costs.cost.data() + i * angles;
        const float least = *std::min_element(cost, cost + angles);
        for (std::size_t a = 0; a < angles; ++a) {
            cost[a] -= least;
            sum += double(cost[a]);
        }
    }
    const double mean = std::max(kNoise, sum / double(std::max<std::size_t>(costs.cost.size(), 1)));
    for (float& cost : costs.cost) cost = float(double(cost) / mean);
}

}  // namespace

RotationCosts rotationCosts(const ReliefSites& surface, const ReliefMatcher& matcher,
                            const ReliefNeighbourhoods& neighbourhoods, int angles,
                            const std::function<void(std::size_t, std::vector<std::uint32_t>&)>& referencesOf,
                            const RunContext& ctx) {
    constexpr std::size_t kGrain = 16;
    const std::size_t n = surface.sites.size(), count = std::size_t(angles);
    RotationCosts costs;
    costs.frame = reliefFrames(surface.sites, surface.tangent, ctx);
    for (int a = 0; a < angles; ++a) {
        const double angle = 2 * kPi * a / angles;
        costs.direction.push_back({float(cosine(angle)), float(sine(angle))});
    }
    costs.cost.resize(n * count);
    parallelFor(ctx, n, kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<ReliefTerm> terms, rotated;
        std::vector<std::uint32_t> references;
        for (std::size_t i = begin; i < end; ++i) {
            matcher.terms(costs.frame[i], surface.sites, surface.displacement, neighbourhoods, i, nullptr,
                          terms);
            referencesOf(i, references);
            for (std::size_t a = 0; a < count; ++a)
                costs.cost[i * count + a] =
                    leastCost(matcher, terms, costs.direction[a], references, rotated);
        }
    });
    normalizeCosts(costs, count);
    return costs;
}

Vec3f bestDirection(const RotationCosts& costs, std::size_t site, const Vec3f& mean, double smoothness) {
    const std::size_t angles = costs.direction.size();
    const ReliefFrame& frame = costs.frame[site];
    const Vec2f m{dot(mean, frame.tangent), dot(mean, frame.binormal)};
    const auto total = [&](std::size_t a) {
        const Vec2f& d = costs.direction[a];
        return costs.cost[site * angles + a] + float(smoothness) * (1 - d.x * m.x - d.y * m.y);
    };
    std::size_t best = 0;
    for (std::size_t a = 1; a < angles; ++a)
        if (total(a) < total(best)) best = a;
    // Between angles: the lowest point of the parabola through the best and the two beside it.
    const float low = total((best + angles - 1) % angles), middle = total(best),
                high = total((best + 1) % angles);
    const float bend = low - 2 * middle + high;
    const double shift = bend > 0 ? double(std::clamp(0.5f * (low - high) / bend, -0.5f, 0.5f)) : 0;
    const double angle = 2 * kPi * (double(best) + shift) / double(angles);
    return frame.tangent * float(cosine(angle)) + frame.binormal * float(sine(angle));
}

Vec3f neighboursMean(const SurfaceSites& sites, const std::vector<Vec3f>& tangent, std::size_t site,
                     const char* known) {
    Vec3f sum;
    std::size_t count = 0;
    for (std::size_t k = sites.begin[site]; k < sites.begin[site + 1]; ++k) {
        const std::uint32_t v = sites.neighbours[k];
        if (known && !known[v]) continue;
        sum = sum + carried(tangent[v], sites.normal[v], sites.normal[site]);
        ++count;
    }
    return count > 0 ? sum * (1 / float(count)) : sum;
}

double meanAngle(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += arcTangent(double(length(cross(a[i], b[i]))), double(dot(a[i], b[i])));
    return a.empty() ? 0 : sum / double(a.size()) * 180 / kPi;
}

void relaxOrientation(const RotationCosts& costs, const SurfaceSites& sites,
                      const OrientationOptions& options, ReliefOrientation& result, const RunContext& ctx) {
    std::vector<Vec3f> next(sites.size());
    Stage stage(ctx, "orienting relief", std::size_t(options.rounds));
    result.converged = false;
    for (result.rounds = 0; result.rounds < options.rounds && !result.converged; ++result.rounds) {
        parallelFor(ctx, sites.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                next[i] = bestDirection(costs, i, neighboursMean(sites, result.tangent, i, nullptr),
                                        options.smoothness);
        });
        result.change = meanAngle(next, result.tangent);
        result.converged = result.change < options.limit;
        result.tangent.swap(next);
        stage.advance();
    }
}

}  // namespace vdbsynth
