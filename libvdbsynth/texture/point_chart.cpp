#include "libvdbsynth/texture/point_chart.h"

#include <algorithm>

namespace vdbsynth {

bool continueChart(const ChartSite& p, const Vec3d& v, ChartEstimate& estimate) {
    const double distance = length(v);
    const Vec3d v0 = v * (1 / distance), t = cross(p.n, p.s);
    const double rise = dot(v0, p.n);
    if (!(std::abs(rise) <= 1 - 1e-6)) return false;
    const double along = dot(v0, p.s), across = dot(v0, t);
    const double flat = 1 / std::sqrt(along * along + across * across);
    const double c1 = along * flat, c2 = across * flat;
    estimate.site.q = {p.q.x + distance * c1, p.q.y + distance * c2};
    estimate.site.n = normalized(p.n - v0 * rise);
    estimate.t = v0 * c2 + cross(estimate.site.n, v0) * c1;
    estimate.site.s = cross(estimate.t, estimate.site.n);
    estimate.weight = 1 / distance;
    return true;
}

ChartSite meanSite(const ChartEstimate* estimates, std::size_t count) {
    ChartSite mean;
    double weights = 0;
    for (std::size_t l = 0; l < count; ++l) {
        const ChartSite& site = estimates[l].site;
        const double w = estimates[l].weight;
        weights += w;
        mean.q = {mean.q.x + w * site.q.x, mean.q.y + w * site.q.y};
        mean.n = mean.n + site.n * w;
        mean.s = mean.s + site.s * w;
    }
    mean.q = {mean.q.x / weights, mean.q.y / weights};
    // Opposite estimates may cancel: the nearest point's, which has the largest weight, then stands.
    const Vec3d n = normalized(mean.n);
    const Vec3d s = mean.s - n * dot(mean.s, n);
    const double size = length(s);
    if (!(dot(n, n) > 0.5) || !(size > 1e-9 * weights)) {
        const auto heavier = [](const ChartEstimate& a, const ChartEstimate& b) {
            return a.weight < b.weight;
        };
        const ChartEstimate& nearest = *std::max_element(estimates, estimates + count, heavier);
        return {mean.q, nearest.site.n, nearest.site.s};
    }
    return {mean.q, n, s * (1 / size)};
}

double chartDistortion(const ChartEstimate* estimates, std::size_t count, const ChartSite& mean,
                       const ChartDistortion& weights) {
    const Vec3d t = cross(mean.n, mean.s);
    double sum = 0, positions = 0, farthest = 0, turns = 0, mostTurned = 0;
    for (std::size_t l = 0; l < count; ++l) {
        const ChartEstimate& e = estimates[l];
        const double x = e.site.q.x - mean.q.x, y = e.site.q.y - mean.q.y;
        const double position = e.weight * std::sqrt(x * x + y * y);
        const double turn = e.weight * std::max(0.0, 2 - dot(e.site.s, mean.s) - dot(e.t, t));
        sum += e.weight;
        positions += position;
        turns += turn;
        farthest = std::max(farthest, position);
        mostTurned = std::max(mostTurned, turn);
    }
    return weights.w3 * (weights.w2 * turns / sum + mostTurned) +
           weights.w4 * (weights.w1 * positions / sum + farthest);
}

}  // namespace vdbsynth
