#include "libvdbsynth/analogy/filter_analogy.h"
#include "libvdbsynth/pipeline/analogy/filter_analogy.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Count.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace vdbsynth {
namespace {

constexpr float kAny = std::numeric_limits<float>::max();
constexpr float kSame = 1e-5f;  // of the result's range: equal to the background

IndexBox activeBox(const openvdb::FloatGrid& grid, const std::string& what) {
    for (auto value = grid.cbeginValueOn(); value; ++value)
        if (!std::isfinite(value.getValue()))
            throw Error(ErrorCode::BadData,
                        what + " holds NaN or infinite values; set them to 0 before writing the file");
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) throw Error(ErrorCode::EmptyInput, what + " has no active voxel");
    return fromBBox(box);
}

IndexBox widened(const IndexBox& box, int by) {
    return {box.min - Index3{by, by, by}, box.max + Index3{by, by, by}};
}

void requireMemoryFor(const IndexBox& box, const RunContext& ctx) {
    requireMemory(ctx, double(box.volume()) * 20, "the filter", "crop the grids or use larger voxels");
}

// Voxels that differ from the background, which is the filtered background of the target.
GridPtr gridOf(const BrickField& field, const IndexBox& box, const openvdb::FloatGrid& like) {
    const bool fog = like.getGridClass() == openvdb::GRID_FOG_VOLUME;
    const auto made = [&](float value) { return fog ? std::max(value, 0.f) : value; };
    const float background = made(field.at({0, 0, 0}));
    const openvdb::math::MinMax<float> range = openvdb::tools::minMax(like.tree());
    const float same = kSame * std::max(range.max() - range.min(), 1e-30f);
    const openvdb::FloatGrid::Ptr grid =
        openvdb::FloatGrid::create(std::abs(background) < same ? 0.f : background);
    openvdb::FloatGrid::Accessor to = grid->getAccessor();
    const Index3 size = box.size();
    std::vector<float> row(std::size_t(size.z));
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y) {
            field.readBox({x, y, 0}, {1, 1, size.z}, row.data());
            for (int z = 0; z < size.z; ++z) {
                const float value = made(row[std::size_t(z)]);
                if (std::abs(value - grid->background()) > same)
                    to.setValue(toCoord(box.min + Index3{x, y, z}), value);
            }
        }
    grid->setName(like.getName());
    grid->setGridClass(like.getGridClass());
    grid->setTransform(like.transform().copy());
    return grid;
}

FilterGridResult filtered(const std::vector<FilterGridPair>& pairs, const FloatGridConstPtr& target,
                          const FilterAnalogyOptions& options, const RunContext& ctx) {
    const int reach = filterReach(options) + BrickField::kSide;
    std::vector<BrickField> fields;
    for (const FilterGridPair& pair : pairs) {
        const IndexBox a = activeBox(*pair.before, "the pair's first grid"),
                       b = activeBox(*pair.after, "the pair's second grid");
        IndexBox box = a;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(a.min[axis], b.min[axis]);
            box.max[axis] = std::max(a.max[axis], b.max[axis]);
        }
        box = widened(box, reach);
        requireMemoryFor(box, ctx);
        fields.push_back(gatherBricks(*pair.before, box, 1, kAny, ctx));
        fields.push_back(gatherBricks(*pair.after, box, 1, kAny, ctx));
    }
    std::vector<FilterPair> given;
    for (std::size_t p = 0; p < fields.size(); p += 2) given.push_back({&fields[p], &fields[p + 1]});
    const IndexBox box = widened(activeBox(*target, "the target"), 2 * reach);
    requireMemoryFor(box, ctx);
    const FilterAnalogyResult made =
        makeFilterAnalogy(given, gatherBricks(*target, box, 1, kAny, ctx), options, ctx);
    return {gridOf(made.after, box, *target), made.stats};
}

}  // namespace

bool isGridOfNumbers(const FloatGridConstPtr& grid) {
    return grid->getGridClass() != openvdb::GRID_LEVEL_SET;
}

void validate(const FilterAnalogyOptions& options, const std::vector<FilterGridPair>& pairs,
              const FloatGridConstPtr& target) {
    validate(options);
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (const FilterGridPair& pair : pairs) {
        if (!pair.before || !pair.after)
            throw Error(ErrorCode::InvalidOption, "`before`, `after`: a grid of a pair is null");
        if (!(pair.before->transform() == pair.after->transform()))
            throw Error(ErrorCode::ShapeMismatch,
                        "the two grids of the pair must have the same voxels in the same place");
    }
    if (!target) throw Error(ErrorCode::InvalidOption, "the target is null; a scalar grid is needed");
    if (!isGridOfNumbers(target))
        throw Error(ErrorCode::Unusable, "the target is a level set; a scalar grid is needed");
}

FilterGridResult makeFilteredGrid(const std::vector<FilterGridPair>& pairs, const FloatGridConstPtr& target,
                                  const FilterAnalogyOptions& options, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        validate(options, pairs, target);
        return filtered(pairs, target, options, ctx);
    });
}

}  // namespace vdbsynth
