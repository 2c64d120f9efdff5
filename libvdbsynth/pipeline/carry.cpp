#include "libvdbsynth/pipeline/carry.h"

#include "libvdbsynth/vdb/coord.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using Carriable =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                      openvdb::BoolGrid, openvdb::Vec3IGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;

struct Link {
    openvdb::Coord to;
    openvdb::Vec3d from;  // world, in the exemplar
};

std::vector<Link> linksOf(const SourceMap& map, const openvdb::FloatGrid& exemplar,
                          const openvdb::FloatGrid& result) {
    std::vector<Link> links;
    for (auto it = result.cbeginValueOn(); it; ++it) {
        const Index3 voxel = fromCoord(it.getCoord());
        if (!map.targetDomain.contains(voxel)) continue;
        const Index3 local = voxel - map.targetBox.min, block = strongestBlock(map.patches, local);
        const Index3 from = map.patches.source[map.patches.index(block)] + local -
                            map.patches.originOf(block) + map.exemplarBox.min;
        links.push_back(
            {it.getCoord(), exemplar.transform().indexToWorld(openvdb::Vec3d(from.x, from.y, from.z))});
    }
    return links;
}

// Steps to voxels within two, nearest first.
std::vector<openvdb::Coord> nearSteps() {
    std::vector<openvdb::Coord> steps;
    for (int n = 0; n < 125; ++n) steps.emplace_back(n / 25 - 2, n / 5 % 5 - 2, n % 5 - 2);
    const auto squared = [](const openvdb::Coord& c) {
        return c.x() * c.x() + c.y() * c.y() + c.z() * c.z();
    };
    std::stable_sort(steps.begin(), steps.end(), [&](const openvdb::Coord& a, const openvdb::Coord& b) {
        return squared(a) < squared(b);
    });
    steps.erase(
        std::remove_if(steps.begin(), steps.end(), [&](const openvdb::Coord& c) { return squared(c) > 4; }),
        steps.end());
    return steps;
}

template <typename Grid>
GridPtr readThrough(const Grid& grid, const std::vector<Link>& links, const openvdb::FloatGrid& result) {
    static const std::vector<openvdb::Coord> steps = nearSteps();
    const auto made = Grid::create(grid.background());
    made->insertMeta(grid);
    made->setName(grid.getName());
    made->setTransform(result.transform().copy());
    const auto from = grid.getConstAccessor();
    auto to = made->getAccessor();
    typename Grid::ValueType value;
    for (const Link& link : links) {
        const openvdb::Coord middle = openvdb::Coord::round(grid.transform().worldToIndex(link.from));
        for (const openvdb::Coord& step : steps)
            if (from.probeValue(middle + step, value)) {
                to.setValueOn(link.to, value);
                break;
            }
    }
    return made;
}

bool ofSourceMap(const std::string& name) {
    return name == "source" || name == "exemplar" || name == "vote_source" || name == "vote_weight";
}

}  // namespace

std::vector<GridPtr> carryThroughMap(const SourceMap& map, const LevelSet& exemplar,
                                     const openvdb::FloatGrid& result, const RunContext& ctx) {
    std::vector<GridPtr> carried;
    if (exemplar.carried.empty()) return carried;
    Stage stage(ctx, "carrying attributes", 1);
    const std::vector<Link> links = linksOf(map, *exemplar.grid, result);
    for (const GridPtr& grid : exemplar.carried) {
        if (ofSourceMap(grid->getName())) continue;
        GridPtr made;
        const bool read = grid->transform().isLinear() && grid->apply<Carriable>([&](const auto& typed) {
            made = readThrough(typed, links, result);
        });
        if (read)
            carried.push_back(made);
        else
            message(ctx, MessageLevel::Warning,
                    "grid \"" + grid->getName() + "\" (" + grid->valueType() +
                        ") cannot be carried and is left out");
    }
    stage.advance();
    return carried;
}

}  // namespace vdbsynth
