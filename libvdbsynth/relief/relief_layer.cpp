#include "libvdbsynth/relief/relief_layer.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/surface/surface_shell.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kLeastStep = 0.4f;  // [voxels] along a line: thinner sheets of the scan may be passed
constexpr float kSteepest = 0.25f;  // cosine of the angle against the base from which it folds
constexpr float kFollows = 0.7f;    // share of the way that the base's distance has to grow by
constexpr float kLeastSlope = 0.05f;
constexpr float kMostMissed = 0.3f;  // [voxels] that cubic polynomials may move a height by

// Where a line meets the scan.
struct Crossing {
    float place = 0;
    bool outward = false;  // from inside to outside along the normal
};

struct Line {
    const BaseSurface& base;
    const Vec3f& foot;
    const Vec3f& normal;
    Vec3f at(float place) const { return foot + normal * place; }
    float scan(float place) const { return sampleTrilinear(base.scan, at(place)); }
    // The foot is still the base's nearest point, about.
    bool follows(float place) const {
        return std::abs(sampleTrilinear(base.distance, at(place))) > kFollows * std::abs(place) - 0.5f;
    }
};

// The zero between two places of different sign, by the false position with halving (Illinois).
float zeroBetween(const Line& line, float a, float fa, float b, float fb) {
    for (int step = 0; step < 5; ++step) {
        const float middle = (a * fb - b * fa) / (fb - fa), value = line.scan(middle);
        if (std::abs(value) < 1e-5f) return middle;
        if ((value < 0) == (fb < 0)) {
            b = middle;
            fb = value;
            fa /= 2;
        } else {
            a = b;
            fa = fb;
            b = middle;
            fb = value;
        }
    }
    return (a * fb - b * fa) / (fb - fa);
}

// Appends the crossings of one direction, +1 or -1, in their order.
void walk(const Line& line, float direction, std::vector<Crossing>& found) {
    // Where the base's distance was not read yet: it only matters once there is a crossing.
    thread_local std::vector<float> unread;
    unread.clear();
    float place = 0, value = line.scan(0);
    while (place < line.base.reach) {
        // Distances of the scan tell how far away its surface is at least.
        const float step = std::max(kLeastStep, 0.8f * std::abs(value));
        const float next = std::min(place + step, line.base.reach);
        unread.push_back(direction * next);
        const float after = line.scan(direction * next);
        if ((after < 0) != (value < 0)) {
            if (!std::all_of(unread.begin(), unread.end(), [&](float p) { return line.follows(p); })) return;
            unread.clear();
            const float at = zeroBetween(line, direction * place, value, direction * next, after);
            found.push_back({at, (value < 0) == (direction > 0)});
        }
        place = next;
        value = after;
    }
}

// What the height misses as both surfaces were met between samples by trilinear values.
float missedHeight(const BaseSurface& base, const Vec3f& foot, const Vec3f& met, float slope) {
    const float missed = sampleCubic(base.distance, foot) - sampleCubic(base.scan, met) / slope;
    return std::clamp(missed, -kMostMissed, kMostMissed);
}

Vec3f nearestOfScan(const BaseSurface& base, const Vec3f& foot) {
    Vec3f p = projectToSurface(base.scan, foot);
    if (std::abs(sampleTrilinear(base.scan, p)) > 0.1f) p = projectToSurface(base.scan, p);
    return p - foot;
}

}  // namespace

ReliefPoint reliefAt(const BaseSurface& base, const Vec3f& foot, const Vec3f& normal) {
    const Line line{base, foot, normal};
    thread_local std::vector<Crossing> found;
    found.clear();
    walk(line, 1, found);
    walk(line, -1, found);
    const Crossing* best = nullptr;
    for (const Crossing& crossing : found)
        if (crossing.outward && (!best || std::abs(crossing.place) < std::abs(best->place))) best = &crossing;
    ReliefPoint point;
    point.lost = !best;
    if (best) {
        point.height = best->place;
        point.slope = dot(normalized(sampleGradient(base.scan, line.at(best->place))), normal);
    }
    point.folds = point.lost || found.size() > 1 || point.slope < kSteepest;
    if (!point.folds) point.height += missedHeight(base, foot, line.at(best->place), point.slope);
    point.slope = std::max(point.slope, kLeastSlope);
    if (point.folds) {
        point.vector = nearestOfScan(base, foot);
        if (point.lost) point.height = dot(point.vector, normal);
    }
    return point;
}

ReliefLayer reliefLayer(const BaseSurface& base, float halfWidth, const RunContext& ctx) {
    ReliefLayer layer;
    layer.voxels = VoxelTable::where(
        base.distance, [&](float d) { return std::abs(d) < halfWidth; }, ctx);
    layer.point.resize(layer.voxels.size());
    std::atomic<std::size_t> folded{0}, lost{0};
    parallelFor(ctx, layer.point.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::size_t ownFolded = 0, ownLost = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const Index3& v = layer.voxels[i];
            const Vec3f at{float(v.x), float(v.y), float(v.z)};
            const Vec3f foot = projectToSurface(base.distance, at);
            const Vec3f gradient = sampleGradient(base.distance, foot);
            const Vec3f normal = length(gradient) > 1e-6f ? normalized(gradient) : Vec3f{0, 0, 1};
            layer.point[i] = reliefAt(base, foot, normal);
            ownFolded += layer.point[i].folds;
            ownLost += layer.point[i].lost;
        }
        folded += ownFolded;
        lost += ownLost;
    });
    layer.folded = folded;
    layer.lost = lost;
    return layer;
}

}  // namespace vdbsynth
