#include "libvdbsynth/render/traced_surface.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/distance_transform.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kCells = 8;
constexpr double kFarSamples = 1e6;

int coarsenessFor(const Index3& size) {
    const double volume = double(size.x) * size.y * size.z;
    int coarseness = 2;
    while (volume / (double(coarseness) * coarseness * coarseness) > kFarSamples) ++coarseness;
    return coarseness;
}

}  // namespace

TracedSurface::TracedSurface(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    mSolid = solidBox(grid, "the model");
    mLimit = float(std::min(halfWidthOf(grid), 8.0));
    mScale = mLimit / 32767;
    mVoxels = mSolid.expanded(int(std::ceil(mLimit)) + 1);
    mVoxelSize = voxelSizeOf(grid);
    const Vec3d corner = fromVec(
        grid.indexToWorld(toVec(Vec3d{double(mVoxels.min.x), double(mVoxels.min.y), double(mVoxels.min.z)})));
    mToWorld = kIdentity;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d next{double(mVoxels.min.x), double(mVoxels.min.y), double(mVoxels.min.z)};
        next[axis] += 1;
        mAxes[axis] = fromVec(grid.indexToWorld(toVec(next))) - corner;
        for (int r = 0; r < 3; ++r) {
            mToWorld[std::size_t(axis * 4 + r)] = mAxes[axis][r];
            mToWorld[std::size_t(12 + r)] = corner[r];
        }
    }
    const Index3 size = mVoxels.size();
    mBricks = {(size.x + kCells - 1) / kCells, (size.y + kCells - 1) / kCells,
               (size.z + kCells - 1) / kCells};
    for (int axis = 0; axis < 3; ++axis) {
        mLast[axis] = float(size[axis] - 1);
    }
    const Index3 solid = mSolid.size();
    mReach = 0.5f * float(length(Vec3d{double(solid.x), double(solid.y), double(solid.z)}));
    const Index3 twice = mSolid.min + mSolid.max - mVoxels.min * 2;
    mMiddle = Vec3f{float(twice.x), float(twice.y), float(twice.z)} * 0.5f;
    const BrickField field = gatherBricks(grid, mVoxels, float(1 / mVoxelSize), mLimit, ctx);
    layOut(field, ctx);
    measureEmptiness();
    mCoarseness = coarsenessFor(size);
    Distances far = distancesToSurface(field, mLimit, mCoarseness, ctx);
    mFarSize = far.size;
    mFar = std::move(far.values);
    for (float& value : mFar) value = std::max(0.f, value * float(mCoarseness));
}

void TracedSurface::layOut(const BrickField& field, const RunContext& ctx) {
    mSlots.assign(latticeCount(mBricks), kAllOutside);
    parallelFor(ctx, mSlots.size(), 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            float value = 0;
            // With the samples of the next bricks that cells of this one reach.
            const Index3 low = latticeVoxel(b, mBricks) * kCells;
            if (field.constantIn({low, low + Index3{kCells, kCells, kCells}}, value))
                mSlots[b] = value < 0 ? kAllInside : kAllOutside;
            else
                mSlots[b] = 0;
        }
    });
    std::int32_t stored = 0;
    for (std::int32_t& slot : mSlots)
        if (slot == 0) slot = stored++;
    requireMemory(ctx, double(stored) * kBrickSamples * sizeof(std::int16_t), "drawing this model",
                  "use larger voxels");
    mSamples.resize(std::size_t(stored) * kBrickSamples);
    parallelFor(ctx, mSlots.size(), 64, [&](std::size_t begin, std::size_t end) {
        float values[kBrickSamples];
        for (std::size_t b = begin; b < end; ++b) {
            if (mSlots[b] < 0) continue;
            field.readBox(latticeVoxel(b, mBricks) * kCells, {kStride, kStride, kStride}, values);
            std::int16_t* out = mSamples.data() + std::size_t(mSlots[b]) * kBrickSamples;
            for (int i = 0; i < kBrickSamples; ++i)
                out[i] = std::int16_t(std::lround(std::clamp(values[i] / mScale, -32767.f, 32767.f)));
        }
    });
}

// How many bricks every brick is from one with samples, along the axis where they are farthest apart: two
// passes over the neighbours before and behind are exact for this distance.
void TracedSurface::measureEmptiness() {
    mEmpty.assign(mSlots.size(), 255);
    const IndexBox box = IndexBox::fromSize(mBricks);
    const auto relax = [&](std::size_t i, bool before) {
        if (mSlots[i] >= 0) mEmpty[i] = 0;
        const Index3 p = latticeVoxel(i, mBricks);
        for (std::size_t n = 0; n < 13; ++n) {
            const Index3 q = p + kAllNeighbours[before ? n : 25 - n];
            if (!box.contains(q)) continue;
            const std::uint8_t there = mEmpty[latticeIndex(q, mBricks)];
            if (there < 254 && there + 1 < mEmpty[i]) mEmpty[i] = std::uint8_t(there + 1);
        }
    };
    for (std::size_t i = 0; i < mEmpty.size(); ++i) relax(i, true);
    for (std::size_t i = mEmpty.size(); i-- > 0;) relax(i, false);
}

Vec3d TracedSurface::placeHere(const Vec3d& world) const {
    return directionHere(world - Vec3d{mToWorld[12], mToWorld[13], mToWorld[14]});
}

Vec3d TracedSurface::directionHere(const Vec3d& world) const {
    // The axes are at right angles and of one length.
    const double squared = 1 / (mVoxelSize * mVoxelSize);
    return Vec3d{dot(world, mAxes[0]), dot(world, mAxes[1]), dot(world, mAxes[2])} * squared;
}

// The places of the surface next to a brick's voxels, or of a large model the corners of what a brick holds.
std::vector<Vec3d> TracedSurface::outline() const {
    constexpr std::size_t kManyBricks = 30000;
    const bool many = mSamples.size() / kBrickSamples > kManyBricks;
    std::vector<Vec3d> places;
    for (std::size_t b = 0; b < mSlots.size(); ++b) {
        if (mSlots[b] < 0) continue;
        const std::int16_t* samples = mSamples.data() + std::size_t(mSlots[b]) * kBrickSamples;
        const Index3 low = latticeVoxel(b, mBricks) * kCells;
        Vec3d least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
        forEachVoxel(IndexBox::fromSize({kCells, kCells, kCells}), [&](const Index3& p) {
            const float value = float(samples[(p.x * kStride + p.y) * kStride + p.z]) * mScale;
            if (value >= 0 || value < -1.2f) return;
            Vec3f here{float(low.x + p.x), float(low.y + p.y), float(low.z + p.z)};
            if (!many) here = here - normalAt(here) * value;
            for (int axis = 0; axis < 3; ++axis) {
                least[axis] = std::min(least[axis], double(here[axis]));
                most[axis] = std::max(most[axis], double(here[axis]));
            }
            if (!many) places.push_back(transformed(mToWorld, cast<double>(here)));
        });
        for (int c = 0; many && most.x >= least.x && c < 8; ++c)
            places.push_back(transformed(
                mToWorld, {c & 1 ? most.x : least.x, c & 2 ? most.y : least.y, c & 4 ? most.z : least.z}));
    }
    if (places.empty()) places.push_back(transformed(mToWorld, cast<double>(mMiddle)));
    return places;
}

double TracedSurface::lowest(const Vec3d& axis) const {
    double least = 1e300;
    for (std::size_t b = 0; b < mSlots.size(); ++b) {
        if (mSlots[b] < 0) continue;
        const std::int16_t* samples = mSamples.data() + std::size_t(mSlots[b]) * kBrickSamples;
        const Index3 low = latticeVoxel(b, mBricks) * kCells;
        forEachVoxel(IndexBox::fromSize({kCells, kCells, kCells}), [&](const Index3& p) {
            const std::int16_t value = samples[(p.x * kStride + p.y) * kStride + p.z];
            if (value >= 0 || float(value) * mScale < -1.2f) return;
            const Index3 q = low + p;
            least = std::min(least, dot(axis, Vec3d{double(q.x), double(q.y), double(q.z)}) +
                                        double(value) * double(mScale));
        });
    }
    return least < 1e300 ? least : dot(axis, cast<double>(mMiddle));
}

Vec3f TracedSurface::normalAt(const Vec3f& p) const {
    constexpr float kStep = 0.75f;
    Vec3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3f low = p, high = p;
        low[axis] -= kStep;
        high[axis] += kStep;
        gradient[axis] = bandDistance(high) - bandDistance(low);
    }
    return normalized(gradient);
}

bool TracedSurface::meets(const Vec3f& origin, const Vec3f& direction, float& along) const {
    // The part of the ray within the samples.
    float begin = 0, end = 1e30f;
    Vec3f inverse;
    for (int axis = 0; axis < 3; ++axis) {
        inverse[axis] = 1 / (std::abs(direction[axis]) > 1e-12f ? direction[axis] : 1e-12f);
        const float low = (0.f - origin[axis]) * inverse[axis];
        const float high = (mLast[axis] - origin[axis]) * inverse[axis];
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
    }
    float before = begin, outside = mLimit;
    for (float t = begin + 1e-3f; t < end;) {
        const Vec3f p = origin + direction * t;
        const Index3 cell{int(p.x), int(p.y), int(p.z)}, brick{cell.x >> 3, cell.y >> 3, cell.z >> 3};
        const std::size_t b =
            latticeIndex({std::clamp(brick.x, 0, mBricks.x - 1), std::clamp(brick.y, 0, mBricks.y - 1),
                          std::clamp(brick.z, 0, mBricks.z - 1)},
                         mBricks);
        if (mSlots[b] == kAllOutside) {
            // To where the ray leaves the empty bricks around this one.
            const int k = mEmpty[b];
            float leave = 1e30f;
            for (int axis = 0; axis < 3; ++axis) {
                const float side = inverse[axis] > 0 ? float((brick[axis] + k) * kCells)
                                                     : float((brick[axis] - k + 1) * kCells);
                leave = std::min(leave, (side - origin[axis]) * inverse[axis]);
            }
            before = t;
            outside = mLimit;
            t = std::max(leave, t) + 1e-2f;
            continue;
        }
        // Rounding may put a place next to the end a little beyond it.
        const bool within = p.x >= 0 && p.y >= 0 && p.z >= 0 && brick.x < mBricks.x && brick.y < mBricks.y &&
                            brick.z < mBricks.z;
        const float value = mSlots[b] >= 0 && within ? sampleIn(mSlots[b], cell, p) : bandDistance(p);
        if (value < 0) {
            float low = before, high = t, atLow = outside, atHigh = value;
            for (int i = 0; i < 6; ++i) {
                const float next = low + (high - low) * std::clamp(atLow / (atLow - atHigh), 0.05f, 0.95f);
                const float there = bandDistance(origin + direction * next);
                (there < 0 ? high : low) = next;
                (there < 0 ? atHigh : atLow) = there;
                if (std::abs(there) < 2e-3f) break;
            }
            along = low + (high - low) * std::clamp(atLow / (atLow - atHigh), 0.f, 1.f);
            return true;
        }
        before = t;
        outside = value;
        t += std::max(0.25f, 0.85f * value);
    }
    return false;
}

}  // namespace vdbsynth
