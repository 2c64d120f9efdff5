// Solids from meshes that are not watertight: the sign is that of the generalised winding number, holes are
// closed where it is one half.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/winding_field.h"
#include "libvdbsynth/distance/winding_number.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set_steps.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/wall.h"

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
constexpr Index3 kSize{kSide, kSide, kSide};

// Distances to the faces, for voxels within `reach`.
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

    // A field that is negative inside, its values distances near the faces, in the voxels
    // of the mesh's index space.
    BrickField run() {
        mDistance = unsignedDistance(mMesh, kHalfWidth + 1, mContext);
        openvdb::CoordBBox box = mDistance->evalActiveVoxelBoundingBox();
        box.expand(2);
        WindingFieldSource source;
        source.hasSurface = [this](const Index3& corner, int side) { return hasFaces(corner, side); };
        source.winding = [this](const Index3& p) { return windingAt(p); };
        source.fill = [this](const Index3& corner, float* values) { fillLeaf(corner, values); };
        return windingField(fromBBox(box), kHalfWidth, source, mContext);
    }

private:
    bool hasFaces(const Index3& corner, int side) const {
        const auto accessor = mDistance->getConstAccessor();
        for (int x = 0; x < side; x += kSide)
            for (int y = 0; y < side; y += kSide)
                for (int z = 0; z < side; z += kSide)
                    if (accessor.probeConstLeaf(toCoord(corner + Index3{x, y, z}))) return true;
        return false;
    }

    double windingAt(const Index3& p) const { return mWinding.at({double(p.x), double(p.y), double(p.z)}); }

    void fillLeaf(const Index3& corner, float* values) const {
        std::array<float, kVoxels> distance;
        const auto accessor = mDistance->getConstAccessor();
        const Leaf* band = accessor.probeConstLeaf(toCoord(corner));
        for (int i = 0; i < kVoxels; ++i)
            distance[std::size_t(i)] =
                band ? std::min(band->getValue(openvdb::Index(i)), kHalfWidth) : kHalfWidth;
        std::array<char, kVoxels> seen{};
        std::vector<int> part;
        for (int seed = 0; seed < kVoxels; ++seed) {
            if (seen[std::size_t(seed)]) continue;
            growPart(seed, distance, seen, part);
            signPart(corner, part, distance, values);
        }
    }

    // Voxels connected by steps that cannot cross a face: a crossing step would be at least as long as their
    // two distances together.
    static void growPart(int seed, const std::array<float, kVoxels>& distance,
                         std::array<char, kVoxels>& seen, std::vector<int>& part) {
        part.assign(1, seed);
        seen[std::size_t(seed)] = 1;
        for (std::size_t at = 0; at < part.size(); ++at) {
            const std::size_t from = std::size_t(part[at]);
            const Index3 voxel = latticeVoxel(from, kSize);
            for (const Index3& step : kFaceNeighbours) {
                const Index3 place = voxel + step;
                if (!IndexBox::fromSize(kSize).contains(place)) continue;
                const std::size_t other = latticeIndex(place, kSize);
                if (seen[other] || distance[other] + distance[from] <= 1.0001f) continue;
                seen[other] = 1;
                part.push_back(int(other));
            }
        }
    }

    // All take the sign of their most distant voxel, unless that is near an opening: then
    // each is evaluated separately.
    void signPart(const Index3& corner, const std::vector<int>& part,
                  const std::array<float, kVoxels>& distance, float* values) const {
        const auto place = [&](int i) { return corner + latticeVoxel(std::size_t(i), kSize); };
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
        const bool clear = low > 0.5 + kWindingMargin || high < 0.5 - kWindingMargin;
        for (int i : part) {
            const double w = clear ? first : i == middle ? first : windingAt(place(i));
            float value = distance[std::size_t(i)];
            if (!clear) value = std::min(value, openingDistance(w, kHalfWidth));
            values[i] = w > 0.5 ? -value : value;
        }
    }

    const Mesh& mMesh;
    const RunContext& mContext;
    const WindingNumber& mWinding;
    openvdb::FloatGrid::Ptr mDistance;
};

}  // namespace

BrickField soupToField(const Mesh& indexMesh, const std::string& name, const RunContext& ctx) {
    const WindingNumber winding(indexMesh, ctx);
    const double share = solidShare(indexMesh, winding);
    if (share < 0.5)
        throw Error(ErrorCode::Unusable, name + ": a sheet with " +
                                             countText(summarize(indexMesh).openEdges, "open edge") + ": " +
                                             std::to_string(int(100 * (1 - share))) +
                                             " % of its area encloses nothing; close the mesh or make a "
                                             "shell with `open` shell and a `thickness`");
    return withThreads(ctx, [&] {
        return behindWall(ErrorCode::Unusable, name, [&] { return Soup(indexMesh, winding, ctx).run(); });
    });
}

BrickField sheetToField(const Mesh& indexMesh, double thickness, const RunContext& ctx) {
    return behindWall(ErrorCode::Unusable, "faces", [&] {
        const float half = float(thickness / 2), reach = half + kHalfWidth + 1;
        openvdb::FloatGrid::Ptr grid =
            withThreads(ctx, [&] { return unsignedDistance(indexMesh, reach, ctx); });
        for (auto it = grid->beginValueAll(); it; ++it) it.setValue(std::min(*it - half, kHalfWidth));
        grid->tree().root().setBackground(kHalfWidth, /* updateChildNodes= */ false);
        const IndexBox box = fromBBox(grid->evalActiveVoxelBoundingBox()).expanded(1);
        BrickField field = gatherBricks(*grid, box, 1.f, kHalfWidth, ctx);
        field.translate(box.min);
        return field;
    });
}

}  // namespace vdbsynth
