// Nearest-face propagation on bricks. OpenVDB's own distance to a mesh tries all faces of all neighbours and
// was four fifths of a synthesis.
#include "libvdbsynth/distance/mesh_distance.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/mesh_distance_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using namespace nearest_face;

// Nearest faces, round by round. After seed() and each round:
// - mNow has for each voxel of a stored brick its nearest face so far with the exact distance to that face,
//   or kNone; a later round only ever makes it better (nearer, or of equally near the lower number);
// - mFresh marks the voxels that the last round changed: only they can improve a neighbour in the next one;
// - a round reads mNow and mFresh and writes mNext and mNextFresh, a brick each, so its result does not
//   depend on the order of bricks or threads.
// Stored bricks are those within halfWidth of some triangle's box; mSlots numbers them, x slowest.
class Propagation {
public:
    Propagation(const Mesh& mesh, const IndexBox& box, float halfWidth, const RunContext& ctx)
        : mMesh(mesh), mTriangles(triangulated(mesh)), mBox(box), mHalfWidth(halfWidth), mContext(ctx) {
        const Index3 size = box.size();
        mBricks = {(size.x + kSide - 1) / kSide, (size.y + kSide - 1) / kSide, (size.z + kSide - 1) / kSide};
        mSlots.assign(latticeCount(mBricks), -1);
        for (const Vec3f& p : mesh.points)
            for (int axis = 0; axis < 3; ++axis)
                mTolerance = std::max(mTolerance, 1e-4f + 2e-6f * std::abs(p[axis]));
        mDiscs.resize(mTriangles.size());
        parallelFor(ctx, mTriangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Triangle& t = mTriangles[i];
                mDiscs[i] = discAround(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
            }
        });
        collectBricks();
        collectFaces();
    }

    void propagate() {
        seed();
        const int rounds = int(std::ceil(mHalfWidth));
        mNext = mNow;
        mNextFresh.assign(mFresh.size(), 0);
        mNextChanged.assign(mChanged.size(), 0);
        for (int round = 0; round < rounds; ++round) {
            parallelFor(mContext, mOrigins.size(), 8, [&](std::size_t begin, std::size_t end) {
                Padded padded;
                for (std::size_t slot = begin; slot < end; ++slot) relax(slot, padded);
            });
            std::swap(mNow, mNext);
            std::swap(mFresh, mNextFresh);
            std::swap(mChanged, mNextChanged);
        }
    }

    BrickField distances() const {
        return BrickField::generate(mBox, mContext, [&](const IndexBox& brick, float* samples) {
            const std::int32_t slot = slotOf(brick.min);
            for (int i = 0; i < BrickField::kSamples; ++i)
                samples[i] =
                    slot < 0
                        ? mHalfWidth
                        : std::min(mHalfWidth,
                                   mNow[std::size_t(slot) * BrickField::kSamples + std::size_t(i)].distance);
        });
    }

    void forFaces(const std::function<void(const Index3&, const std::uint32_t*)>& visit) const {
        parallelFor(mContext, mOrigins.size(), 8, [&](std::size_t begin, std::size_t end) {
            std::uint32_t faces[BrickField::kSamples];
            for (std::size_t slot = begin; slot < end; ++slot) {
                for (std::size_t i = 0; i < BrickField::kSamples; ++i) {
                    const Nearest& nearest = mNow[slot * BrickField::kSamples + i];
                    faces[i] = nearest.distance <= mHalfWidth ? nearest.face : kNoFace;
                }
                visit(mOrigins[slot], faces);
            }
        });
    }

private:
    std::size_t brickIndex(const Index3& b) const { return latticeIndex(b, mBricks); }
    std::int32_t slotOf(const Index3& p) const {
        if (!mBox.contains(p)) return -1;
        const Index3 l = p - mBox.min;
        return mSlots[brickIndex({l.x / kSide, l.y / kSide, l.z / kSide})];
    }
    // Bricks that a triangle's box, grown by `reach`, touches.
    IndexBox bricksNear(const Triangle& t, float reach) const {
        IndexBox bricks;
        for (int axis = 0; axis < 3; ++axis) {
            const float a = mMesh.points[t[0]][axis], b = mMesh.points[t[1]][axis],
                        c = mMesh.points[t[2]][axis];
            const float low = std::min({a, b, c}) - reach - float(mBox.min[axis]),
                        high = std::max({a, b, c}) + reach - float(mBox.min[axis]);
            bricks.min[axis] = std::max(0, int(std::floor(low / kSide)));
            bricks.max[axis] = std::min(mBricks[axis] - 1, int(std::floor(high / kSide)));
        }
        return bricks;
    }
    void collectBricks() {
        for (const Triangle& t : mTriangles)
            forEachVoxel(bricksNear(t, mHalfWidth), [&](const Index3& b) { mSlots[brickIndex(b)] = 0; });
        forEachVoxel(IndexBox::fromSize(mBricks), [&](const Index3& b) {
            std::int32_t& slot = mSlots[brickIndex(b)];
            if (slot < 0) return;
            slot = std::int32_t(mOrigins.size());
            mOrigins.push_back(mBox.min + b * kSide);
        });
        mNow.assign(mOrigins.size() * BrickField::kSamples, Nearest{});
        mFresh.assign(mNow.size(), 0);
        mChanged.assign(mOrigins.size(), 0);
    }

    // For each brick the faces within a voxel of it, in their order.
    void collectFaces() {
        std::vector<std::size_t> next(mOrigins.size() + 1, 0);
        const auto slotAt = [&](const Index3& b) { return std::size_t(mSlots[brickIndex(b)]); };
        for (const Triangle& t : mTriangles)
            forEachVoxel(bricksNear(t, 1.f), [&](const Index3& b) { ++next[slotAt(b) + 1]; });
        for (std::size_t slot = 1; slot < next.size(); ++slot) next[slot] += next[slot - 1];
        mFirstFace = next;
        mFaces.resize(next.back());
        for (std::uint32_t i = 0; i < mTriangles.size(); ++i)
            forEachVoxel(bricksNear(mTriangles[i], 1.f),
                         [&](const Index3& b) { mFaces[next[slotAt(b)]++] = i; });
    }

    float distance(const Index3& p, std::uint32_t face) const {
        const Triangle& t = mTriangles[face];
        const Vec3f& a = mMesh.points[t[0]];
        return std::sqrt(squaredDistance(Vec3f{float(p.x), float(p.y), float(p.z)} - a,
                                         mMesh.points[t[1]] - a, mMesh.points[t[2]] - a));
    }

    void seed() {
        parallelFor(mContext, mOrigins.size(), 8, [&](std::size_t begin, std::size_t end) {
            for (std::size_t slot = begin; slot < end; ++slot)
                for (std::size_t f = mFirstFace[slot]; f < mFirstFace[slot + 1]; ++f) {
                    const std::uint32_t face = mFaces[f];
                    IndexBox reach;
                    for (int axis = 0; axis < 3; ++axis) {
                        const Triangle& t = mTriangles[face];
                        const float a = mMesh.points[t[0]][axis], b = mMesh.points[t[1]][axis],
                                    c = mMesh.points[t[2]][axis];
                        reach.min[axis] = int(std::ceil(std::min({a, b, c}) - 1));
                        reach.max[axis] = int(std::floor(std::max({a, b, c}) + 1));
                    }
                    reach = reach.intersection(IndexBox::cube(mOrigins[slot], kSide));
                    const Triangle& t = mTriangles[face];
                    const Vec3f a = mMesh.points[t[0]], ab = mMesh.points[t[1]] - a,
                                ac = mMesh.points[t[2]] - a;
                    const Disc disc = mDiscs[face];
                    Nearest* brick = &mNow[slot * BrickField::kSamples];
                    for (int x = reach.min.x; x <= reach.max.x; ++x)
                        for (int y = reach.min.y; y <= reach.max.y; ++y)
                            for (int z = reach.min.z; z <= reach.max.z; ++z) {
                                const Index3 l = Index3{x, y, z} - mOrigins[slot];
                                Nearest& here = brick[(l.x * kSide + l.y) * kSide + l.z];
                                mFresh[slot * BrickField::kSamples + std::size_t(&here - brick)] = 1;
                                mChanged[slot] = 1;
                                const Vec3f p{float(x), float(y), float(z)};
                                if (isBeyond(disc, p, std::min(here.distance, 2.f) + mTolerance)) continue;
                                const Nearest candidate{std::sqrt(squaredDistance(p - a, ab, ac)), face};
                                if (better(candidate, here)) here = candidate;
                            }
                }
        });
    }

    // The brick with one layer of its neighbours around it; of those only what the last round changed, since
    // the rest was tried when it was new. False if there is nothing to try.
    bool pad(std::size_t slot, Padded& padded) const {
        const Index3 origin = mOrigins[slot];
        bool any = false;
        forEachVoxel({{-1, -1, -1}, {1, 1, 1}}, [&](const Index3& side) {
            const bool own = side == Index3{0, 0, 0};
            const std::int32_t from = own ? std::int32_t(slot) : slotOf(origin + side * kSide);
            if (from < 0 || !mChanged[std::size_t(from)]) return;
            if (!any) {
                std::fill(std::begin(padded.distance), std::end(padded.distance), kFar);
                std::fill(std::begin(padded.row), std::end(padded.row), false);
            }
            any = true;
            padFrom(std::size_t(from), side, padded);
        });
        return any;
    }

    // The part of a padded brick that lies in one of the 27 bricks.
    void padFrom(std::size_t from, const Index3& side, Padded& padded) const {
        const auto first = [](int d) { return d > 0 ? kSide : d; };
        const auto last = [](int d) { return d < 0 ? -1 : d > 0 ? kSide : kSide - 1; };
        for (int x = first(side.x); x <= last(side.x); ++x)
            for (int y = first(side.y); y <= last(side.y); ++y) {
                const std::size_t row =
                    from * BrickField::kSamples + std::size_t(((x & 7) * kSide + (y & 7)) * kSide);
                const int to = (x + 1) * kPadded + y + 1;
                for (int z = first(side.z); z <= last(side.z); ++z) {
                    if (!mFresh[row + std::size_t(z & 7)]) continue;
                    const Nearest& there = mNow[row + std::size_t(z & 7)];
                    padded.distance[to * kPadded + z + 1] = there.distance;
                    padded.face[to * kPadded + z + 1] = there.face;
                    padded.row[to] = true;
                }
            }
    }

    // mNext holds what mNow held a round ago: only what has changed since is copied.
    void relax(std::size_t slot, Padded& padded) {
        const std::size_t base = slot * BrickField::kSamples;
        if (mChanged[slot]) std::copy_n(&mNow[base], BrickField::kSamples, &mNext[base]);
        if (mNextChanged[slot]) std::fill_n(&mNextFresh[base], BrickField::kSamples, std::uint8_t(0));
        mNextChanged[slot] = 0;
        if (!pad(slot, padded)) return;
        for (int x = 0; x < kSide; ++x)
            for (int y = 0; y < kSide; ++y) {
                const int row = (x + 1) * kPadded + y + 1;
                bool any = false;
                for (const int beside : {-kPadded, 0, kPadded})
                    any = any || padded.row[row + beside - 1] || padded.row[row + beside] ||
                          padded.row[row + beside + 1];
                if (any) relaxRow(slot, {x, y, 0}, row * kPadded + 1, padded);
            }
    }

    void relaxRow(std::size_t slot, const Index3& first, int centre, const Padded& padded) {
        const std::size_t begin =
            slot * BrickField::kSamples + std::size_t((first.x * kSide + first.y) * kSide);
        std::uint32_t steps[kSide];
        worthTrying(padded, centre, &mNext[begin], mHalfWidth, steps);
        for (int z = 0; z < kSide; ++z) {
            if (!steps[z]) continue;
            const Index3 p = mOrigins[slot] + first + Index3{0, 0, z};
            if (!relaxOne(p, padded, centre + z, steps[z], mNext[begin + std::size_t(z)])) continue;
            mNextFresh[begin + std::size_t(z)] = 1;
            mNextChanged[slot] = 1;
        }
    }

    // Tries the faces of those neighbours whose bits are set on a voxel; true if one is nearer.
    bool relaxOne(const Index3& p, const Padded& around, int centre, std::uint32_t steps,
                  Nearest& best) const {
        const std::uint32_t before = best.face;
        FacesTried tried;
        for (; steps; steps &= steps - 1) {
            const Step& step = neighbourSteps()[std::size_t(__builtin_ctz(steps))];
            const std::uint32_t face = around.face[centre + step.offset];
            if (face == best.face || around.distance[centre + step.offset] > best.distance ||
                !tried.add(face))
                continue;
            if (isBeyond(mDiscs[face], {float(p.x), float(p.y), float(p.z)},
                         std::min(best.distance, mHalfWidth + 1) + mTolerance))
                continue;
            const Nearest candidate{distance(p, face), face};
            if (better(candidate, best)) best = candidate;
        }
        return best.face != before;
    }

    const Mesh& mMesh;
    std::vector<Triangle> mTriangles;
    std::vector<Disc> mDiscs;
    float mTolerance = 1e-4f;  // what the floats of a disc may be wrong by
    IndexBox mBox;
    float mHalfWidth;
    const RunContext& mContext;
    Index3 mBricks;
    std::vector<std::int32_t> mSlots;
    std::vector<Index3> mOrigins;
    std::vector<std::size_t> mFirstFace;  // [slots + 1] where each brick's begin
    std::vector<std::uint32_t> mFaces;    // [slot by slot]
    std::vector<Nearest> mNow, mNext;
    std::vector<std::uint8_t> mFresh, mNextFresh;      // changed in the last round
    std::vector<std::uint8_t> mChanged, mNextChanged;  // by brick: any of its voxels has
};

}  // namespace

BrickField meshDistance(const Mesh& mesh, const IndexBox& box, float halfWidth, const RunContext& ctx) {
    Propagation propagation(mesh, box, halfWidth, ctx);
    propagation.propagate();
    return propagation.distances();
}

void forNearestFaces(const Mesh& mesh, const IndexBox& box, float halfWidth, const RunContext& ctx,
                     const std::function<void(const Index3&, const std::uint32_t*)>& visit) {
    Propagation propagation(mesh, box, halfWidth, ctx);
    propagation.propagate();
    propagation.forFaces(visit);
}

}  // namespace vdbsynth
