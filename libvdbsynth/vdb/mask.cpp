#include "libvdbsynth/vdb/mask.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/grid_reader.h"
#include "libvdbsynth/vdb/read/field_kind.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "libvdbsynth/vdb/wall.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kFar = 1 << 28;  // [voxels] beyond this, sizes of boxes exceed int

openvdb::BoolGrid::Ptr emptyMask(const openvdb::math::Transform::Ptr& transform) {
    auto mask = emptyGrid<openvdb::BoolGrid>();
    mask->setName("mask");
    mask->setTransform(transform);
    return mask;
}

void requireVoxelSize(double voxelSize) {
    requireOption(voxelSize > 0 && voxelSize < 1e30, "voxelSize", roundedText(voxelSize, 6),
                  "above 0 (world)");
}

}  // namespace

void requireMaskFor(const openvdb::GridBase& grid, const openvdb::FloatGrid& like) {
    if (!(grid.transform() == like.transform()))
        throw Error(ErrorCode::ShapeMismatch,
                    "mask \"" + grid.getName() + "\": its voxels (size " +
                        std::to_string(grid.voxelSize()[0]) + ") are not those of the model (size " +
                        std::to_string(like.voxelSize()[0]) + "); make it with the same `voxelSize`");
}

BrickField gatherMask(const openvdb::GridBase& grid, const IndexBox& box, const openvdb::FloatGrid& like,
                      const RunContext& ctx) {
    requireMaskFor(grid, like);
    BrickField field;
    if (grid.apply<MaskGrids>([&](const auto& typed) {
            field = BrickField::generate(
                IndexBox::fromSize(box.size()), ctx, [&](const IndexBox& brick, float* samples) {
                    const auto accessor = typed.getConstAccessor();
                    forEachVoxel(brick, [&](const Index3& p) {
                        *samples++ = accessor.isValueOn(toCoord(p + box.min)) ? 1.f : 0.f;
                    });
                });
        }))
        return field;
    throw Error(ErrorCode::BadData, "mask \"" + grid.getName() + "\": a grid of " + grid.valueType() +
                                        " cannot be a mask; bool, mask, int32 or float can");
}

FloatGridConstPtr solidOfMask(const openvdb::GridBase& mask, const std::string& what, const RunContext& ctx) {
    const FloatGridPtr field = asFloat(openvdb::ConstPtrCast<openvdb::GridBase>(mask.copyGrid()));
    if (!field || kindOf(*field, ctx) == FieldKind::Density) return nullptr;
    return modelFromGrids(what, {field}, {}, ctx).grid;
}

namespace {

// What may be active of a mask, in another grid's voxels.
IndexBox boxIn(const openvdb::FloatGrid& like, const openvdb::GridBase& mask) {
    const IndexBox own = activeBox(mask);
    openvdb::BBoxd box;
    for (int corner = 0; corner < 8; ++corner) {
        openvdb::Vec3d p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = corner >> axis & 1 ? own.max[axis] + 0.5 : own.min[axis] - 0.5;
        box.expand(like.transform().worldToIndex(mask.transform().indexToWorld(p)));
    }
    IndexBox in;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(box.min()[axis]) < kFar && std::abs(box.max()[axis]) < kFar))
            throw Error(ErrorCode::Memory, "mask \"" + mask.getName() +
                                               "\": lies too far away for voxels of " +
                                               roundedText(like.voxelSize()[0], 6) + "; use larger voxels");
        in.min[axis] = int(std::floor(box.min()[axis]));
        in.max[axis] = int(std::ceil(box.max()[axis]));
    }
    return in;
}

// Where a model has voxels to ask a mask about: its active ones, and its domain if it names one. Empty:
// unknown.
IndexBox extentOf(const openvdb::FloatGrid& like) {
    IndexBox active, domain;
    if (like.activeVoxelCount() > 0) active = fromBBox(like.evalActiveVoxelBoundingBox());
    const auto recorded = like.getMetadata<openvdb::StringMetadata>(kDomainKey);
    if (!recorded || !parseBox(recorded->value(), domain)) return active;
    if (active.empty()) return domain;
    for (int axis = 0; axis < 3; ++axis) {
        domain.min[axis] = std::min(domain.min[axis], active.min[axis]);
        domain.max[axis] = std::max(domain.max[axis], active.max[axis]);
    }
    return domain;
}

}  // namespace

GridConstPtr maskOn(const GridConstPtr& mask, const openvdb::FloatGrid& like, const std::string& what,
                    const RunContext& ctx) {
    const FloatGridConstPtr solid = solidOfMask(*mask, what, ctx);
    if (!solid && mask->transform() == like.transform()) return mask;
    const openvdb::GridBase& read = solid ? *solid : *mask;
    scalarReader(read, GridSampling::Linear,
                 what);  // a grid of a wrong kind is refused here, not in a worker
    const IndexBox whole = boxIn(like, read), extent = extentOf(like),
                   box = extent.empty() ? whole : whole.intersection(extent);
    if (box.empty())
        throw Error(ErrorCode::EmptyInput, what + ": lies beside the model, at voxels " + boxText(whole) +
                                               " of the model's, which has " + boxText(extent));
    requireMemory(ctx, double(box.volume()) / 8, what + ", a mask of " + boxText(box),
                  "use larger voxels or a smaller mask");
    const auto reader = [&] {
        return scalarReader(read, solid ? GridSampling::Linear : GridSampling::Nearest, what);
    };
    const BrickField field =
        BrickField::generate(IndexBox::fromSize(box.size()), ctx, [&](const IndexBox& brick, float* samples) {
            const GridReader at = reader();
            forEachVoxel(brick, [&](const Index3& p) {
                const Index3 voxel = p + box.min;
                const GridReading found =
                    at(fromVec(like.transform().indexToWorld(openvdb::Vec3d(voxel.x, voxel.y, voxel.z))));
                *samples++ = (solid ? found.value.z < 0 : found.active) ? 1.f : 0.f;
            });
        });
    const auto made = emptyMask(like.transform().copy());
    auto accessor = made->getAccessor();
    forEachVoxel(field.box(), [&](const Index3& p) {
        if (field.inside(p) > 0) accessor.setValueOn(toCoord(p + box.min), true);
    });
    if (made->activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput,
                    what + ": holds no voxel of the model; it is thinner than voxels of " +
                        roundedText(like.voxelSize()[0], 6) + ", or empty");
    made->pruneGrid();
    return made;
}

IndexBox activeBox(const openvdb::GridBase& grid) {
    if (grid.activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput, "mask \"" + grid.getName() + "\": has no active voxels");
    return fromBBox(grid.evalActiveVoxelBoundingBox());
}

GridPtr boxMask(const IndexBox& box, double voxelSize) {
    requireBox(box, "box");
    requireVoxelSize(voxelSize);
    auto mask = emptyMask(openvdb::math::Transform::createLinearTransform(voxelSize));
    mask->fill(toBBox(box), true, true);
    return mask;
}

GridPtr ballMask(const Vec3d& centre, double radius, double voxelSize, const RunContext& ctx) {
    requireVoxelSize(voxelSize);
    requireOption(radius > 0 && radius < 1e4 * voxelSize, "radius", roundedText(radius, 6),
                  "above 0 (world) and under ten thousand voxels");
    auto mask = emptyMask(openvdb::math::Transform::createLinearTransform(voxelSize));
    auto accessor = mask->getAccessor();
    const Vec3d c = centre * (1 / voxelSize);
    const double r = radius / voxelSize;
    IndexBox around;
    for (int axis = 0; axis < 3; ++axis) {
        around.min[axis] = int(std::ceil(c[axis] - r));
        around.max[axis] = int(std::floor(c[axis] + r));
    }
    if (around.empty()) return mask;
    Stage stage(ctx, "mask", std::size_t(around.size().x));
    for (int x = around.min.x; x <= around.max.x; ++x) {
        forEachVoxel({{x, around.min.y, around.min.z}, {x, around.max.y, around.max.z}},
                     [&](const Index3& p) {
                         if (length(Vec3d{double(p.x), double(p.y), double(p.z)} - c) <= r)
                             accessor.setValueOn(toCoord(p), true);
                     });
        stage.advance();
    }
    return mask;
}

namespace {

constexpr std::size_t kBetweenPolls = 4096;  // values of a grid

// Makes active in the mask what `holds` says of a grid's values, of voxels and of tiles.
template <typename Iterator, typename Holds>
GridPtr maskOfValues(Iterator it, const openvdb::math::Transform::Ptr& transform, const RunContext& ctx,
                     const Holds& holds) {
    auto mask = emptyMask(transform);
    for (std::size_t n = 0; it; ++it, ++n) {
        if (n % kBetweenPolls == 0) throwIfCancelled(ctx);
        if (!holds(*it)) continue;
        if (it.isVoxelValue())
            mask->tree().setValueOn(it.getCoord(), true);
        else
            mask->fill(it.getBoundingBox(), true, true);
    }
    return mask;
}

}  // namespace

GridPtr insideMask(const openvdb::FloatGrid& levelSet, const RunContext& ctx) {
    return maskOfValues(levelSet.cbeginValueAll(), levelSet.transform().copy(), ctx,
                        [](float value) { return value < 0; });
}

GridPtr rangeMask(const openvdb::FloatGrid& grid, double minimum, double maximum, const RunContext& ctx) {
    requireOption(minimum <= maximum, "minimum", roundedText(minimum, 6),
                  "at most `maximum` " + roundedText(maximum, 6));
    return maskOfValues(grid.cbeginValueOn(), grid.transform().copy(), ctx,
                        [&](float value) { return double(value) >= minimum && double(value) <= maximum; });
}

}  // namespace vdbsynth
