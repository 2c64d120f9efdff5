#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/points/point_set_surface_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kUsed = 6;    // the nearest that face the same way
constexpr std::size_t kAsked = 24;  // of a tree, to find them
constexpr float kSide =
    0.908f;  // of the square that a point has to itself, over the root mean square distance:
             // right for points at random, 7 % too long on a square lattice, 2 % too short on a hexagonal one
constexpr double kInCell = 4;        // points of a cell that make looking for neighbours quickest
constexpr std::size_t kCrowd = 512;  // points looked at, from which on a tree is quicker

// The nearest so far, nearest first; of equally near ones the first stay.
class Ring {
public:
    explicit Ring(float farthest = std::numeric_limits<float>::max()) : mFarthest(farthest) {}

    void add(float squared, std::uint32_t number) {
        if (!(squared < mFarthest)) return;
        std::size_t at = count < kUsed ? count++ : kUsed - 1;
        for (; at > 0 && squared < mSquared[at - 1]; --at) {
            mSquared[at] = mSquared[at - 1];
            numbers[at] = numbers[at - 1];
        }
        mSquared[at] = squared;
        numbers[at] = number;
        if (count == kUsed) mFarthest = mSquared[kUsed - 1];
    }
    float spacing() const {
        float sum = 0;
        for (std::size_t k = 0; k < count; ++k) sum += mSquared[k];
        return count > 0 ? kSide * std::sqrt(sum / float(count)) : 0;
    }

    std::uint32_t numbers[kUsed];
    std::size_t count = 0;

private:
    float mSquared[kUsed], mFarthest;
};

OrientedPoints everyNth(const OrientedPoints& points, std::size_t step) {
    OrientedPoints some;
    for (std::size_t i = 0; i < points.point.size(); i += step) {
        some.point.push_back(points.point[i]);
        some.normal.push_back(points.normal[i]);
    }
    return some;
}

// A square as large as the face of the points' box that takes the most, for each of them.
float sideByBox(const std::vector<Vec3f>& points) {
    Vec3f low = points[0], high = low;
    for (const Vec3f& p : points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    const Vec3d size = cast<double>(high) - cast<double>(low);
    const double face = std::max({size.x * size.y, size.y * size.z, size.z * size.x}),
                 longest = std::max({size.x, size.y, size.z}), count = double(points.size());
    return float(std::max(std::sqrt(face * kInCell / count), longest * kInCell / count));
}

// Blocks with cells of about kInCell points: the side is corrected by what the cells hold.
PointBlocks evenBlocks(const OrientedPoints& points, float& side, int tries) {
    for (;;) {
        PointBlocks blocks(points, std::vector<float>(points.point.size(), side / kCellOverReach));
        const double held = double(points.point.size()) / double(blocks.occupied());
        if (--tries <= 0 || (held > 0.5 * kInCell && held < 2 * kInCell)) return blocks;
        side *= float(std::min(std::max(std::sqrt(kInCell / held), 0.1), 10.0));
    }
}

Ring ringByBlocks(const PointBlocks& blocks, float reach, std::size_t i) {
    const StoredPoint& here = blocks[i];
    for (const float radius : {0.8f * kCellOverReach, 1.6f * kCellOverReach}) {
        Ring ring(radius * reach * radius * reach);
        std::size_t looked = 0;
        blocks.forRuns(here.point, radius, [&](std::uint32_t begin, std::uint32_t end) {
            looked += end - begin;
            if (looked > kCrowd) return;
            for (std::uint32_t j = begin; j < end; ++j) {
                const Vec3f away = blocks[j].point - here.point;
                const float squared = dot(away, away);
                if (squared > 0 && dot(here.normal, blocks[j].normal) > 0) ring.add(squared, j);
            }
        });
        if (looked > kCrowd) break;
        if (ring.count == kUsed) return ring;
    }
    return Ring();
}

// Of the nearest of any. Where fewer than three of them face the same way, as at a tip, all count.
Ring ringByTree(const OrientedPoints& points, const PointNeighbours& tree, std::size_t i) {
    std::uint32_t numbers[kAsked];
    float squared[kAsked];
    const std::size_t found = tree.nearest(points.point[i], kAsked, numbers, squared);
    Ring facing, all;
    for (std::size_t k = 0; k < found; ++k) {
        if (!(squared[k] > 0)) continue;
        all.add(squared[k], numbers[k]);
        if (dot(points.normal[i], points.normal[numbers[k]]) > 0) facing.add(squared[k], numbers[k]);
    }
    return facing.count >= 3 ? facing : all;
}

std::vector<Ring> ringsOf(OrientedPoints& points, const RunContext& ctx) {
    const std::size_t n = points.point.size(), step = std::max<std::size_t>(1, n / 4096);
    const OrientedPoints some = step > 1 ? everyNth(points, step) : OrientedPoints{};
    float side = sideByBox(step > 1 ? some.point : points.point);
    if (step > 1) {
        evenBlocks(some, side, 8);
        side /= float(std::sqrt(double(step)));
    }
    const PointBlocks blocks = evenBlocks(points, side, 8);
    for (std::size_t i = 0; i < n; ++i) {
        points.point[i] = blocks[i].point;
        points.normal[i] = blocks[i].normal;
    }
    std::vector<Ring> rings(n);
    parallelFor(ctx, n, 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) rings[i] = ringByBlocks(blocks, blocks[i].reach, i);
    });
    if (std::all_of(rings.begin(), rings.end(), [](const Ring& ring) { return ring.count > 0; }))
        return rings;
    const PointNeighbours tree(points.point);
    parallelFor(ctx, n, 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (rings[i].count == 0) rings[i] = ringByTree(points, tree, i);
    });
    return rings;
}

}  // namespace

std::vector<float> facingSpacing(OrientedPoints& points, const RunContext& ctx) {
    if (points.point.size() < 2) return std::vector<float>(points.point.size(), 0);
    const std::vector<Ring> rings = ringsOf(points, ctx);
    std::vector<float> even(rings.size());
    parallelFor(ctx, rings.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float values[kUsed + 1] = {rings[i].spacing()};
            std::size_t count = 1;
            for (std::size_t k = 0; k < rings[i].count; ++k)
                values[count++] = rings[rings[i].numbers[k]].spacing();
            std::nth_element(values, values + count / 2, values + count);
            even[i] = values[count / 2];
        }
    });
    return even;
}

}  // namespace vdbsynth
