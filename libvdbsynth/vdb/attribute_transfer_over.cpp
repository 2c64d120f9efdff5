// Attributes of a textured model over those that the target has of its own: of analogies only.
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <type_traits>

namespace vdbsynth {
namespace {

// Adds what is active in `over`, of the same transform.
template <typename Grid>
GridPtr withOver(const Grid& own, const Grid& over) {
    const auto result = openvdb::gridPtrCast<Grid>(anyKind(own).deepCopyGrid());
    auto accessor = result->getAccessor();
    for (auto value = over.cbeginValueOn(); value; ++value) {
        if (value.isVoxelValue())
            accessor.setValueOn(value.getCoord(), *value);
        else
            result->tree().addTile(value.getLevel(), value.getCoord(), *value, true);
    }
    return result;
}

}  // namespace

void noteBandOnly(const std::vector<const LevelSet*>& exemplars, const RunContext& ctx) {
    for (const LevelSet* exemplar : exemplars)
        for (const GridPtr& grid : exemplar->attributes)
            if (!isOfSourceMap(grid->getName()) && isBeyondBand(grid, *exemplar->grid))
                message(
                    ctx, MessageLevel::Note,
                    "grid \"" + grid->getName() +
                        "\" of the textured model is brought near the surface only: what is deep inside has "
                        "no counterpart in another model");
}

std::vector<GridPtr> laidOver(const std::vector<GridPtr>& own, const std::vector<GridPtr>& brought) {
    std::vector<GridPtr> result = brought;
    for (const GridPtr& grid : own) {
        if (isOfSourceMap(grid->getName())) continue;
        const auto same = std::find_if(result.begin(), result.end(), [&](const GridPtr& other) {
            return other->getName() == grid->getName() && other->type() == grid->type() &&
                   other->transform() == grid->transform();
        });
        if (same == result.end()) {
            result.push_back(grid);
            continue;
        }
        grid->apply<AttributeGrids>([&](const auto& typed) {
            using Grid = std::decay_t<decltype(typed)>;
            *same = withOver(typed, *openvdb::gridPtrCast<Grid>(*same));
        });
    }
    return result;
}

}  // namespace vdbsynth
