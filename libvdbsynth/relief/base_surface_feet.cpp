// The nearest points of a surface, spread from sample to sample [danielsson1980].
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/base_surface_steps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide, kSamples = BrickField::kSamples;
constexpr int kPadded = kSide + 2, kPlane = kPadded * kPadded;
constexpr float kNowhere = 1e15f;    // coordinate of a foot that is not known
constexpr float kSeedReach = 1.5f;   // [samples] from the surface that feet start from
constexpr float kOffSurface = 0.3f;  // [voxels] that a step along the gradient may miss the surface by

// Nearest points of the surface [samples] so far, of a brick's samples.
struct Feet {
    float x[kSamples], y[kSamples], z[kSamples], squared[kSamples];
};

// The same of a brick and one layer around it.
struct PaddedFeet {
    float x[kPlane * kPadded], y[kPlane * kPadded], z[kPlane * kPadded], squared[kPlane * kPadded];
};

// Every sample tries the feet of all 26 neighbours, in an order in which one way through the brick takes a
// foot to all samples that lie in its direction: planes upward, then downward, in each the rows to and fro.
__attribute__((target_clones("avx2", "default"))) void sweep(PaddedFeet& f, const Index3& origin) {
    for (int way = 0; way < 4 * kSide * kSide; ++way) {
        const bool down = way >= 2 * kSide * kSide, back = way / kSide % 2;
        const int plane = way / (2 * kSide) % kSide, line = way % kSide;
        const int x = down ? kSide - plane : plane + 1, y = back ? kSide - line : line + 1;
        const int row = x * kPlane + y * kPadded + 1;
        const float px = float(origin.x + x - 1), py = float(origin.y + y - 1);
        // Three of the row before, nine of the plane before.
        for (int source = 0; source < (back ? 3 : 12); ++source) {
            const int beside = source < 3 ? (back ? kPadded : -kPadded)
                                          : (down ? kPlane : -kPlane) + (source / 3 - 2) * kPadded;
            const int from = row + beside + source % 3 - 1;
            float gx[kSide], gy[kSide], gz[kSide];
            for (int k = 0; k < kSide; ++k) {
                gx[k] = f.x[from + k];
                gy[k] = f.y[from + k];
                gz[k] = f.z[from + k];
            }
            for (int k = 0; k < kSide; ++k) {
                const float dx = gx[k] - px, dy = gy[k] - py, dz = gz[k] - float(origin.z + k);
                const float squared = dx * dx + dy * dy + dz * dz, own = f.squared[row + k];
                const bool nearer = squared < own;
                f.x[row + k] = nearer ? gx[k] : f.x[row + k];
                f.y[row + k] = nearer ? gy[k] : f.y[row + k];
                f.z[row + k] = nearer ? gz[k] : f.z[row + k];
                f.squared[row + k] = nearer ? squared : own;
            }
        }
        for (int n = 0; n < 2 * kSide; ++n) {
            const int k = n < kSide ? n : 2 * kSide - 1 - n, to = row + k, from = n < kSide ? to - 1 : to + 1;
            const float dx = f.x[from] - px, dy = f.y[from] - py, dz = f.z[from] - float(origin.z + k);
            const float squared = dx * dx + dy * dy + dz * dz;
            if (squared >= f.squared[to]) continue;
            f.x[to] = f.x[from];
            f.y[to] = f.y[from];
            f.z[to] = f.z[from];
            f.squared[to] = squared;
        }
    }
}

// The zero level's point nearest to a voxel, about: a step along the gradient and one that mends it; where
// that leads astray, the nearest crossing of an edge. @return false if there is neither
bool footOf(const BrickField& field, const Index3& voxel, Vec3f& foot) {
    const Vec3f place{float(voxel.x), float(voxel.y), float(voxel.z)};
    const float value = field.at(voxel);
    Vec3f gradient, crossing;
    float nearest = 2;
    for (int axis = 0; axis < 3; ++axis) {
        float beside[2];
        for (const int side : {0, 1}) {
            Index3 p = voxel;
            p[axis] += 2 * side - 1;
            beside[side] = field.at(p);
            const float share = value / (value - beside[side]);
            if ((beside[side] < 0) == (value < 0) || share >= nearest) continue;
            nearest = share;
            crossing = place;
            crossing[axis] += float(2 * side - 1) * share;
        }
        gradient[axis] = (beside[1] - beside[0]) / 2;
    }
    const float squared = dot(gradient, gradient);
    if (squared > 0.05f) {
        foot = place - gradient * (value / squared);
        const float missed = sampleTrilinear(field, foot);
        foot = foot - gradient * (missed / squared);
        if (std::abs(missed) < kOffSurface) return true;
    }
    foot = crossing;
    return nearest <= 1;
}

class Spreading {
public:
    Spreading(const BrickField& field, int step, float known, float reach, const RunContext& ctx)
        : mField(field), mStep(step), mReach(reach), mContext(ctx), mBox(latticeBox(field.box(), step)) {
        // A surface that is cut goes on beyond the box; whole objects have nothing there.
        mBox = mBox.expanded((int(std::ceil(reach)) + 2 + 7) & ~7);
        const Index3 size = mBox.size();
        mBricks = {(size.x + 7) / kSide, (size.y + 7) / kSide, (size.z + 7) / kSide};
        mSlots.assign(latticeCount(mBricks), -1);
        seed(std::max(0.9f, std::min(kSeedReach * float(step), known - 1)));
    }

    void spread() {
        std::vector<std::size_t> bricks;
        for (std::size_t brick = 0; brick < mSlots.size(); ++brick)
            if (mSlots[brick] >= 0) bricks.push_back(brick);
        for (bool first = true; !bricks.empty(); first = false) {
            std::vector<std::unique_ptr<Feet>> made(bricks.size());
            parallelFor(mContext, bricks.size(), 8, [&](std::size_t begin, std::size_t end) {
                PaddedFeet padded;
                for (std::size_t i = begin; i < end; ++i) made[i] = relaxed(bricks[i], first, padded);
            });
            std::vector<std::size_t> changed;
            for (std::size_t i = 0; i < bricks.size(); ++i) {
                if (!made[i]) continue;
                changed.push_back(bricks[i]);
                std::int32_t& slot = mSlots[bricks[i]];
                if (slot < 0) {
                    slot = std::int32_t(mFeet.size());
                    mFeet.emplace_back();
                }
                mFeet[std::size_t(slot)] = std::move(made[i]);
            }
            bricks = beside(changed);
        }
    }

    // Distances without signs [voxels].
    BrickField distances() const {
        const float step = float(mStep), limit = mReach * step;
        return BrickField::generate(mBox, mContext, [&](const IndexBox& brick, float* samples) {
            const Index3 l = brick.min - mBox.min;
            const std::int32_t slot = mSlots[latticeIndex({l.x / kSide, l.y / kSide, l.z / kSide}, mBricks)];
            for (int i = 0; i < kSamples; ++i)
                samples[i] = slot < 0
                                 ? limit
                                 : std::min(limit, step * std::sqrt(mFeet[std::size_t(slot)]->squared[i]));
        });
    }

private:
    Index3 originOf(std::size_t brick) const { return mBox.min + latticeVoxel(brick, mBricks) * kSide; }

    void seed(float within) {
        constexpr std::size_t kGrain = 64;
        std::vector<std::unique_ptr<Feet>> made(mSlots.size());
        parallelFor(mContext, mSlots.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            Feet feet;
            for (std::size_t brick = begin; brick < end; ++brick)
                if (seeded(brick, within, feet)) made[brick] = std::make_unique<Feet>(feet);
        });
        for (std::size_t brick = 0; brick < made.size(); ++brick) {
            if (!made[brick]) continue;
            mSlots[brick] = std::int32_t(mFeet.size());
            mFeet.push_back(std::move(made[brick]));
        }
    }

    bool seeded(std::size_t brick, float within, Feet& feet) const {
        const Index3 origin = originOf(brick);
        float constant = 0;
        if (mField.constantIn({origin * mStep, (origin + Index3{7, 7, 7}) * mStep}, constant)) return false;
        clear(feet);
        bool any = false;
        int i = 0;
        forEachVoxel(IndexBox::cube(origin, kSide), [&](const Index3& p) {
            Vec3f foot;
            if (mBox.contains(p) && std::abs(mField.at(p * mStep)) <= within &&
                footOf(mField, p * mStep, foot)) {
                foot = foot * (1 / float(mStep));
                const Vec3f apart = foot - Vec3f{float(p.x), float(p.y), float(p.z)};
                feet.x[i] = foot.x;
                feet.y[i] = foot.y;
                feet.z[i] = foot.z;
                feet.squared[i] = dot(apart, apart);
                any = true;
            }
            ++i;
        });
        return any;
    }

    // Samples farther away than the reach take no foot.
    void clear(Feet& feet) const {
        for (float* part : {feet.x, feet.y, feet.z}) std::fill_n(part, kSamples, kNowhere);
        std::fill_n(feet.squared, kSamples, mReach * mReach);
    }

    // Bricks with one of these for a neighbour, in their order.
    std::vector<std::size_t> beside(const std::vector<std::size_t>& changed) const {
        std::vector<std::size_t> bricks;
        const IndexBox all = IndexBox::fromSize(mBricks);
        for (const std::size_t brick : changed) {
            const Index3 at = latticeVoxel(brick, mBricks);
            forEachVoxel(IndexBox{at, at}.expanded(1).intersection(all),
                         [&](const Index3& b) { bricks.push_back(latticeIndex(b, mBricks)); });
        }
        std::sort(bricks.begin(), bricks.end());
        bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
        return bricks;
    }

    void pad(const Index3& at, PaddedFeet& padded) const {
        for (float* part : {padded.x, padded.y, padded.z}) std::fill_n(part, kPlane * kPadded, kNowhere);
        std::fill_n(padded.squared, kPlane * kPadded, mReach * mReach);
        const IndexBox all = IndexBox::fromSize(mBricks);
        forEachVoxel({{-1, -1, -1}, {1, 1, 1}}, [&](const Index3& side) {
            if (!all.contains(at + side)) return;
            const std::int32_t slot = mSlots[latticeIndex(at + side, mBricks)];
            if (slot < 0) return;
            const Feet& from = *mFeet[std::size_t(slot)];
            const auto first = [](int d) { return d > 0 ? kSide : d; };
            const auto count = [](int d) { return d == 0 ? kSide : 1; };
            for (int i = 0; i < count(side.x); ++i)
                for (int j = 0; j < count(side.y); ++j) {
                    const int x = first(side.x) + i, y = first(side.y) + j, z = first(side.z);
                    const int source = ((x & 7) * kSide + (y & 7)) * kSide + (z & 7);
                    const int to = (x + 1) * kPlane + (y + 1) * kPadded + z + 1;
                    std::copy_n(from.x + source, count(side.z), padded.x + to);
                    std::copy_n(from.y + source, count(side.z), padded.y + to);
                    std::copy_n(from.z + source, count(side.z), padded.z + to);
                    std::copy_n(from.squared + source, count(side.z), padded.squared + to);
                }
        });
    }

    // Null if no sample of the brick has a nearer foot than before.
    std::unique_ptr<Feet> relaxed(std::size_t brick, bool first, PaddedFeet& padded) const {
        const Index3 origin = originOf(brick);
        pad(latticeVoxel(brick, mBricks), padded);
        if (!first && !entered(padded, origin)) return nullptr;
        sweep(padded, origin);
        auto made = std::make_unique<Feet>();
        for (int row = 0; row < kSide * kSide; ++row) {
            const int from = (row / kSide + 1) * kPlane + (row % kSide + 1) * kPadded + 1, to = row * kSide;
            std::copy_n(padded.x + from, kSide, made->x + to);
            std::copy_n(padded.y + from, kSide, made->y + to);
            std::copy_n(padded.z + from, kSide, made->z + to);
            std::copy_n(padded.squared + from, kSide, made->squared + to);
        }
        return made;
    }

    // True if a foot beside the brick is nearer to the sample inside than its own.
    static bool entered(const PaddedFeet& f, const Index3& origin) {
        constexpr int kStride[3] = {kPlane, kPadded, 1};
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side)
                for (int i = 1; i <= kSide; ++i)
                    for (int j = 1; j <= kSide; ++j) {
                        Index3 p;
                        p[axis] = side ? kSide : 1;
                        p[(axis + 1) % 3] = i;
                        p[(axis + 2) % 3] = j;
                        const int to = p.x * kPlane + p.y * kPadded + p.z;
                        const int from = to + (side ? kStride[axis] : -kStride[axis]);
                        const Index3 at = origin + p - Index3{1, 1, 1};
                        const float dx = f.x[from] - float(at.x), dy = f.y[from] - float(at.y),
                                    dz = f.z[from] - float(at.z);
                        if (dx * dx + dy * dy + dz * dz < f.squared[to]) return true;
                    }
        return false;
    }

    const BrickField& mField;
    int mStep;
    float mReach;  // [samples]
    const RunContext& mContext;
    IndexBox mBox;
    Index3 mBricks;
    std::vector<std::int32_t> mSlots;
    std::vector<std::unique_ptr<Feet>> mFeet;
};

}  // namespace

BrickField unsignedDistances(const BrickField& field, int step, float known, float reach,
                             const RunContext& ctx) {
    Spreading spreading(field, step, known, reach / float(step), ctx);
    spreading.spread();
    return spreading.distances();
}

}  // namespace vdbsynth
