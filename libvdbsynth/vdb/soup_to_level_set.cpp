// Solids from meshes that do not bound one: the sign is that of the generalised winding number, holes are
// closed where it is one half.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/winding_number.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/interrupter.h"
#include "libvdbsynth/vdb/mesh_conversion.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kSide = 8;
constexpr int kVoxels = kSide * kSide * kSide;
constexpr double kMargin = 0.2;     // a winding number this far from 1/2 is not near an opening
constexpr float kOpeningScale = 8;  // [voxels] that a change of the winding number by 1 counts as

// Distances to the faces, of voxels within `reach`.
openvdb::FloatGrid::Ptr unsignedDistance(const Mesh& indexMesh, float reach, const RunContext& ctx) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    for (const Vec3f& p : indexMesh.points) points.emplace_back(p.x, p.y, p.z);
    for (const Triangle& t : indexMesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    for (const Quad& q : indexMesh.quads) quads.emplace_back(q[0], q[1], q[2], q[3]);
    Interrupter interrupter(ctx);
    openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToUnsignedDistanceField<openvdb::FloatGrid>(
        static_cast<openvdb::util::NullInterrupter&>(interrupter),
        *openvdb::math::Transform::createLinearTransform(1.0), points, triangles, quads, reach);
    throwIfCancelled(ctx);
    return grid;
}

class Soup {
public:
    Soup(const Mesh& indexMesh, const WindingNumber& winding, const RunContext& ctx)
        : mMesh(indexMesh), mContext(ctx), mWinding(winding) {}

    // A field that is negative inside, its values distances near the faces; voxels where the index space of
    // the mesh has them.
    openvdb::FloatGrid::Ptr run() {
        mDistance = unsignedDistance(mMesh, kHalfWidth + 1, mContext);
        openvdb::CoordBBox box = mDistance->evalActiveVoxelBoundingBox();
        box.expand(2);
        mField = openvdb::FloatGrid::create(kHalfWidth);
        collect(box);
        fill();
        return mField;
    }

private:
    // Splits space into leaf-sized regions that need a look at their voxels and larger ones on one side.
    void collect(const openvdb::CoordBBox& box) {
        constexpr int kNode = 64;
        const auto floor = [](int v) { return v >= 0 ? v / kNode : -((-v + kNode - 1) / kNode); };
        std::vector<Index3> nodes;
        for (int x = floor(box.min().x()); x <= floor(box.max().x()); ++x)
            for (int y = floor(box.min().y()); y <= floor(box.max().y()); ++y)
                for (int z = floor(box.min().z()); z <= floor(box.max().z()); ++z)
                    nodes.push_back(Index3{x, y, z} * kNode);
        std::vector<Regions> found(nodes.size());
        parallelFor(mContext, nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) split(nodes[i], kNode, found[i]);
        });
        for (const Regions& regions : found) {
            mLeaves.insert(mLeaves.end(), regions.leaves.begin(), regions.leaves.end());
            for (const IndexBox& inside : regions.inside)
                mField->sparseFill(toBBox(inside), -kHalfWidth, /* active= */ false);
        }
    }

    struct Regions {
        std::vector<Index3> leaves;
        std::vector<IndexBox> inside;
    };

    void split(const Index3& corner, int side, Regions& regions) const {
        const bool faces = hasFaces(corner, side);
        if (!faces) {
            double low = 0, high = 0;
            cornerRange(corner, side, low, high);
            if (high < 0.5 - kMargin / 2) return;
            if (low > 0.5 + kMargin / 2) {
                regions.inside.push_back(IndexBox::cube(corner, side));
                return;
            }
        }
        if (side == kSide) {
            regions.leaves.push_back(corner);
            return;
        }
        const int half = side / 2;
        for (int c = 0; c < 8; ++c)
            split(corner + Index3{c & 4 ? half : 0, c & 2 ? half : 0, c & 1 ? half : 0}, half, regions);
    }

    // True if any voxel of the region lies in the faces' band.
    bool hasFaces(const Index3& corner, int side) const {
        const auto accessor = mDistance->getConstAccessor();
        for (int x = 0; x < side; x += kSide)
            for (int y = 0; y < side; y += kSide)
                for (int z = 0; z < side; z += kSide)
                    if (accessor.probeConstLeaf(toCoord(corner + Index3{x, y, z}))) return true;
        return false;
    }

    double windingAt(const Index3& p) const { return mWinding.at({double(p.x), double(p.y), double(p.z)}); }

    // Away from faces the winding number is harmonic: its extremes over a region are on its border, and its
    // corners and middle tell whether it comes near one half.
    void cornerRange(const Index3& corner, int side, double& low, double& high) const {
        const int far = side - 1;
        low = high = windingAt(corner + Index3{side / 2, side / 2, side / 2});
        for (int c = 0; c < 8; ++c) {
            const double w = windingAt(corner + Index3{c & 4 ? far : 0, c & 2 ? far : 0, c & 1 ? far : 0});
            low = std::min(low, w);
            high = std::max(high, w);
        }
    }

    void fill() {
        std::vector<std::unique_ptr<Leaf>> made(mLeaves.size());
        parallelFor(mContext, mLeaves.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) made[i] = fillLeaf(mLeaves[i]);
        });
        for (std::unique_ptr<Leaf>& leaf : made) mField->tree().addLeaf(leaf.release());
    }

    std::unique_ptr<Leaf> fillLeaf(const Index3& corner) const {
        std::array<float, kVoxels> distance;
        const auto accessor = mDistance->getConstAccessor();
        const Leaf* band = accessor.probeConstLeaf(toCoord(corner));
        for (int i = 0; i < kVoxels; ++i)
            distance[std::size_t(i)] =
                band ? std::min(band->getValue(openvdb::Index(i)), kHalfWidth) : kHalfWidth;
        auto leaf = std::make_unique<Leaf>(toCoord(corner), kHalfWidth, true);
        std::array<char, kVoxels> seen{};
        std::vector<int> part;
        for (int seed = 0; seed < kVoxels; ++seed) {
            if (seen[std::size_t(seed)]) continue;
            growPart(seed, distance, seen, part);
            signPart(corner, part, distance, *leaf);
        }
        return leaf;
    }

    // Voxels joined by steps that cannot cross a face: one as long as their two distances together or longer
    // would.
    static void growPart(int seed, const std::array<float, kVoxels>& distance,
                         std::array<char, kVoxels>& seen, std::vector<int>& part) {
        part.assign(1, seed);
        seen[std::size_t(seed)] = 1;
        for (std::size_t at = 0; at < part.size(); ++at)
            for (int axis = 0; axis < 3; ++axis)
                for (int sign = -1; sign <= 1; sign += 2) {
                    const int shift = axis == 0 ? 6 : axis == 1 ? 3 : 0;
                    const int place = (part[at] >> shift) & 7;
                    if (place + sign < 0 || place + sign >= kSide) continue;
                    const int other = part[at] + sign * (1 << shift);
                    if (seen[std::size_t(other)] ||
                        distance[std::size_t(other)] + distance[std::size_t(part[at])] <= 1.0001f)
                        continue;
                    seen[std::size_t(other)] = 1;
                    part.push_back(other);
                }
    }

    // All on the side of their most distant voxel, unless that is near an opening: then each by itself.
    void signPart(const Index3& corner, const std::vector<int>& part,
                  const std::array<float, kVoxels>& distance, Leaf& leaf) const {
        const auto place = [&](int i) { return corner + Index3{i >> 6, (i >> 3) & 7, i & 7}; };
        const int middle = *std::max_element(part.begin(), part.end(), [&](int a, int b) {
            return distance[std::size_t(a)] < distance[std::size_t(b)];
        });
        double low = windingAt(place(middle)), high = low;
        const double first = low;
        for (int end : {part.front(), part.back(), part[part.size() / 2]}) {
            if (end == middle) continue;
            const double w = windingAt(place(end));
            low = std::min(low, w);
            high = std::max(high, w);
        }
        const bool clear = low > 0.5 + kMargin || high < 0.5 - kMargin;
        for (int i : part) {
            const double w = clear ? first : i == middle ? first : windingAt(place(i));
            float value = distance[std::size_t(i)];
            if (!clear) value = std::min(value, std::max(1e-3f, kOpeningScale * float(std::abs(w - 0.5))));
            leaf.setValueOnly(openvdb::Index(i), w > 0.5 ? -value : value);
        }
    }

    const Mesh& mMesh;
    const RunContext& mContext;
    const WindingNumber& mWinding;
    openvdb::FloatGrid::Ptr mDistance, mField;
    std::vector<Index3> mLeaves;
};

}  // namespace

FloatGridPtr soupToField(const Mesh& indexMesh, const std::string& name, const RunContext& ctx) {
    const ThreadLimit limit(ctx);
    const WindingNumber winding(indexMesh, ctx);
    const double share = solidShare(indexMesh, winding);
    if (share < 0.5)
        throw Error(ErrorCode::Unusable,
                    name + ": a sheet with " + std::to_string(summarize(indexMesh).openEdges) +
                        " open edges: " + std::to_string(int(100 * (1 - share))) +
                        " % of its area bounds nothing; close the mesh or make a shell with --open shell "
                        "--thickness W");
    return behindWall(ErrorCode::Unusable, name,
                      [&] { return FloatGridPtr(Soup(indexMesh, winding, ctx).run()); });
}

FloatGridPtr sheetToField(const Mesh& indexMesh, double thickness, const RunContext& ctx) {
    const ThreadLimit limit(ctx);
    return behindWall(ErrorCode::Unusable, "faces", [&] {
        const float half = float(thickness / 2), reach = half + kHalfWidth + 1;
        openvdb::FloatGrid::Ptr grid = unsignedDistance(indexMesh, reach, ctx);
        for (auto it = grid->beginValueAll(); it; ++it) it.setValue(std::min(*it - half, kHalfWidth));
        grid->tree().root().setBackground(kHalfWidth, /* updateChildNodes= */ false);
        return FloatGridPtr(grid);
    });
}

}  // namespace vdbsynth
