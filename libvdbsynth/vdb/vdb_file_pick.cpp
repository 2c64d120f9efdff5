// Which grid of a VDB file is meant.
#include "libvdbsynth/vdb/vdb_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/read/field_kind.h"
#include "libvdbsynth/vdb/read/grid_names.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// What to do with a file of grids that hold no field.
std::string adviceFor(const std::vector<GridPtr>& grids) {
    for (const GridPtr& grid : grids) {
        const std::string type = grid->valueType();
        if (type.compare(0, 9, "ptdataidx") == 0) return "; points are read from .ply, .xyz or .pcd";
        if (type == "bool" || type == "mask")
            return "; a mask has no values: make it a fog volume or a level set where it was made";
        if (type.compare(0, 3, "vec") == 0)
            return "; a vector field has no surface: write its magnitude or the density beside it";
    }
    return "";
}

GridPtr namedScalars(const std::string& path, const std::vector<GridPtr>& grids, const std::string& name,
                     std::string* note) {
    std::size_t several = 0;
    const GridPtr grid = gridNamed(grids, name, &several);
    if (!grid)
        throw Error(ErrorCode::BadData,
                    "`grid` " + name + ": not in " + path + ", which has " + listOf(grids));
    if (!asFloat(grid))
        throw Error(ErrorCode::BadData, path + ": grid \"" + name + "\" holds " + grid->valueType() +
                                            "; a float or double grid is needed" + adviceFor({grid}));
    if (several > 1 && note)
        *note = path + ": " + std::to_string(several) + " grids are named \"" + name +
                "\"; the first is read, `grid` " + name + "[1] is the next";
    return grid;
}

// The grids of each kind, in the order of the file.
struct Candidates {
    std::vector<GridPtr> levelSets, distances, densities;
};

Candidates candidatesOf(const std::vector<GridPtr>& grids) {
    Candidates all;
    std::vector<GridPtr> unknown;
    for (const GridPtr& grid : grids) {
        const bool scalar = openvdb::gridPtrCast<openvdb::FloatGrid>(grid) != nullptr ||
                            openvdb::gridPtrCast<openvdb::DoubleGrid>(grid) != nullptr;
        if (!scalar) continue;
        if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
            all.levelSets.push_back(grid);
        else
            unknown.push_back(grid);
    }
    // A level set by its class comes first, so other values need a look only where there is none.
    for (const GridPtr& grid : unknown)
        (all.levelSets.empty() && kindOf(*asFloat(grid)) == FieldKind::Distances ? all.distances
                                                                                 : all.densities)
            .push_back(grid);
    return all;
}

GridPtr firstOf(const std::string& path, const std::vector<GridPtr>& grids, const std::vector<GridPtr>& able,
                const std::string& what, std::string* note) {
    const auto isSurface = [](const GridPtr& grid) { return grid->getName() == kSurfaceName; };
    const auto surfaces = std::count_if(able.begin(), able.end(), isSurface);
    const auto surface = std::find_if(able.begin(), able.end(), isSurface);
    const GridPtr picked = surface != able.end() ? *surface : able.front();
    if (note && able.size() > 1 && surfaces != 1) {
        const std::vector<std::string> names = uniqueNamesOf(grids);
        std::string pickedName;
        for (std::size_t i = 0; i < grids.size(); ++i)
            if (grids[i] == picked) pickedName = printableText(names[i], 80);
        *note = path + ": grid \"" + pickedName + "\" is read, of " + std::to_string(able.size()) + " " +
                what + ": " + listOf(grids) + "; `grid` names another";
    }
    return picked;
}

}  // namespace

GridPtr pickedGrid(const std::string& path, const std::vector<GridPtr>& grids, const VdbReadOptions& options,
                   std::string* note) {
    requireGrids(grids);
    if (!options.gridName.empty()) return namedScalars(path, grids, options.gridName, note);
    const Candidates all = candidatesOf(grids);
    if (options.iso && !all.densities.empty())
        return firstOf(path, grids, all.densities, "grids without a surface of their own", note);
    if (!all.levelSets.empty()) return firstOf(path, grids, all.levelSets, "level sets", note);
    if (!all.distances.empty()) return firstOf(path, grids, all.distances, "fields of distances", note);
    if (!all.densities.empty()) return firstOf(path, grids, all.densities, "fields", note);
    throw Error(ErrorCode::BadData, path + ": no usable grid; a float or double grid is needed, it has " +
                                        listOf(grids) + adviceFor(grids));
}

GridPtr readVdbGrid(const std::string& path, const std::string& name, const RunContext& ctx) {
    const std::vector<GridPtr> grids = readVdbGrids(path, ctx);
    std::size_t several = 0;
    const GridPtr grid = gridNamed(grids, name, &several);
    if (!grid) throw Error(ErrorCode::BadData, path + ": no grid \"" + name + "\"; it has " + listOf(grids));
    if (several > 1)
        message(
            ctx, MessageLevel::Note,
            path + ": " + std::to_string(several) + " grids are named \"" + name + "\"; the first is read");
    return grid;
}

}  // namespace vdbsynth
