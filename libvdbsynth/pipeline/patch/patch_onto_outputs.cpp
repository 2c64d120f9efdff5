// The level set of points all around a model.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/rebuild_band.h"
#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/patch/patch_onto.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/tools/Composite.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;
constexpr float kLimit = 3;    // [voxels] of distances
constexpr double kFar = 2;     // [voxels] from the surface beyond which a distance says nothing
constexpr int kReach = 1;      // voxels around a point's own that are measured
constexpr float kUnknown = 9;  // in place of a distance

using Brick = std::array<float, BrickField::kSamples>;

int sampleOf(int x, int y, int z) {
    return (x * kSide + y) * kSide + z;
}

// Distances in bricks of voxels: those that hold points or lie beside them, and what is around as one each.
class PointBricks {
public:
    PointBricks(const std::vector<Vec3f>& points, const Vec3d& origin, double voxelSize)
        : mPoints(points), mOrigin(origin), mVoxel(voxelSize) {
        Vec3d low = placeOf(points.front()), high = low;
        for (const Vec3f& point : points) {
            const Vec3d at = placeOf(point);
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], at[axis]);
                high[axis] = std::max(high[axis], at[axis]);
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            // A brick more on all sides, in which no point is near.
            mFirst[axis] = (int(std::floor(low[axis] / kSide)) - 2) * kSide;
            mBricks[axis] = (int(std::floor(high[axis])) - mFirst[axis]) / kSide + 3;
        }
    }

    double bricks() const { return double(mBricks.x) * double(mBricks.y) * double(mBricks.z); }
    std::size_t held() const { return mNear.size(); }

    // Numbers the bricks that a point may say something in.
    void sortPoints() {
        mSlot.assign(std::size_t(bricks()), -1);
        for (std::uint32_t p = 0; p < mPoints.size(); ++p) {
            const Index3 voxel = voxelOf(mPoints[p]);
            const Index3 low = brickAt(voxel - Index3{kReach, kReach, kReach}),
                         high = brickAt(voxel + Index3{kReach, kReach, kReach});
            forEachVoxel(IndexBox{low, high}, [&](const Index3& brick) {
                std::int32_t& slot = mSlot[latticeIndex(brick, mBricks)];
                if (slot < 0) {
                    slot = std::int32_t(mNear.size());
                    mNear.push_back(brick);
                    mOf.emplace_back();
                }
                mOf[std::size_t(slot)].push_back(p);
            });
        }
    }

    void measure(const PointSetSurface& surface, const RunContext& ctx) {
        mValues.resize(mNear.size());
        Stage stage(ctx, "distances of the points", mNear.size());
        constexpr std::size_t kAtOnce = 1024;
        for (std::size_t first = 0; first < mNear.size(); first += kAtOnce) {
            const std::size_t count = std::min(kAtOnce, mNear.size() - first);
            parallelFor(ctx, count, 4, [&](std::size_t begin, std::size_t end) {
                for (std::size_t n = begin; n < end; ++n) measureBrick(surface, first + n);
            });
            stage.advance(count);
        }
    }

    // The sign of what no point is near: of every connected part that of most known voxels beside it; of the
    // part around all, outside.
    void fill() {
        DisjointSets parts(mSlot.size() + mNear.size() * BrickField::kSamples);
        eachPair([&](std::uint32_t a, std::uint32_t b, float va, float vb) {
            if (va == kUnknown && vb == kUnknown) parts.join(a, b);
        });
        std::vector<std::int32_t> votes(mSlot.size() + mNear.size() * BrickField::kSamples, 0);
        eachPair([&](std::uint32_t a, std::uint32_t b, float va, float vb) {
            if ((va == kUnknown) == (vb == kUnknown)) return;
            votes[parts.root(va == kUnknown ? a : b)] += (va == kUnknown ? vb : va) < 0 ? 1 : -1;
        });
        const std::uint32_t outside = parts.root(0);
        const auto sign = [&](std::uint32_t node) {
            const std::uint32_t root = parts.root(node);
            return root != outside && votes[root] > 0 ? -kLimit : kLimit;
        };
        for (std::size_t slot = 0; slot < mNear.size(); ++slot)
            for (int s = 0; s < BrickField::kSamples; ++s)
                if (float& value = mValues[slot][std::size_t(s)]; value == kUnknown)
                    value = sign(nodeOf(slot, s));
        mFarValue.resize(mSlot.size());
        for (std::uint32_t brick = 0; brick < mSlot.size(); ++brick)
            mFarValue[brick] = mSlot[brick] < 0 ? sign(brick) : 0;
    }

    BrickField field() const {
        const Index3 size{mBricks.x * kSide, mBricks.y * kSide, mBricks.z * kSide};
        BrickField field({mFirst, mFirst + size - Index3{1, 1, 1}}, kLimit);
        const Index3 side{kSide, kSide, kSide};
        for (std::size_t brick = 0; brick < mSlot.size(); ++brick) {
            const Index3 at = latticeVoxel(brick, mBricks);
            const Index3 corner = mFirst + Index3{at.x * kSide, at.y * kSide, at.z * kSide};
            if (mSlot[brick] >= 0) {
                field.writeBox(corner, side, mValues[std::size_t(mSlot[brick])].data());
            } else if (mFarValue[brick] < 0) {
                Brick inside;
                inside.fill(-kLimit);
                field.writeBox(corner, side, inside.data());
            }
        }
        return field;
    }

private:
    Vec3d placeOf(const Vec3f& point) const { return (cast<double>(point) + mOrigin) * (1 / mVoxel); }
    Index3 voxelOf(const Vec3f& point) const {
        const Vec3d at = placeOf(point);
        return {int(std::lround(at.x)), int(std::lround(at.y)), int(std::lround(at.z))};
    }
    Index3 brickAt(const Index3& voxel) const {
        return {(voxel.x - mFirst.x) / kSide, (voxel.y - mFirst.y) / kSide, (voxel.z - mFirst.z) / kSide};
    }
    std::uint32_t nodeOf(std::size_t slot, int sample) const {
        return std::uint32_t(mSlot.size() + slot * BrickField::kSamples + std::size_t(sample));
    }

    void measureBrick(const PointSetSurface& surface, std::size_t slot) {
        const Index3 at = mNear[slot];
        const Index3 corner = mFirst + Index3{at.x * kSide, at.y * kSide, at.z * kSide};
        std::bitset<std::size_t(BrickField::kSamples)> near;
        for (const std::uint32_t p : mOf[slot]) {
            const Index3 local = voxelOf(mPoints[p]) - corner;
            for (int x = std::max(0, local.x - kReach); x <= std::min(kSide - 1, local.x + kReach); ++x)
                for (int y = std::max(0, local.y - kReach); y <= std::min(kSide - 1, local.y + kReach); ++y)
                    for (int z = std::max(0, local.z - kReach); z <= std::min(kSide - 1, local.z + kReach);
                         ++z)
                        near.set(std::size_t(sampleOf(x, y, z)));
        }
        Brick& values = mValues[slot];
        values.fill(kUnknown);
        for (int s = 0; s < BrickField::kSamples; ++s) {
            if (!near.test(std::size_t(s))) continue;
            const Index3 voxel = corner + Index3{s >> 6, (s >> 3) & 7, s & 7};
            const Vec3d place = Vec3d{double(voxel.x), double(voxel.y), double(voxel.z)} * mVoxel - mOrigin;
            const auto foot = surface.project(place);
            if (!foot) continue;
            const Vec3d away = place - foot->point;
            const double distance = length(away) / mVoxel;
            if (distance > kFar) continue;
            values[std::size_t(s)] = float(dot(away, foot->normal) < 0 ? -distance : distance);
        }
    }

    // Calls visit(a, b, value of a, value of b) for all neighbouring voxels of near bricks and all
    // neighbouring bricks of which one at least is far, as nodes.
    template <typename Visit>
    void eachPair(const Visit& visit) const {
        for (std::uint32_t brick = 0; brick < mSlot.size(); ++brick) {
            const Index3 at = latticeVoxel(brick, mBricks);
            for (int axis = 0; axis < 3; ++axis) {
                Index3 next = at;
                if (++next[axis] >= mBricks[axis]) next = at;
                const bool inside = !(next == at);
                pairsAlong(brick, inside ? std::ptrdiff_t(latticeIndex(next, mBricks)) : -1, axis, visit);
            }
        }
    }

    // Within a brick and to the next one along an axis.
    template <typename Visit>
    void pairsAlong(std::uint32_t brick, std::ptrdiff_t next, int axis, const Visit& visit) const {
        const std::int32_t slot = mSlot[brick], other = next < 0 ? -1 : mSlot[std::size_t(next)];
        if (slot < 0 && other < 0) {
            if (next >= 0) visit(brick, std::uint32_t(next), kUnknown, kUnknown);
            return;
        }
        const int stride = axis == 0 ? kSide * kSide : axis == 1 ? kSide : 1;
        const auto value = [&](std::int32_t of, int s) {
            return of < 0 ? kUnknown : mValues[std::size_t(of)][std::size_t(s)];
        };
        const auto node = [&](std::int32_t of, std::ptrdiff_t number, int s) {
            return of < 0 ? std::uint32_t(number) : nodeOf(std::size_t(of), s);
        };
        for (int s = 0; s < BrickField::kSamples; ++s) {
            const int along = s / stride % kSide;
            if (along + 1 < kSide) {
                if (slot >= 0)
                    visit(nodeOf(std::size_t(slot), s), nodeOf(std::size_t(slot), s + stride), value(slot, s),
                          value(slot, s + stride));
            } else if (next >= 0) {
                const int first = s - along * stride;
                visit(node(slot, brick, s), node(other, next, first), value(slot, s), value(other, first));
            }
        }
    }

    const std::vector<Vec3f>& mPoints;
    Vec3d mOrigin;
    double mVoxel;
    Index3 mFirst, mBricks;
    std::vector<std::int32_t> mSlot;  // [bricks] number among the near ones, -1: far
    std::vector<Index3> mNear;
    std::vector<std::vector<std::uint32_t>> mOf;  // [near] points
    std::vector<Brick> mValues;                   // [near]
    std::vector<float> mFarValue;                 // [bricks]
};

// With the model, on the lattice of the result.
void unite(LevelSet& result, const LevelSet& model, double halfWidth, const RunContext& ctx) {
    const FloatGridPtr other =
        resampleLevelSet(*model.grid, *result.grid, float(halfWidth), "the model", ctx);
    const FloatGridPtr united = openvdb::tools::csgUnionCopy(*result.grid, *other);
    united->setTransform(result.grid->transformPtr());
    result.grid = rebuildLevelSet(*united, float(halfWidth), "the result", ctx);
}

}  // namespace

LevelSet ontoLevelSet(const PatchedModel& patched, double voxelSize, double halfWidth,
                      const LevelSet* withModel, const RunContext& ctx) {
    const std::vector<Vec3f>& points = patched.result.sheet.points;
    if (points.empty()) throw Error(ErrorCode::EmptyInput, "no points lie over the model");
    if (!(voxelSize > 0)) throw Error(ErrorCode::InvalidOption, "`voxelSize` must be above 0");
    requireHalfWidth(halfWidth);
    return withThreads(ctx, [&] {
        PointBricks bricks(points, patched.origin, voxelSize);
        const std::string what = "a level set of the points", hint = "a larger `voxelSize` needs less";
        if (!(bricks.bricks() < 2e9)) throw Error(ErrorCode::Memory, what + " is too large; " + hint);
        requireMemory(ctx, 24 * bricks.bricks(), what, hint);
        bricks.sortPoints();
        const double samples = double(bricks.held()) * BrickField::kSamples;
        if (!(samples + bricks.bricks() < 4e9))
            throw Error(ErrorCode::Memory, what + " is too large; " + hint);
        requireMemory(ctx, 24 * bricks.bricks() + 20 * samples, what, hint);
        PointSetSurfaceOptions kind;
        kind.kernel = patched.exemplar.kernel;
        bricks.measure(PointSetSurface(points, patched.result.sheet.normals, kind, ctx), ctx);
        bricks.fill();
        RebuildOptions rebuild;
        rebuild.halfWidth = float(halfWidth);
        LevelSet model;
        model.grid = levelSetFrom(rebuiltBand(bricks.field(), rebuild, ctx), float(halfWidth), voxelSize,
                                  "the patched model", ctx);
        if (withModel) unite(model, *withModel, halfWidth, ctx);
        model.domain = solidBox(*model.grid, "the patched model");
        stampLevelSet(model);
        return model;
    });
}

}  // namespace vdbsynth
