#include "libvdbsynth/procedural/packing.h"

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kPackingPurpose = 0x7061636b;
constexpr int kRounds = 80;    // overlap is below 2 % of the radius after 60 on densities up to 0.55
constexpr double kGap = 0.02;  // of the radius, left between balls

// Calls pair(i, j) for all i < j closer than `reach`, in a fixed order.
void forClosePairs(const std::vector<PackedBall>& balls, const Vec3d& low, const Vec3d& high, double reach,
                   const std::function<void(std::size_t, std::size_t)>& pair) {
    Index3 cells;
    for (int axis = 0; axis < 3; ++axis) cells[axis] = std::max(1, int((high[axis] - low[axis]) / reach));
    const auto cellOf = [&](const Vec3d& p) {
        Index3 c;
        for (int axis = 0; axis < 3; ++axis)
            c[axis] =
                std::clamp(int(std::floor((p[axis] - low[axis]) / (high[axis] - low[axis]) * cells[axis])), 0,
                           cells[axis] - 1);
        return c;
    };
    std::vector<std::vector<std::size_t>> lists(latticeCount(cells));
    for (std::size_t i = 0; i < balls.size(); ++i)
        lists[latticeIndex(cellOf(balls[i].centre), cells)].push_back(i);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const Index3 c = cellOf(balls[i].centre);
        const IndexBox around = IndexBox{c, c}.expanded(1).intersection(IndexBox::fromSize(cells));
        forEachVoxel(around, [&](const Index3& cell) {
            for (std::size_t j : lists[latticeIndex(cell, cells)])
                if (j > i && length(balls[j].centre - balls[i].centre) < reach) pair(i, j);
        });
    }
}

}  // namespace

std::vector<PackedBall> packBalls(const Vec3d& low, const Vec3d& high, double radiusLow, double radiusHigh,
                                  double density, std::uint64_t seed, const RunContext& ctx) {
    std::vector<PackedBall> balls;
    double room = density;
    for (int axis = 0; axis < 3; ++axis) room *= high[axis] - low[axis];
    for (std::uint64_t i = 0; room > 0; ++i) {
        Random random(seed, i, kPackingPurpose);
        PackedBall ball;
        for (int axis = 0; axis < 3; ++axis) ball.centre[axis] = random.uniform(low[axis], high[axis]);
        ball.radius = random.uniform(radiusLow, radiusHigh);
        room -= 4.0 / 3 * kPi * ball.radius * ball.radius * ball.radius;
        balls.push_back(ball);
    }
    const double reach = 2 * radiusHigh * (1 + kGap);
    for (int round = 0; round < kRounds; ++round) {
        throwIfCancelled(ctx);
        std::vector<Vec3d> push(balls.size());
        forClosePairs(balls, low, high, reach, [&](std::size_t i, std::size_t j) {
            const Vec3d apart = balls[j].centre - balls[i].centre;
            const double distance = length(apart);
            const double overlap = (balls[i].radius + balls[j].radius) * (1 + kGap) - distance;
            if (overlap <= 0 || distance <= 0) return;
            const Vec3d move = apart * (0.3 * overlap / distance);
            push[i] = push[i] - move;
            push[j] = push[j] + move;
        });
        for (std::size_t i = 0; i < balls.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                balls[i].centre[axis] =
                    std::clamp(balls[i].centre[axis] + push[i][axis], low[axis], high[axis]);
    }
    // Each pair shares its distance by the ratio of the radii, so after this no pair can overlap.
    std::vector<double> radius(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) radius[i] = balls[i].radius;
    forClosePairs(balls, low, high, reach, [&](std::size_t i, std::size_t j) {
        const double share =
            length(balls[j].centre - balls[i].centre) / (balls[i].radius + balls[j].radius) / (1 + kGap);
        radius[i] = std::min(radius[i], balls[i].radius * share);
        radius[j] = std::min(radius[j], balls[j].radius * share);
    });
    for (std::size_t i = 0; i < balls.size(); ++i) balls[i].radius = radius[i];
    // Shrinking a ball to a tiny one would make a shape that the process does not have.
    balls.erase(std::remove_if(balls.begin(), balls.end(),
                               [&](const PackedBall& b) { return b.radius < 0.6 * radiusLow; }),
                balls.end());
    return balls;
}

}  // namespace vdbsynth
