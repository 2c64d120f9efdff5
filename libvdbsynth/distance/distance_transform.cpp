#include "libvdbsynth/distance/distance_transform.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::int32_t kNone = -1;
constexpr int kTogether = 16;  // lines walked side by side, so that memory is read in order
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Places of the surface, and the number of the one nearest to every sample so far.
struct Feet {
    Index3 size;
    std::vector<Vec3f> places{};
    std::vector<std::int32_t> nearest{};

    std::size_t index(int x, int y, int z) const { return latticeIndex({x, y, z}, size); }
};

// From a voxel next to the surface down its distance's gradient.
Vec3f footOf(const BrickField& field, const Index3& q) {
    Vec3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Index3 low = q, high = q;
        --low[axis];
        ++high[axis];
        gradient[axis] = field.at(high) - field.at(low);
    }
    const Vec3f place{float(q.x), float(q.y), float(q.z)};
    return place - normalized(gradient) * field.inside(q);
}

// The foot of the voxel nearest to a sample's middle of those of its own that are within one of the surface.
// @return false if none is
bool ownFoot(const BrickField& field, const Index3& sample, int step, Vec3f& foot) {
    const Index3 low = sample * step;
    IndexBox voxels{low, low + Index3{step - 1, step - 1, step - 1}};
    voxels = voxels.intersection(field.box());
    float constant = 0;
    if (step >= 4 && field.constantIn(voxels, constant) && std::abs(constant) >= 1) return false;
    Index3 best = low;
    int nearest = std::numeric_limits<int>::max();
    forEachVoxel(voxels, [&](const Index3& p) {
        if (std::abs(field.inside(p)) >= 1) return;
        const Index3 twice = (p - low) * 2 - Index3{step - 1, step - 1, step - 1};
        const int apart = twice.x * twice.x + twice.y * twice.y + twice.z * twice.z;
        if (apart >= nearest) return;
        nearest = apart;
        best = p;
    });
    if (nearest == std::numeric_limits<int>::max()) return false;
    foot = footOf(field, best);
    for (int axis = 0; axis < 3; ++axis) foot[axis] = (foot[axis] + 0.5f) / float(step) - 0.5f;
    return true;
}

void findFeet(const BrickField& field, int step, Feet& feet, const RunContext& ctx) {
    const Index3 size = feet.size;
    std::vector<std::vector<Vec3f>> planes{static_cast<std::size_t>(size.x)};
    parallelFor(ctx, planes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t x = begin; x < end; ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z) {
                    Vec3f foot;
                    std::int32_t& own = feet.nearest[feet.index(int(x), y, z)];
                    own = kNone;
                    if (!ownFoot(field, {int(x), y, z}, step, foot)) continue;
                    own = std::int32_t(planes[x].size());
                    planes[x].push_back(foot);
                }
    });
    std::vector<std::int32_t> before(planes.size(), 0);
    for (std::size_t x = 0; x < planes.size(); ++x) {
        before[x] = std::int32_t(feet.places.size());
        feet.places.insert(feet.places.end(), planes[x].begin(), planes[x].end());
    }
    const std::size_t plane = std::size_t(size.y) * std::size_t(size.z);
    parallelFor(ctx, planes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * plane; i < end * plane; ++i)
            if (feet.nearest[i] != kNone) feet.nearest[i] += before[i / plane];
    });
}

// The field's value at a sample: of its only voxel, or the mean of those around the middle of an even number.
float valueAt(const BrickField& field, const Index3& sample, int step) {
    if (step == 1) return field.inside(sample);
    const Index3 low = sample * step + Index3{(step - 1) / 2, (step - 1) / 2, (step - 1) / 2};
    if (step % 2 == 1) return field.at(low);
    float sum = 0;
    for (int n = 0; n < 8; ++n) sum += field.at(low + Index3{n >> 2, n >> 1 & 1, n & 1});
    return sum / 8;
}

// The lower envelope of parabolas height + (p - centre)^2 over a line, as which is the lowest at each p.
class Envelope {
public:
    struct Parabola {
        double centre, height;
        std::int32_t foot;
    };

    void add(const Parabola& parabola) { mAll.push_back(parabola); }

    // Writes the lowest one's foot for p = 0 .. n - 1, kNone if there is none; then the envelope is empty.
    void sweep(int n, std::int32_t* out) {
        // Feet lie within a sample of where they come from, so few are out of order.
        std::stable_sort(mAll.begin(), mAll.end(),
                         [](const Parabola& a, const Parabola& b) { return a.centre < b.centre; });
        mLowest.clear();
        mStarts.clear();
        for (const Parabola& parabola : mAll) push(parabola);
        std::size_t k = 0;
        for (int p = 0; p < n; ++p) {
            while (k + 1 < mLowest.size() && mStarts[k + 1] < p) ++k;
            out[p] = mLowest.empty() ? kNone : mLowest[k].foot;
        }
        mAll.clear();
    }

private:
    void push(const Parabola& next) {
        double start = -kInfinite;
        while (!mLowest.empty()) {
            const Parabola& last = mLowest.back();
            const double apart = next.centre - last.centre;
            if (apart <= 0) {
                if (next.height >= last.height) return;
                start = -kInfinite;
            } else {
                start = ((next.height - last.height) / apart + next.centre + last.centre) / 2;
                if (start > mStarts.back()) break;
            }
            mLowest.pop_back();
            mStarts.pop_back();
        }
        mStarts.push_back(mLowest.empty() ? -kInfinite : start);
        mLowest.push_back(next);
    }

    std::vector<Parabola> mAll, mLowest;
    std::vector<double> mStarts;
};

// One pass: the feet known on a line compete for the samples of that line.
void nearestAlong(int axis, Feet& feet, const RunContext& ctx) {
    const Index3 size = feet.size;
    // Lines along z lie in memory one after another; those along y and x side by side.
    const int outer = axis == 0 ? 1 : 0, n = size[axis];
    const int sides = axis == 2 ? size.y : size.z, together = axis == 2 ? 1 : kTogether;
    parallelFor(ctx, std::size_t(size[outer]), 1, [&](std::size_t begin, std::size_t end) {
        Envelope envelope;
        std::vector<std::int32_t> lines(std::size_t(n) * kTogether), line(static_cast<std::size_t>(n));
        for (int fixed = int(begin); fixed < int(end); ++fixed)
            for (int side = 0; side < sides; side += together) {
                const int count = std::min(together, sides - side);
                const auto place = [&](int i, int k) {
                    return axis == 2   ? Index3{fixed, side, i}
                           : axis == 1 ? Index3{fixed, i, side + k}
                                       : Index3{i, fixed, side + k};
                };
                for (int i = 0; i < n; ++i)
                    for (int k = 0; k < count; ++k) {
                        const Index3 p = place(i, k);
                        lines[std::size_t(i * kTogether + k)] = feet.nearest[feet.index(p.x, p.y, p.z)];
                    }
                for (int k = 0; k < count; ++k) {
                    for (int i = 0; i < n; ++i) {
                        const std::int32_t foot = lines[std::size_t(i * kTogether + k)];
                        if (foot == kNone) continue;
                        const Vec3d at = cast<double>(feet.places[std::size_t(foot)]);
                        const Index3 p = place(i, k);
                        double height = 0;
                        for (int a = 0; a < 3; ++a)
                            if (a != axis) height += (at[a] - p[a]) * (at[a] - p[a]);
                        envelope.add({at[axis], height, foot});
                    }
                    envelope.sweep(n, line.data());
                    for (int i = 0; i < n; ++i) lines[std::size_t(i * kTogether + k)] = line[std::size_t(i)];
                }
                for (int i = 0; i < n; ++i)
                    for (int k = 0; k < count; ++k) {
                        const Index3 p = place(i, k);
                        feet.nearest[feet.index(p.x, p.y, p.z)] = lines[std::size_t(i * kTogether + k)];
                    }
            }
    });
}

}  // namespace

Distances distancesToSurface(const BrickField& field, float band, int coarsening, const RunContext& ctx) {
    const Index3 voxels = field.box().size();
    const auto samplesOf = [&](int n) { return (n + coarsening - 1) / coarsening; };
    const Index3 size{samplesOf(voxels.x), samplesOf(voxels.y), samplesOf(voxels.z)};
    const std::size_t samples = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    requireMemory(ctx, double(samples) * 8, "measuring distances", "compare smaller boxes or larger voxels");
    Feet feet{size};
    feet.nearest.resize(samples);
    findFeet(field, coarsening, feet, ctx);
    for (int axis : {2, 1, 0}) nearestAlong(axis, feet, ctx);
    // A mean over voxels of which some lie beyond the band is no distance.
    const float known = coarsening == 1 ? band : band - 0.9f;
    Distances result{size, std::vector<float>(samples)};
    const float none = float(std::max({size.x, size.y, size.z}));
    parallelFor(ctx, std::size_t(size.x), 1, [&](std::size_t begin, std::size_t end) {
        for (int x = int(begin); x < int(end); ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z) {
                    const float own = valueAt(field, {x, y, z}, coarsening);
                    const std::size_t i = feet.index(x, y, z);
                    const std::int32_t foot = feet.nearest[i];
                    const Vec3f p{float(x), float(y), float(z)};
                    const float far = foot == kNone ? none : length(feet.places[std::size_t(foot)] - p);
                    result.values[i] = std::abs(own) < known ? own / float(coarsening) : own < 0 ? -far : far;
                }
    });
    return result;
}

}  // namespace vdbsynth
