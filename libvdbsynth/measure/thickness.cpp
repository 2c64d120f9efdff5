// Local thickness in three steps: distances to the other phase, the balls that no other contains, and the
// largest of them over every voxel.
#include "libvdbsynth/measure/thickness.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/distance_transform.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace vdbsynth {
namespace {

// [samples] around a ball that count as inside: those that the omitted balls would have covered, and on a
// coarse lattice those of a sample whose middle is outside.
float marginOf(int factor) {
    return factor == 1 ? 0.35f : 0.6f;
}

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

// Distances within one phase: positive there, negative in the other.
struct PhaseDistances {
    const Distances& distances;
    float sign;
    float at(const Index3& p) const { return sign * distances.at(p); }
};

// Away from every ridge, distances grow at rate one away from the surface, and the ball is inside the next
// one on that path. Within a sample of a ridge the difference across two samples shows that they do not.
// Writes the squared slope of a whole row.
void slopesOfRow(const Distances& d, int x, int y, std::vector<float>& squared) {
    const Index3& size = d.size;
    const auto row = [&](int i, int k) {
        return d.values.data() + d.index({std::clamp(i, 0, size.x - 1), std::clamp(k, 0, size.y - 1), 0});
    };
    const auto share = [](int at, int n) { return at == 0 || at == n - 1 ? 1.f : 0.5f; };
    const float *west = row(x - 1, y), *east = row(x + 1, y), *south = row(x, y - 1), *north = row(x, y + 1),
                *here = row(x, y);
    const float alongX = share(x, size.x), alongY = share(y, size.y);
    const auto slope = [&](int z, int low, int high, float alongZ) {
        const float a = (east[z] - west[z]) * alongX, b = (north[z] - south[z]) * alongY,
                    c = (here[high] - here[low]) * alongZ;
        return a * a + b * b + c * c;
    };
    const int last = size.z - 1;
    squared[0] = slope(0, 0, std::min(1, last), 1.f);
    for (int z = 1; z < last; ++z) squared[std::size_t(z)] = slope(z, z - 1, z + 1, 0.5f);
    if (last > 0) squared[std::size_t(last)] = slope(last, last - 1, last, 1.f);
}

constexpr float kRidgeSlope = 0.95f;

constexpr IndexBox kAround{{-1, -1, -1}, {1, 1, 1}};  // the steps to the samples around one, and to itself

// Where a ball may stand around a sample, on a lattice of quarters, and its ways to the 27 samples around.
struct Stands {
    static constexpr int kSteps = 5, kPadded = 28;
    std::array<Vec3f, kSteps * kSteps * kSteps> place;
    std::array<std::array<float, kPadded>, kSteps * kSteps * kSteps> way;

    static std::size_t number(int x, int y, int z) {
        return std::size_t(((x + 2) * kSteps + y + 2) * kSteps + z + 2);
    }
    Stands() {
        forEachVoxel(IndexBox::cube({-2, -2, -2}, kSteps), [&](const Index3& at) {
            const std::size_t n = number(at.x, at.y, at.z);
            const Vec3f c{float(at.x) / 4, float(at.y) / 4, float(at.z) / 4};
            place[n] = c;
            way[n].fill(1e9f);
            std::size_t k = 0;
            forEachVoxel(kAround, [&](const Index3& q) {
                way[n][k++] = length(c - Vec3f{float(q.x), float(q.y), float(q.z)});
            });
        });
    }
};

// The best-placed ball within half a sample of a ridge sample p. From a neighbour q on, distances grow by at
// most the path length: min over q of d(q) + |c - q| bounds the radius at c, and equals it if one of the q is
// on the line from c to the surface.
Ball bestBall(const PhaseDistances& d, const Index3& p) {
    static const Stands stands;
    std::array<float, Stands::kPadded> near;
    near.fill(1e9f);
    std::size_t sample = 0;
    forEachVoxel(kAround, [&](const Index3& way) {
        if (IndexBox::fromSize(d.distances.size).contains(p + way)) near[sample] = d.at(p + way);
        ++sample;
    });
    float radius = d.at(p);
    Index3 best{0, 0, 0};
    for (const int step : {2, 1}) {
        const Index3 around = best;
        forEachVoxel(kAround, [&](const Index3& to) {
            const Index3 c = around + to * step;
            if (std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) > 2) return;
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
        });
    }
    return {Vec3f{float(p.x), float(p.y), float(p.z)} + stands.place[Stands::number(best.x, best.y, best.z)],
            radius};
}

int levelFor(float radius) {
    int factor = 1;
    while (radius / float(factor) > kDrawnRadius) factor *= 2;
    return factor;
}

// Side of the cells [samples of its lattice] of which only the largest ball is drawn: two balls of radius r
// whose centres are 1.5 sides apart differ by less than the margin between them.
int cellFor(float radius) {
    return radius < 3 ? 1 : radius < 10 ? 2 : 3;
}

// A sample that may be a ball's centre, the lattice that the ball would be drawn on, and the cell of which it
// may be the largest, in one number.
struct Candidate {
    std::uint64_t cell;
    Index3 place;
    float radius;
    int factor;
};

Candidate candidateFor(const Index3& p, float radius) {
    const int factor = levelFor(radius), side = factor * cellFor(radius / float(factor));
    std::uint64_t number = std::uint64_t(side);  // 1, 2, 3 or a power of two times 2 or 3: no two equal
    for (int axis = 0; axis < 3; ++axis) number = number << 17 | std::uint64_t(p[axis] / side);
    return {number, p, radius, factor};
}

// Keeps the largest ball of each cell, the first of several; in the order of the cells.
void keepLargest(std::vector<Candidate>& all) {
    std::stable_sort(all.begin(), all.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cell < b.cell; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (kept == 0 || all[kept - 1].cell != all[i].cell)
            all[kept++] = all[i];
        else if (all[i].radius > all[kept - 1].radius)
            all[kept - 1] = all[i];
    all.resize(kept);
}

// The balls to draw, each on the lattice for its size.
std::map<int, Lattice> ballsOf(const PhaseDistances& d, const RunContext& ctx) {
    const Index3& size = d.distances.size;
    constexpr int kPlanes = 12;  // whole cells of most sizes
    std::vector<std::vector<Candidate>> slabs((std::size_t(size.x) + kPlanes - 1) / kPlanes);
    std::vector<std::vector<Ball>> balls(slabs.size());
    parallelFor(ctx, slabs.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slab = begin; slab < end; ++slab) {
            std::vector<float> squared(static_cast<std::size_t>(size.z));
            for (int x = int(slab) * kPlanes; x < std::min(size.x, int(slab + 1) * kPlanes); ++x)
                for (int y = 0; y < size.y; ++y) {
                    slopesOfRow(d.distances, x, y, squared);
                    for (int z = 0; z < size.z; ++z)
                        if (squared[std::size_t(z)] < kRidgeSlope * kRidgeSlope && d.at({x, y, z}) > 0)
                            slabs[slab].push_back(candidateFor({x, y, z}, d.at({x, y, z})));
                }
            keepLargest(slabs[slab]);
            for (const Candidate& candidate : slabs[slab])
                balls[slab].push_back(bestBall(d, candidate.place));
        }
    });
    std::map<int, Lattice> lattices;
    for (std::size_t slab = 0; slab < slabs.size(); ++slab)
        for (std::size_t i = 0; i < slabs[slab].size(); ++i)
            lattices[slabs[slab][i].factor].balls.push_back(balls[slab][i]);
    for (auto& [factor, lattice] : lattices) {
        lattice.factor = factor;
        lattice.size = {(size.x + factor - 1) / factor, (size.y + factor - 1) / factor,
                        (size.z + factor - 1) / factor};
        // Sample i of the coarse lattice is in the middle of `factor` fine ones.
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
    const float held = ball.radius + marginOf(lattice.factor), squared = held * held;
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
            float* row = lattice.diameter.data() + latticeIndex({x, y, 0}, size);
            for (int z = z0; z <= z1; ++z) row[z] = std::max(row[z], diameter);
        }
    }
}

void drawAll(Lattice& lattice, const RunContext& ctx) {
    const Index3& size = lattice.size;
    lattice.diameter.assign(latticeCount(size), 0);
    constexpr int kPlanes = 4;
    const float margin = marginOf(lattice.factor);
    // Each chunk of planes draws its part of the nearby balls; balls are sorted by x, up to kDrawnRadius.
    const auto before = [](const Ball& ball, float x) { return ball.centre.x < x; };
    parallelFor(ctx, std::size_t(size.x), kPlanes, [&](std::size_t begin, std::size_t end) {
        const float low = float(begin) - kDrawnRadius - 2, high = float(end) + kDrawnRadius + 2;
        auto ball = std::lower_bound(lattice.balls.begin(), lattice.balls.end(), low, before);
        for (; ball != lattice.balls.end() && ball->centre.x <= high; ++ball) {
            const int first = std::max(int(begin), int(std::ceil(ball->centre.x - ball->radius - margin)));
            const int last = std::min(int(end) - 1, int(std::floor(ball->centre.x + ball->radius + margin)));
            draw(*ball, first, last, lattice);
        }
    });
}

}  // namespace

Thickness localThickness(const Distances& sampled, int coarsening, Phase phase, const RunContext& ctx) {
    const PhaseDistances distances{sampled, phase == Phase::Solid ? -1.f : 1.f};
    const int step = coarsening;
    std::map<int, Lattice> lattices = ballsOf(distances, ctx);
    for (auto& [factor, lattice] : lattices) {
        std::stable_sort(lattice.balls.begin(), lattice.balls.end(),
                         [](const Ball& a, const Ball& b) { return a.centre.x < b.centre.x; });
        drawAll(lattice, ctx);
    }
    Thickness result;
    result.size = sampled.size;
    result.coarsening = step;
    result.diameter.assign(sampled.values.size(), 0);
    const Index3& size = result.size;
    parallelFor(ctx, std::size_t(size.x), 4, [&](std::size_t begin, std::size_t end) {
        forEachVoxel({{int(begin), 0, 0}, {int(end) - 1, size.y - 1, size.z - 1}}, [&](const Index3& p) {
            const float own = distances.at(p);
            if (phase == Phase::Solid ? own <= 0 : own < 0) return;
            float diameter = 2 * own;
            for (const auto& [factor, lattice] : lattices) {
                const std::size_t cell =
                    latticeIndex({p.x / factor, p.y / factor, p.z / factor}, lattice.size);
                diameter = std::max(diameter, lattice.diameter[cell]);
            }
            result.diameter[sampled.index(p)] = diameter * float(step);
        });
    });
    return result;
}

ThicknessSummary summarize(const Thickness& thickness, const IndexBox& box, int reach) {
    ThicknessSummary summary;
    summary.share.assign(std::size_t(reach) + 1, 0);
    const int step = thickness.coarsening;
    double count = 0, sum = 0, squares = 0;
    IndexBox samples;
    for (int axis = 0; axis < 3; ++axis) {
        samples.min[axis] = box.min[axis] / step;
        samples.max[axis] = std::min(thickness.size[axis] - 1, box.max[axis] / step);
    }
    forEachVoxel(samples, [&](const Index3& p) {
        const double d = double(thickness.diameter[latticeIndex(p, thickness.size)]);
        if (d <= 0) return;
        count += 1;
        sum += d;
        squares += d * d;
        summary.largest = std::max(summary.largest, d);
        summary.share[std::size_t(std::min(double(reach), d))] += 1;
    });
    if (count == 0) return summary;
    summary.mean = sum / count;
    summary.deviation = std::sqrt(std::max(0.0, squares / count - summary.mean * summary.mean));
    for (double& share : summary.share) share /= count;
    return summary;
}

}  // namespace vdbsynth
