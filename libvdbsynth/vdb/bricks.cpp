#include "libvdbsynth/vdb/bricks.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kSide = BrickField::kSide;

// The value of a whole leaf-aligned region if it is one tile, by probing its leaf.
void readLeafRegion(const openvdb::FloatGrid::ConstAccessor& accessor, const Index3& corner, int nx, int ny,
                    int nz, float* out, int strideX, int strideY) {
    const openvdb::Coord origin = toCoord(corner);
    const Leaf* leaf = accessor.probeConstLeaf(origin);
    const float tile = leaf ? 0.f : accessor.getValue(origin);
    for (int x = 0; x < nx; ++x)
        for (int y = 0; y < ny; ++y) {
            float* row = out + x * strideX + y * strideY;
            if (!leaf) {
                std::fill(row, row + nz, tile);
                continue;
            }
            const openvdb::Index offset = Leaf::coordToOffset(origin.offsetBy(x, y, 0));
            const float* values = leaf->buffer().data() + offset;
            std::copy(values, values + nz, row);
        }
}

}  // namespace

BrickField gatherBricks(const openvdb::FloatGrid& grid, const IndexBox& box, float scale, float limit,
                        const RunContext& ctx) {
    const Index3 shift = box.min;
    return BrickField::generate(
        IndexBox::fromSize(box.size()), ctx, [&](const IndexBox& brick, float* samples) {
            const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
            const Index3 corner = brick.min + shift;
            for (int x = 0; x < kSide;) {
                const int nx = std::min(kSide - x, kSide - ((corner.x + x) & 7));
                for (int y = 0; y < kSide;) {
                    const int ny = std::min(kSide - y, kSide - ((corner.y + y) & 7));
                    for (int z = 0; z < kSide;) {
                        const int nz = std::min(kSide - z, kSide - ((corner.z + z) & 7));
                        readLeafRegion(accessor, corner + Index3{x, y, z}, nx, ny, nz,
                                       samples + (x * kSide + y) * kSide + z, kSide * kSide, kSide);
                        z += nz;
                    }
                    y += ny;
                }
                x += nx;
            }
            for (int i = 0; i < BrickField::kSamples; ++i)
                samples[i] = std::clamp(samples[i] * scale, -limit, limit);
        });
}

FloatGridPtr scatterBricks(const BrickField& field, const Index3& corner, float scale, float limit,
                           const RunContext& ctx) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(limit * scale);
    const IndexBox& box = field.box();
    const Index3 low = box.min + corner, high = box.max + corner;
    const Index3 first{low.x & ~7, low.y & ~7, low.z & ~7};
    const Index3 leaves{(high.x - first.x) / 8 + 1, (high.y - first.y) / 8 + 1, (high.z - first.z) / 8 + 1};
    const std::size_t count = std::size_t(leaves.x) * std::size_t(leaves.y) * std::size_t(leaves.z);
    std::vector<std::unique_ptr<Leaf>> made(count);
    std::vector<char> inside(count, 0);
    parallelFor(ctx, count, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index3 leafIndex{int(i / std::size_t(leaves.z) / std::size_t(leaves.y)),
                                   int(i / std::size_t(leaves.z) % std::size_t(leaves.y)),
                                   int(i % std::size_t(leaves.z))};
            const Index3 origin = first + leafIndex * 8;
            const IndexBox region = IndexBox::cube(origin - corner, 8);
            float constant = 0;
            if (box.contains(region) && field.constantIn(region, constant) &&
                !(constant > -limit && constant < limit)) {
                inside[i] = constant < 0;
                continue;
            }
            auto leaf = std::make_unique<Leaf>(toCoord(origin), limit * scale, false);
            float values[BrickField::kSamples];
            field.readBox(region.min, {8, 8, 8}, values);
            for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
                const openvdb::Coord at = leaf->offsetToGlobalCoord(n);
                if (!box.contains(fromCoord(at) - corner)) continue;
                const float value = std::clamp(values[n], -limit, limit);
                if (value > -limit && value < limit)
                    leaf->setValueOn(n, value * scale);
                else
                    leaf->setValueOff(n, value * scale);
            }
            made[i] = std::move(leaf);
        }
    });
    for (std::size_t i = 0; i < count; ++i) {
        const Index3 leafIndex{int(i / std::size_t(leaves.z) / std::size_t(leaves.y)),
                               int(i / std::size_t(leaves.z) % std::size_t(leaves.y)),
                               int(i % std::size_t(leaves.z))};
        if (made[i])
            grid->tree().addLeaf(made[i].release());
        else if (inside[i])
            grid->tree().addTile(1, toCoord(first + leafIndex * 8), -limit * scale, false);
    }
    return grid;
}

namespace {

FloatGridPtr levelSetIn(const openvdb::math::Transform& transform, const BrickField& band, float halfWidth,
                        const std::string& what, const RunContext& ctx) {
    const FloatGridPtr grid = scatterBricks(band, {0, 0, 0}, float(transform.voxelSize()[0]), halfWidth, ctx);
    if (grid->activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    grid->setTransform(transform.copy());
    grid->setName(kSurfaceName);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

}  // namespace

FloatGridPtr levelSetFrom(const BrickField& band, float halfWidth, const openvdb::FloatGrid& like,
                          const std::string& what, const RunContext& ctx) {
    return levelSetIn(like.transform(), band, halfWidth, what, ctx);
}

FloatGridPtr levelSetFrom(const BrickField& band, float halfWidth, double voxelSize, const std::string& what,
                          const RunContext& ctx) {
    return levelSetIn(*openvdb::math::Transform::createLinearTransform(voxelSize), band, halfWidth, what,
                      ctx);
}

BrickField gatherNarrowBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain,
                            const RunContext& ctx) {
    return gatherBricks(levelSet, domain, float(1 / voxelSizeOf(levelSet)), kHalfWidth, ctx);
}

KnownBand gatherKnownBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                          int reach, const RunContext& ctx) {
    IndexBox box = domain;
    for (int axis = 0; axis < 3; ++axis) {
        if (!cut[std::size_t(2 * axis)]) box.min[axis] -= reach;
        if (!cut[std::size_t(2 * axis + 1)]) box.max[axis] += reach;
    }
    KnownBand known;
    known.field = gatherNarrowBand(levelSet, box, ctx);
    known.domain = {domain.min - box.min, domain.max - box.min};
    known.band = kHalfWidth;
    return known;
}

BrickField gatherWideBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                          float halfWidth, const RunContext& ctx) {
    const KnownBand known = gatherKnownBand(levelSet, domain, cut, reachToWiden(halfWidth), ctx);
    return widenBand(known, halfWidth, ctx);
}

}  // namespace vdbsynth
