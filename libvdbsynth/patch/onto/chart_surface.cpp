#include "libvdbsynth/patch/onto/chart_surface.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr double kReach = 2.5;  // [steps] of the sites that a node is fitted to
constexpr int kFewest = 8;      // sites of a fit

using Row = Eigen::Matrix<double, 6, 1>;

// Catmull and Rom's weights of the four nodes around a place at t after the second, and their derivatives.
struct Cubic {
    std::array<double, 4> weight, slope;
};

Cubic cubicAt(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {{0.5 * (-t + 2 * t2 - t3), 0.5 * (2 - 5 * t2 + 3 * t3), 0.5 * (t + 4 * t2 - 3 * t3),
             0.5 * (-t2 + t3)},
            {0.5 * (-1 + 4 * t - 3 * t2), 0.5 * (-10 * t + 9 * t2), 0.5 * (1 + 8 * t - 9 * t2),
             0.5 * (-2 * t + 3 * t2)}};
}

}  // namespace

std::array<double, 2> ChartPlace::curvatures() const {
    // The eigenvalues of I^-1 II, of which the forms are those of the derivatives.
    const Vec3d &u = alongPoint[0], &v = alongPoint[1];
    const double e = dot(u, u), f = dot(u, v), g = dot(v, v), area = e * g - f * f;
    const double l = dot(u, alongNormal[0]), m = 0.5 * (dot(u, alongNormal[1]) + dot(v, alongNormal[0])),
                 n = dot(v, alongNormal[1]);
    if (!(area > 1e-12)) return {0, 0};
    const double mean = 0.5 * (e * n - 2 * f * m + g * l) / area, gauss = (l * n - m * m) / area;
    const double root = std::sqrt(std::max(0.0, mean * mean - gauss));
    return {mean - root, mean + root};
}

ChartSurface::ChartSurface(const SurfaceSites& sites, const SurfaceDisk& disk, double step) : mStep(step) {
    double reach = 0;
    for (const Vec2f& at : disk.at) reach = std::max({reach, std::abs(double(at.x)), std::abs(double(at.y))});
    // Two nodes more on all sides than places can lie at.
    const int half = int(std::ceil(reach / step)) + 2;
    mSide = 2 * half + 1;
    mLow = -half * step;
    sortMembers(disk);
    mNodes.resize(std::size_t(mSide) * std::size_t(mSide));
    for (int i = 0; i < mSide; ++i)
        for (int j = 0; j < mSide; ++j)
            mNodes[std::size_t(i) * std::size_t(mSide) + std::size_t(j)] =
                fitted(sites, disk, mLow + i * step, mLow + j * step);
}

void ChartSurface::sortMembers(const SurfaceDisk& disk) {
    const auto cellOf = [&](const Vec2f& at) {
        const auto along = [&](float x) {
            return std::size_t(std::clamp(int(std::floor((double(x) - mLow) / mStep)), 0, mSide - 1));
        };
        return along(at.x) * std::size_t(mSide) + along(at.y);
    };
    mBegin.assign(std::size_t(mSide) * std::size_t(mSide) + 1, 0);
    for (const Vec2f& at : disk.at) ++mBegin[cellOf(at) + 1];
    for (std::size_t c = 1; c < mBegin.size(); ++c) mBegin[c] += mBegin[c - 1];
    mMembers.resize(disk.size());
    std::vector<std::size_t> next(mBegin.begin(), mBegin.end() - 1);
    for (std::size_t m = 0; m < disk.size(); ++m) mMembers[next[cellOf(disk.at[m])]++] = std::uint32_t(m);
}

ChartSurface::Node ChartSurface::fitted(const SurfaceSites& sites, const SurfaceDisk& disk, double x,
                                        double y) const {
    const double reach = kReach * mStep;
    const int rings = int(std::ceil(kReach)), ci = int(std::floor((x - mLow) / mStep + 0.5)),
              cj = int(std::floor((y - mLow) / mStep + 0.5));
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero(), right = normal;
    int count = 0;
    bool low[2] = {false, false}, high[2] = {false, false};
    for (int i = std::max(0, ci - rings); i <= std::min(mSide - 1, ci + rings); ++i)
        for (int j = std::max(0, cj - rings); j <= std::min(mSide - 1, cj + rings); ++j) {
            const std::size_t cell = std::size_t(i) * std::size_t(mSide) + std::size_t(j);
            for (std::size_t n = mBegin[cell]; n < mBegin[cell + 1]; ++n) {
                const std::uint32_t m = mMembers[n];
                const double u = (double(disk.at[m].x) - x) / reach, v = (double(disk.at[m].y) - y) / reach;
                const double rest = 1 - u * u - v * v;
                if (rest <= 0) continue;
                Row row;
                row << 1, u, v, u * u, u * v, v * v;
                const Vec3f &p = sites.point[disk.site[m]], &q = sites.normal[disk.site[m]];
                Row values;
                values << double(p.x), double(p.y), double(p.z), double(q.x), double(q.y), double(q.z);
                const Row weighted = row * (rest * rest);
                normal += weighted * row.transpose();
                right += weighted * values.transpose();
                low[0] = low[0] || u < 0.1;
                high[0] = high[0] || u > -0.1;
                low[1] = low[1] || v < 0.1;
                high[1] = high[1] || v > -0.1;
                ++count;
            }
        }
    Node node;
    // A fit that only continues the disk beyond its sites would bend away.
    if (count < kFewest || !low[0] || !high[0] || !low[1] || !high[1]) return node;
    normal.diagonal().array() += 1e-9 * normal.trace();
    const Eigen::Matrix<double, 6, 6> solved = normal.ldlt().solve(right);
    node.point = {solved(0, 0), solved(0, 1), solved(0, 2)};
    node.normal = normalized(Vec3d{solved(0, 3), solved(0, 4), solved(0, 5)});
    node.known = true;
    return node;
}

std::optional<ChartPlace> ChartSurface::at(double x, double y) const {
    const double fx = (x - mLow) / mStep, fy = (y - mLow) / mStep;
    const int i = int(std::floor(fx)), j = int(std::floor(fy));
    if (i < 1 || j < 1 || i + 2 >= mSide || j + 2 >= mSide) return std::nullopt;
    const Cubic alongX = cubicAt(fx - i), alongY = cubicAt(fy - j);
    ChartPlace place;
    Vec3d direction, turned[2];
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
            const std::size_t ia = std::size_t(a), ib = std::size_t(b);
            const Node& node = mNodes[std::size_t(i - 1 + a) * std::size_t(mSide) + std::size_t(j - 1 + b)];
            if (!node.known) return std::nullopt;
            const double w = alongX.weight[ia] * alongY.weight[ib],
                         wx = alongX.slope[ia] * alongY.weight[ib] / mStep,
                         wy = alongX.weight[ia] * alongY.slope[ib] / mStep;
            place.point = place.point + node.point * w;
            place.alongPoint[0] = place.alongPoint[0] + node.point * wx;
            place.alongPoint[1] = place.alongPoint[1] + node.point * wy;
            direction = direction + node.normal * w;
            turned[0] = turned[0] + node.normal * wx;
            turned[1] = turned[1] + node.normal * wy;
        }
    const double size = length(direction);
    if (!(size > 0.1)) return std::nullopt;
    place.normal = direction * (1 / size);
    for (std::size_t axis = 0; axis < 2; ++axis)
        place.alongNormal[axis] =
            (turned[axis] - place.normal * dot(place.normal, turned[axis])) * (1 / size);
    return place;
}

std::ptrdiff_t ChartSurface::nearestMember(const SurfaceSites& sites, const SurfaceDisk& disk,
                                           const Vec2f& at, const Vec3d& point) const {
    const int ci = int(std::floor((double(at.x) - mLow) / mStep)),
              cj = int(std::floor((double(at.y) - mLow) / mStep));
    std::ptrdiff_t best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int i = std::max(0, ci - 1); i <= std::min(mSide - 1, ci + 1); ++i)
        for (int j = std::max(0, cj - 1); j <= std::min(mSide - 1, cj + 1); ++j) {
            const std::size_t cell = std::size_t(i) * std::size_t(mSide) + std::size_t(j);
            for (std::size_t n = mBegin[cell]; n < mBegin[cell + 1]; ++n) {
                const double away = length(cast<double>(sites.point[disk.site[mMembers[n]]]) - point);
                if (away >= least) continue;
                least = away;
                best = std::ptrdiff_t(mMembers[n]);
            }
        }
    return best;
}

}  // namespace vdbsynth
