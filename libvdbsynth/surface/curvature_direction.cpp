#include "libvdbsynth/surface/curvature_direction.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/surface/frame_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace vdbsynth {
namespace {

using Tensor = std::array<float, 6>;  // xx, xy, xz, yy, yz, zz

constexpr int kRounds = 20;
constexpr float kClear = 0.05f;  // of the mean strength; weaker tensors are ignored

Tensor outer(const Vec3f& d, float weight) {
    return {weight * d.x * d.x, weight * d.x * d.y, weight * d.x * d.z,
            weight * d.y * d.y, weight * d.y * d.z, weight * d.z * d.z};
}
Vec3f times(const Tensor& t, const Vec3f& v) {
    return {t[0] * v.x + t[1] * v.y + t[2] * v.z, t[1] * v.x + t[3] * v.y + t[4] * v.z,
            t[2] * v.x + t[4] * v.y + t[5] * v.z};
}

// Direction of the larger eigenvalue of the symmetric matrix (a b; b c), as the cosine and sine of its angle,
// and its excess over the other eigenvalue.
struct Axis2 {
    float x, y, difference;
};
Axis2 mainAxis(float a, float b, float c) {
    const float half = (a - c) / 2, root = std::sqrt(half * half + b * b);
    Vec3f v{half + root, b, 0};
    if (length(v) < 1e-12f) v = {b, root - half, 0};
    if (length(v) < 1e-12f) v = {1, 0, 0};
    v = normalized(v);
    return {v.x, v.y, 2 * root};
}

// Least squares over neighbours for the symmetric form (a b; b c) with dn = form * dx in the tangent plane.
Tensor leastCurvature(const SurfaceSites& sites, std::size_t i) {
    const Frame frame = frameFrom(sites.normal[i], {1, 0, 0});
    double xx = 0, xy = 0, yy = 0, rx = 0, ry = 0, rm = 0;  // normal equations
    const auto add = [&](std::size_t j) {
        const Vec3f dx = sites.point[j] - sites.point[i], dn = sites.normal[j] - sites.normal[i];
        const double u = dot(dx, frame.t), v = dot(dx, frame.b), p = dot(dn, frame.t), q = dot(dn, frame.b);
        xx += u * u;
        xy += u * v;
        yy += v * v;
        rx += u * p;
        ry += v * q;
        rm += u * q + v * p;
    };
    for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k) {
        const std::uint32_t j = sites.neighbours[k];
        add(j);
        for (std::uint32_t m = sites.begin[j]; m < sites.begin[j + 1]; ++m) add(sites.neighbours[m]);
    }
    // a xx + b xy = rx;  a xy + b (xx + yy) + c xy = rm;  b xy + c yy = ry
    const double determinant = xx * ((xx + yy) * yy - xy * xy) - xy * xy * yy;
    if (!(std::abs(determinant) > 1e-9)) return {};
    const double a = (rx * ((xx + yy) * yy - xy * xy) - xy * (rm * yy - xy * ry)) / determinant;
    const double b = (xx * (rm * yy - xy * ry) - rx * xy * yy) / determinant;
    const double c = (xx * ((xx + yy) * ry - xy * rm) - xy * (xy * ry) + rx * xy * xy) / determinant;
    const Axis2 axis = mainAxis(float(a), float(b), float(c));
    const float mean = float(a + c) / 2, k1 = mean + axis.difference / 2, k2 = mean - axis.difference / 2;
    const bool first = std::abs(k1) < std::abs(k2);  // the main axis is the one of least curvature
    const Vec3f along = frame.t * axis.x + frame.b * axis.y;
    const float strength = std::abs(std::abs(k1) - std::abs(k2));
    return outer(first ? along : cross(along, frame.n), strength * strength);
}

}  // namespace

std::vector<Vec3f> curvatureDirections(const SurfaceSites& sites, const RunContext& ctx) {
    const auto each = [&](auto&& work) {
        parallelFor(ctx, sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) work(i);
        });
    };
    std::vector<Tensor> tensor(sites.size()), next(sites.size());
    each([&](std::size_t i) { tensor[i] = leastCurvature(sites, i); });
    for (int round = 0; round < kRounds; ++round) {
        each([&](std::size_t i) {
            Tensor sum = tensor[i];
            for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
                for (std::size_t e = 0; e < sum.size(); ++e) sum[e] += tensor[sites.neighbours[k]][e];
            for (std::size_t e = 0; e < sum.size(); ++e)
                next[i][e] = sum[e] / float(1 + sites.begin[i + 1] - sites.begin[i]);
        });
        tensor.swap(next);
    }
    std::vector<Vec3f> direction(sites.size());
    std::vector<float> strength(sites.size(), 0);
    each([&](std::size_t i) {
        const Frame frame = frameFrom(sites.normal[i], {1, 0, 0});
        const Vec3f t = times(tensor[i], frame.t), b = times(tensor[i], frame.b);
        const Axis2 axis = mainAxis(dot(frame.t, t), dot(frame.t, b), dot(frame.b, b));
        direction[i] = frame.t * axis.x + frame.b * axis.y;
        strength[i] = axis.difference;
    });
    double mean = 0;
    for (float s : strength) mean += double(s) / double(strength.size());
    // Signs propagate from the most distinct voxel, always over the most distinct edge.
    using Entry = std::pair<float, std::uint32_t>;
    const auto later = [](const Entry& a, const Entry& b) {
        return a.first != b.first ? a.first < b.first : a.second > b.second;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
    std::vector<std::uint32_t> order(sites.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return strength[a] > strength[b]; });
    std::vector<char> done(sites.size(), 0);
    for (std::uint32_t first : order) {
        if (done[first]) continue;
        done[first] = 1;
        queue.push({strength[first], first});
        while (!queue.empty()) {
            const std::uint32_t i = queue.top().second;
            queue.pop();
            for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k) {
                const std::uint32_t j = sites.neighbours[k];
                if (done[j]) continue;
                if (dot(direction[j], direction[i]) < 0) direction[j] = -direction[j];
                done[j] = 1;
                queue.push({strength[j], j});
            }
        }
    }
    for (std::size_t i = 0; i < direction.size(); ++i)
        if (!(double(strength[i]) > double(kClear) * mean) || mean <= 0) direction[i] = {};
    return direction;
}

}  // namespace vdbsynth
