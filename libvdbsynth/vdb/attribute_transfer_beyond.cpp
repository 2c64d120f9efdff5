#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <string>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::int64_t kAtOnce = 1 << 22;  // voxels

// Copies of the models with only those grids that reach beyond their band. They share all grids.
std::vector<LevelSet> deepOnes(const std::vector<const LevelSet*>& exemplars, bool& any) {
    std::vector<LevelSet> deep;
    for (const LevelSet* exemplar : exemplars) {
        LevelSet copy = *exemplar;
        copy.attributes.clear();
        for (const GridPtr& grid : exemplar->attributes)
            if (!isOfSourceMap(grid->getName()) && isBeyondBand(grid, *exemplar->grid))
                copy.attributes.push_back(grid);
        any = any || !copy.attributes.empty();
        deep.push_back(std::move(copy));
    }
    return deep;
}

bool isFog(const openvdb::GridBase& grid) {
    return grid.isType<openvdb::FloatGrid>() && grid.getGridClass() == openvdb::GRID_FOG_VOLUME;
}

openvdb::FloatGrid::ConstPtr fogNamed(const LevelSet& model, const std::string& name) {
    for (const GridPtr& grid : model.attributes)
        if (grid->getName() == name && isFog(*grid)) return openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    return nullptr;
}

// Voxels [begin, end) along x of a box that holds `kAtOnce` voxels at most, or is one thick.
template <typename Work>
void forSlabs(const IndexBox& box, const RunContext& ctx, const std::string& what, Work&& work) {
    const Index3 size = box.size();
    const std::int64_t layer = std::max<std::int64_t>(1, std::int64_t(size.y) * size.z);
    const int slab = int(std::max<std::int64_t>(1, kAtOnce / layer));
    Stage stage(ctx, what, std::size_t((size.x + slab - 1) / slab));
    for (int x = box.min.x; x <= box.max.x; x += slab) {
        IndexBox part = box;
        part.min.x = x;
        part.max.x = std::min(x + slab - 1, box.max.x);
        work(part);
        stage.advance();
    }
}

// Fog as the surface is made: the mean over all blocks at a voxel. Where a source has none it is the
// background, so edges stay as soft as the exemplar's.
GridPtr fogThrough(const SourceMap& map, const std::vector<LevelSet>& exemplars, const std::string& name,
                   const openvdb::FloatGrid& result, const IndexBox& box, const RunContext& ctx) {
    std::vector<openvdb::FloatGrid::ConstPtr> fogs;
    openvdb::FloatGrid::ConstPtr like;
    for (const LevelSet& exemplar : exemplars) {
        fogs.push_back(fogNamed(exemplar, name));
        if (!like) like = fogs.back();
    }
    const openvdb::FloatGrid::Ptr made = openvdb::FloatGrid::create(like->background());
    made->insertMeta(*like);
    made->setName(name);
    made->setTransform(result.transform().copy());
    const openvdb::FloatGrid none;
    forSlabs(box, ctx, "blending " + name, [&](const IndexBox& part) {
        const std::vector<MappedVoxel> voxels = mappedVoxelsIn(map, part, none, ctx);
        std::vector<float> values(voxels.size());
        std::vector<char> active(voxels.size());
        parallelFor(ctx, voxels.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                double sum = 0, weight = 0;
                for (const Source& source : votingSources(map, voxels[i].to)) {
                    const std::size_t e = std::size_t(source.exemplar);
                    float value = like->background();
                    if (fogs[e]) {
                        const openvdb::Vec3d world =
                            exemplars[e].grid->transform().indexToWorld(toVec(source.position));
                        active[i] |= fogs[e]->getConstUnsafeAccessor().probeValue(
                            openvdb::Coord::round(fogs[e]->worldToIndex(world)), value);
                    }
                    sum += double(source.weight) * double(value);
                    weight += double(source.weight);
                }
                if (weight > 0) values[i] = float(sum / weight);
            }
        });
        auto to = made->getAccessor();
        for (std::size_t i = 0; i < voxels.size(); ++i)
            if (active[i]) to.setValueOn(toCoord(voxels[i].to), values[i]);
    });
    made->pruneGrid();
    return made;
}

template <typename Grid>
bool hasBeyond(const Grid& grid, const openvdb::FloatGrid& levelSet) {
    const auto accessor = levelSet.getConstAccessor();
    const openvdb::Index64 enough = anyKind(grid).activeVoxelCount() / 100;
    openvdb::Index64 beyond = 0;
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        const openvdb::Vec3d world = grid.indexToWorld(value.getCoord().asVec3d());
        if (!accessor.isValueOn(openvdb::Coord::round(levelSet.worldToIndex(world))))
            beyond += value.getVoxelCount();
        if (beyond > enough) return true;
    }
    return false;
}

}  // namespace

bool isBeyondBand(const GridPtr& grid, const openvdb::FloatGrid& levelSet) {
    bool beyond = false;
    if (grid->transform().isLinear())
        grid->apply<AttributeGrids>([&](const auto& typed) { beyond = hasBeyond(typed, levelSet); });
    return beyond;
}

std::vector<GridPtr> transferBeyondBand(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                                        const openvdb::FloatGrid& result, std::vector<GridPtr> into,
                                        const RunContext& ctx) {
    bool any = false;
    const std::vector<LevelSet> deep = deepOnes(exemplars, any);
    if (!any) return into;
    const IndexBox box = map.method == MapMethod::Synthesis ? map.targetDomain : map.targetBox;
    std::vector<const LevelSet*> models;
    std::vector<std::string> fogs;
    std::vector<LevelSet> others = deep;
    for (LevelSet& model : others) {
        for (const GridPtr& grid : model.attributes)
            if (map.method == MapMethod::Synthesis && isFog(*grid) &&
                std::find(fogs.begin(), fogs.end(), grid->getName()) == fogs.end())
                fogs.push_back(grid->getName());
        model.attributes.erase(std::remove_if(model.attributes.begin(), model.attributes.end(),
                                              [&](const GridPtr& grid) {
                                                  return map.method == MapMethod::Synthesis && isFog(*grid);
                                              }),
                               model.attributes.end());
        models.push_back(&model);
    }
    for (const std::string& name : fogs) {
        const auto made = fogThrough(map, deep, name, result, box, ctx);
        const auto same = std::find_if(into.begin(), into.end(), [&](const GridPtr& grid) {
            return grid->getName() == name && grid->type() == made->type();
        });
        if (same == into.end())
            into.push_back(made);
        else
            *same = made;
    }
    RunContext quiet = ctx;  // the parts are no stages of their own
    quiet.onProgress = nullptr;
    if (std::any_of(others.begin(), others.end(), [](const LevelSet& m) { return !m.attributes.empty(); }))
        forSlabs(box, ctx, "transferring interiors", [&](const IndexBox& part) {
            into = transferToVoxels(mappedVoxelsIn(map, part, result, ctx), models, result, std::move(into),
                                    quiet, 0);
        });
    for (const GridPtr& grid : into) grid->pruneGrid();
    return into;
}

}  // namespace vdbsynth
