// Local thickness in three steps: distances to the other phase, the balls that are in no other, and the
// largest of them over every voxel.
#include "libvdbsynth/measure/thickness.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/measure/distance_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace vdbsynth {
namespace {

constexpr float kMargin = 0.35f;  // [samples] around a ball, for those that balls left out nearly held alone
constexpr float kDrawnRadius = 16;  // [samples] of the largest ball that is drawn sample by sample

struct Ball {
    Vec3f centre;  // [samples of its lattice]
    float radius;
};

// Balls to draw on one lattice, by the x of their centre.
struct Lattice {
    int factor = 1;
    Index3 size{0, 0, 0};
    std::vector<Ball> balls{};
    std::vector<float> diameter{};  // [size] in samples of the finest lattice
};

// A ball counts unless a neighbour's holds it all.
bool isRidge(const Distances& distances, const Index3& p, float d) {
    const Index3& size = distances.size;
    for (int x = std::max(0, p.x - 1); x <= std::min(size.x - 1, p.x + 1); ++x)
        for (int y = std::max(0, p.y - 1); y <= std::min(size.y - 1, p.y + 1); ++y)
            for (int z = std::max(0, p.z - 1); z <= std::min(size.z - 1, p.z + 1); ++z) {
                const float apart =
                    std::sqrt(float(std::abs(x - p.x) + std::abs(y - p.y) + std::abs(z - p.z)));
                if (apart > 0 && distances.at({x, y, z}) >= d + apart * 0.96f) return false;
            }
    return true;
}

// Where a ball may stand around a sample, on a lattice of quarters, and its ways to the 27 samples around.
struct Stands {
    static constexpr int kSteps = 5, kNeighbours = 27, kPadded = 28;
    std::array<Vec3f, kSteps * kSteps * kSteps> place;
    std::array<std::array<float, kPadded>, kSteps * kSteps * kSteps> way;

    static std::size_t number(int x, int y, int z) {
        return std::size_t(((x + 2) * kSteps + y + 2) * kSteps + z + 2);
    }
    Stands() {
        for (int n = 0; n < kSteps * kSteps * kSteps; ++n) {
            const Vec3f c{float(n / 25 - 2) / 4, float(n / 5 % 5 - 2) / 4, float(n % 5 - 2) / 4};
            place[std::size_t(n)] = c;
            way[std::size_t(n)].fill(1e9f);
            for (int k = 0; k < kNeighbours; ++k)
                way[std::size_t(n)][std::size_t(k)] =
                    length(c - Vec3f{float(k / 9 - 1), float(k / 3 % 3 - 1), float(k % 3 - 1)});
        }
    }
};

// The ball that stands best within half a sample of a ridge sample p. From a neighbour q on, distances grow
// by at most the way: min over q of d(q) + |c - q| bounds the radius at c, and is it where one of the q lies
// on the line from c to the surface.
Ball bestBall(const Distances& distances, const Index3& p) {
    static const Stands stands;
    std::array<float, Stands::kPadded> near;
    near.fill(1e9f);
    for (int k = 0; k < Stands::kNeighbours; ++k) {
        const Index3 q = p + Index3{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
        if (IndexBox::fromSize(distances.size).contains(q)) near[std::size_t(k)] = distances.at(q);
    }
    float radius = distances.at(p);
    Index3 best{0, 0, 0};
    for (const int step : {2, 1}) {
        const Index3 around = best;
        for (int n = 0; n < 27; ++n) {
            const Index3 c = around + Index3{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1} * step;
            if (std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) > 2) continue;
            const std::array<float, Stands::kPadded>& way = stands.way[Stands::number(c.x, c.y, c.z)];
            std::array<float, 4> bounds;
            bounds.fill(1e9f);
            for (std::size_t k = 0; k < Stands::kPadded; k += 4)
                for (std::size_t lane = 0; lane < 4; ++lane) {
                    const float bound = near[k + lane] + way[k + lane];
                    bounds[lane] = bound < bounds[lane] ? bound : bounds[lane];
                }
            const float bound = std::min({bounds[0], bounds[1], bounds[2], bounds[3]});
            if (bound > radius) {
                radius = bound;
                best = c;
            }
        }
    }
    return {Vec3f{float(p.x), float(p.y), float(p.z)} + stands.place[Stands::number(best.x, best.y, best.z)],
            radius};
}

int levelFor(float radius) {
    int factor = 1;
    while (radius / float(factor) > kDrawnRadius) factor *= 2;
    return factor;
}

// The balls to draw, each on the lattice for its size; on a coarse one only the largest in a cell counts.
std::map<int, Lattice> ballsOf(const Distances& distances, const RunContext& ctx) {
    const Index3& size = distances.size;
    std::vector<std::vector<Ball>> planes{static_cast<std::size_t>(size.x)};
    parallelFor(ctx, std::size_t(size.x), 1, [&](std::size_t begin, std::size_t end) {
        for (int x = int(begin); x < int(end); ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z) {
                    const float d = distances.at({x, y, z});
                    if (d > 0 && isRidge(distances, {x, y, z}, d))
                        planes[std::size_t(x)].push_back(bestBall(distances, {x, y, z}));
                }
    });
    std::map<int, Lattice> lattices;
    std::map<int, std::map<Index3, Ball>> coarse;
    for (const std::vector<Ball>& plane : planes)
        for (const Ball& ball : plane) {
            const int factor = levelFor(ball.radius);
            if (factor == 1) {
                lattices[1].balls.push_back(ball);
                continue;
            }
            const Index3 cell{int(ball.centre.x + 0.5f) / factor, int(ball.centre.y + 0.5f) / factor,
                              int(ball.centre.z + 0.5f) / factor};
            Ball& kept = coarse[factor].emplace(cell, ball).first->second;
            if (ball.radius > kept.radius) kept = ball;
        }
    for (const auto& [factor, cells] : coarse)
        for (const auto& [cell, ball] : cells) lattices[factor].balls.push_back(ball);
    for (auto& [factor, lattice] : lattices) {
        lattice.factor = factor;
        lattice.size = {(size.x + factor - 1) / factor, (size.y + factor - 1) / factor,
                        (size.z + factor - 1) / factor};
        // Sample i of the coarse lattice stands in the middle of `factor` fine ones.
        for (Ball& ball : lattice.balls) {
            for (int axis = 0; axis < 3; ++axis)
                ball.centre[axis] = (ball.centre[axis] + 0.5f) / float(factor) - 0.5f;
            ball.radius /= float(factor);
        }
    }
    return lattices;
}

// Raises the samples of planes [low, high] of x within a ball to its diameter.
void draw(const Ball& ball, int low, int high, Lattice& lattice) {
    const float diameter = 2 * ball.radius * float(lattice.factor);
    const float squared = (ball.radius + kMargin) * (ball.radius + kMargin);
    const Index3& size = lattice.size;
    for (int x = low; x <= high; ++x) {
        const float dx = float(x) - ball.centre.x, flat = squared - dx * dx;
        if (flat < 0) continue;
        const float reach = std::sqrt(flat);
        const int y0 = std::max(0, int(std::ceil(ball.centre.y - reach)));
        const int y1 = std::min(size.y - 1, int(std::floor(ball.centre.y + reach)));
        for (int y = y0; y <= y1; ++y) {
            const float dy = float(y) - ball.centre.y, rest = flat - dy * dy;
            if (rest < 0) continue;
            const float half = std::sqrt(rest);
            const int z0 = std::max(0, int(std::ceil(ball.centre.z - half)));
            const int z1 = std::min(size.z - 1, int(std::floor(ball.centre.z + half)));
            float* row = lattice.diameter.data() +
                         (std::size_t(x) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.z);
            for (int z = z0; z <= z1; ++z) row[z] = std::max(row[z], diameter);
        }
    }
}

void drawAll(Lattice& lattice, const RunContext& ctx) {
    const Index3& size = lattice.size;
    lattice.diameter.assign(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z), 0);
    constexpr int kPlanes = 4;
    // Each chunk of planes draws its part of the balls near it; balls are in order of x, up to kDrawnRadius.
    const auto before = [](const Ball& ball, float x) { return ball.centre.x < x; };
    parallelFor(ctx, std::size_t(size.x), kPlanes, [&](std::size_t begin, std::size_t end) {
        const float low = float(begin) - kDrawnRadius - 2, high = float(end) + kDrawnRadius + 2;
        auto ball = std::lower_bound(lattice.balls.begin(), lattice.balls.end(), low, before);
        for (; ball != lattice.balls.end() && ball->centre.x <= high; ++ball) {
            const int first = std::max(int(begin), int(std::ceil(ball->centre.x - ball->radius - kMargin)));
            const int last = std::min(int(end) - 1, int(std::floor(ball->centre.x + ball->radius + kMargin)));
            draw(*ball, first, last, lattice);
        }
    });
}

}  // namespace

Thickness localThickness(const BrickField& field, float band, Phase phase, double limit,
                         const RunContext& ctx) {
    const BrickField* samples = &field;
    BrickField coarse;
    int step = 1;
    for (; double(samples->box().volume()) > limit; step *= 2) {
        coarse = halved(*samples, ctx);
        samples = &coarse;
    }
    // A mean over voxels of which some lie beyond the band is no distance.
    const float known = step == 1 ? band : std::max(0.f, band / float(step) - 0.9f);
    Distances distances = distancesWithin(*samples, 1.f / float(step), known, phase, ctx);
    std::map<int, Lattice> lattices = ballsOf(distances, ctx);
    for (auto& [factor, lattice] : lattices) {
        std::stable_sort(lattice.balls.begin(), lattice.balls.end(),
                         [](const Ball& a, const Ball& b) { return a.centre.x < b.centre.x; });
        drawAll(lattice, ctx);
    }
    Thickness result;
    result.size = distances.size;
    result.coarsening = step;
    result.diameter = std::move(distances.values);
    const Index3& size = result.size;
    parallelFor(ctx, std::size_t(size.x), 4, [&](std::size_t begin, std::size_t end) {
        for (int x = int(begin); x < int(end); ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z) {
                    float& value = result.diameter[(std::size_t(x) * std::size_t(size.y) + std::size_t(y)) *
                                                       std::size_t(size.z) +
                                                   std::size_t(z)];
                    if (value <= 0) continue;
                    value *= 2 * float(step);  // its own ball
                    for (const auto& [factor, lattice] : lattices) {
                        const std::size_t cell = (std::size_t(x / factor) * std::size_t(lattice.size.y) +
                                                  std::size_t(y / factor)) *
                                                     std::size_t(lattice.size.z) +
                                                 std::size_t(z / factor);
                        value = std::max(value, lattice.diameter[cell] * float(step));
                    }
                }
    });
    return result;
}

ThicknessSummary summarize(const Thickness& thickness, const IndexBox& box, int reach) {
    ThicknessSummary summary;
    summary.share.assign(std::size_t(reach) + 1, 0);
    const int step = thickness.coarsening;
    double count = 0, sum = 0, squares = 0;
    for (int x = box.min.x / step; x <= std::min(thickness.size.x - 1, box.max.x / step); ++x)
        for (int y = box.min.y / step; y <= std::min(thickness.size.y - 1, box.max.y / step); ++y)
            for (int z = box.min.z / step; z <= std::min(thickness.size.z - 1, box.max.z / step); ++z) {
                const double d = double(
                    thickness.diameter[(std::size_t(x) * std::size_t(thickness.size.y) + std::size_t(y)) *
                                           std::size_t(thickness.size.z) +
                                       std::size_t(z)]);
                if (d <= 0) continue;
                count += 1;
                sum += d;
                squares += d * d;
                summary.largest = std::max(summary.largest, d);
                summary.share[std::size_t(std::min(double(reach), d))] += 1;
            }
    if (count == 0) return summary;
    summary.mean = sum / count;
    summary.deviation = std::sqrt(std::max(0.0, squares / count - summary.mean * summary.mean));
    for (double& share : summary.share) share /= count;
    return summary;
}

}  // namespace vdbsynth
