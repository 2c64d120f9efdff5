// Nearest-face propagation on bricks. OpenVDB's own distance to a mesh tries all faces of all neighbours and
// was four fifths of a synthesis.
#include "libvdbsynth/distance/mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;
constexpr int kPadded = kSide + 2;
constexpr float kFar = std::numeric_limits<float>::max();

struct Nearest {
    float distance = kFar;
    std::uint32_t face = kNoFace;
};
constexpr Nearest kNone;

// What a triangle lies in: a disc, with which most triangles are refused at a fraction of their distance's
// cost.
struct Disc {
    Vec3f centre;
    float radius = 0;
    Vec3f normal;  // of length 1, or 0 for a triangle without area: its disc is a ball
};

Disc discAround(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    Disc disc;
    disc.centre = (a + b + c) * (1.f / 3);
    disc.radius = std::max({length(a - disc.centre), length(b - disc.centre), length(c - disc.centre)});
    const Vec3f normal = cross(b - a, c - a);
    const float size = length(normal);
    // A sliver's normal is noise.
    if (size > 1e-2f * disc.radius * disc.radius) disc.normal = normal * (1 / size);
    return disc;
}

// True if the disc is further away from p than `limit`; never true for one that is nearer.
bool isBeyond(const Disc& disc, const Vec3f& p, float limit) {
    const Vec3f offset = p - disc.centre;
    const float height = dot(offset, disc.normal), across = dot(offset, offset) - height * height;
    const float room = limit * limit - height * height;
    if (room < 0) return true;
    const float reach = std::sqrt(room) + disc.radius;
    return across > reach * reach;
}

// A step to one of the 26 neighbours, the near ones first: they bring the answer, the others are then
// skipped.
struct Step {
    int offset;  // in a padded brick
    float length;
};

const std::array<Step, 26>& neighbourSteps() {
    static const std::array<Step, 26> steps = [] {
        std::array<Step, 26> made{};
        std::size_t n = 0;
        for (int far = 1; far <= 3; ++far)
            for (const Index3& s : kAllNeighbours)
                if (s.x * s.x + s.y * s.y + s.z * s.z == far)
                    made[n++] = {(s.x * kPadded + s.y) * kPadded + s.z, std::sqrt(float(far)) + 1e-5f};
        return made;
    }();
    return steps;
}

// A brick and one layer around it; kFar where nothing is to be tried.
struct Padded {
    float distance[kPadded * kPadded * kPadded];
    std::uint32_t face[kPadded * kPadded * kPadded] = {};
    bool row[kPadded * kPadded];  // rows along z with something to be tried
};

// For each voxel of a row the neighbours, by bit, whose faces may be nearer than its own: a face cannot be
// nearer here than its distance there less the step.
__attribute__((target_clones("avx2", "default"))) void worthTrying(const Padded& around, int centre,
                                                                   const Nearest* row, float halfWidth,
                                                                   std::uint32_t* steps) {
    float limit[kSide];
    std::uint32_t own[kSide];
    for (int z = 0; z < kSide; ++z) {
        // seed() tried every face within one voxel.
        limit[z] = row[z].distance < 0.999f ? -kFar : std::min(row[z].distance, halfWidth);
        own[z] = row[z].face;
        steps[z] = 0;
    }
    if (*std::max_element(limit, limit + kSide) < 0) return;
    std::uint32_t bit = 1;
    for (const Step& step : neighbourSteps()) {
        const float* distance = around.distance + centre + step.offset;
        const std::uint32_t* face = around.face + centre + step.offset;
        for (int z = 0; z < kSide; ++z) steps[z] |= distance[z] <= limit[z] && face[z] != own[z] ? bit : 0;
        bit <<= 1;
    }
}

bool better(const Nearest& a, const Nearest& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
}

// Squared distance to the triangle a, b, c [ericson2005, section 5.1.5] of a point that lies at a + ap; all
// that is computed is of a voxel's size, so that floats do.
float squaredDistance(const Vec3f& ap, const Vec3f& ab, const Vec3f& ac) {
    const auto squaredAt = [&](float v, float w) {
        const Vec3f offset = ap - ab * v - ac * w;
        return dot(offset, offset);
    };
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squaredAt(0, 0);
    const float bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
    const float d3 = d1 - bb, d4 = d2 - bc;
    if (d3 >= 0 && d4 <= d3) return squaredAt(1, 0);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squaredAt(d1 > d3 ? d1 / (d1 - d3) : 0.f, 0);
    const float d5 = d1 - bc, d6 = d2 - cc;
    if (d6 >= 0 && d5 <= d6) return squaredAt(0, 1);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squaredAt(0, d2 > d6 ? d2 / (d2 - d6) : 0.f);
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const float sum = (d4 - d3) + (d5 - d6);
        const float w = sum > 0 ? (d4 - d3) / sum : 0.f;
        return squaredAt(1 - w, w);
    }
    const float area = va + vb + vc;
    if (!(area > 0)) return std::min({squaredAt(0, 0), squaredAt(1, 0), squaredAt(0, 1)});
    // A sliver's rounding may lead outside it.
    const float v = std::clamp(vb / area, 0.f, 1.f);
    return squaredAt(v, std::clamp(vc / area, 0.f, 1 - v));
}

// The faces that were tried on one voxel.
class FacesTried {
public:
    /// False if the face was there already.
    bool add(std::uint32_t face) {
        const std::uint64_t bit = std::uint64_t(1) << (face & 63);
        if (mBits & bit)
            for (int i = 0; i < mCount; ++i)
                if (mFaces[i] == face) return false;
        mBits |= bit;
        mFaces[mCount++] = face;
        return true;
    }

private:
    std::uint64_t mBits = 0;
    int mCount = 0;
    std::uint32_t mFaces[26];
};

// Nearest faces, round by round. After seed() and each round:
// - mNow has for each voxel of a stored brick its nearest face so far with the exact distance to that face,
// or
//   kNone; a later round only ever makes it better (nearer, or of equally near the lower number);
// - mFresh marks the voxels that the last round changed: only they can improve a neighbour in the next one;
// - a round reads mNow and mFresh and writes mNext and mNextFresh, a brick each, so its result does not
// depend
//   on the order of bricks or threads.
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
