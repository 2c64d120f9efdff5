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

ChartSite meanSite(const ChartEstimate* estimates, std::size_t count, const Vec3d& normal) {
    ChartSite mean{{}, normal, {}};
    double weights = 0;
    for (std::size_t l = 0; l < count; ++l) {
        const ChartSite& site = estimates[l].site;
        const double w = estimates[l].weight;
        weights += w;
        mean.q = {mean.q.x + w * site.q.x, mean.q.y + w * site.q.y};
        mean.s = mean.s + site.s * w;
    }
    mean.q = {mean.q.x / weights, mean.q.y / weights};
    const auto onSurface = [&](const Vec3d& s) { return s - normal * dot(s, normal); };
    Vec3d s = onSurface(mean.s);
    if (!(length(s) > 1e-9 * weights)) {
        // Opposite estimates cancel: that of the nearest point stands, or any direction.
        const auto heavier = [](const ChartEstimate& a, const ChartEstimate& b) {
            return a.weight < b.weight;
        };
        s = onSurface(std::max_element(estimates, estimates + count, heavier)->site.s);
        if (!(length(s) > 1e-9)) s = onSurface(std::abs(normal.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    }
    mean.s = normalized(s);
    return mean;
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
