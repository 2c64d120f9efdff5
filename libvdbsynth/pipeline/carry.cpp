#include "libvdbsynth/pipeline/carry.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace vdbsynth {
namespace {

using Carriable =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                      openvdb::BoolGrid, openvdb::Vec3IGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;

using Blendable =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;

struct Link {
    openvdb::Coord to;
    openvdb::Vec3d from;  // world, in the exemplar
    Vec3f rotation;
};

bool rotates(const Vec3f& rotation) {
    return rotation.x != 0 || rotation.y != 0 || rotation.z != 0;
}

// For each exemplar the voxels of the result that are read from it.
std::vector<std::vector<Link>> linksOf(const std::vector<MappedVoxel>& voxels,
                                       const std::vector<const LevelSet*>& exemplars) {
    std::vector<std::vector<Link>> links(exemplars.size());
    for (const auto& [to, source] : voxels) {
        const std::size_t e = std::size_t(source.exemplar);
        links[e].push_back({toCoord(to), exemplars[e]->grid->transform().indexToWorld(toVec(source.position)),
                            source.rotation});
    }
    return links;
}

// A vector that has a direction, turned as its place is.
template <typename Value>
Value turned(const Value& value, const Affine& turn) {
    if constexpr (std::is_same_v<Value, openvdb::Vec3f> || std::is_same_v<Value, openvdb::Vec3d>) {
        using Element = typename Value::value_type;
        const Vec3d to = transformed(turn, {double(value.x()), double(value.y()), double(value.z())});
        return Value(Element(to.x), Element(to.y), Element(to.z));
    } else {
        return value;
    }
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

// The value of the active voxel nearest to a place, within two of it.
template <typename Accessor, typename Value>
bool readNear(const Accessor& from, const openvdb::math::Transform& transform, const openvdb::Vec3d& world,
              Value& value) {
    static const std::vector<openvdb::Coord> steps = nearSteps();
    const openvdb::Coord middle = openvdb::Coord::round(transform.worldToIndex(world));
    return std::any_of(steps.begin(), steps.end(),
                       [&](const openvdb::Coord& step) { return from.probeValue(middle + step, value); });
}

// @param into  a grid of the same name and kind to write into, or null
template <typename Grid>
GridPtr readThrough(const Grid& grid, const std::vector<Link>& links, const openvdb::FloatGrid& result,
                    const GridPtr& into) {
    auto made = openvdb::gridPtrCast<Grid>(into);
    if (!made) {
        made = Grid::create(grid.background());
        made->insertMeta(grid);
        made->setName(grid.getName());
        made->setTransform(result.transform().copy());
    }
    const bool turns = grid.getVectorType() != openvdb::VEC_INVARIANT;
    Vec3f rotation;
    Affine turn = kIdentity;
    const auto from = grid.getConstAccessor();
    auto to = made->getAccessor();
    typename Grid::ValueType value;
    for (const Link& link : links) {
        if (!readNear(from, grid.transform(), link.from, value)) continue;
        const bool rotated = turns && rotates(link.rotation);
        if (rotated && length(link.rotation - rotation) > 0) {
            rotation = link.rotation;
            turn = turnBy(cast<double>(rotation));
        }
        to.setValueOn(link.to, rotated ? turned(value, turn) : value);
    }
    return made;
}

// Of each exemplar the grid of the same name and kind; null: it has none.
template <typename Grid>
std::vector<typename Grid::ConstPtr> sameGrids(const std::vector<const LevelSet*>& exemplars,
                                               const Grid& like) {
    std::vector<typename Grid::ConstPtr> grids(exemplars.size());
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        for (const GridPtr& grid : exemplars[e]->carried)
            if (!grids[e] && grid->getName() == like.getName()) grids[e] = openvdb::gridPtrCast<Grid>(grid);
    return grids;
}

// The mean of what all sources of a voxel have; nothing where none has a value.
template <typename Grid>
std::optional<typename Grid::ValueType> blended(const std::vector<Source>& sources,
                                                const std::vector<typename Grid::ConstPtr>& grids,
                                                const std::vector<const LevelSet*>& exemplars) {
    using Value = typename Grid::ValueType;
    using Element = typename openvdb::VecTraits<Value>::ElementType;
    // Differences from one value are summed, so that the mean of equal values is that value.
    Value base = openvdb::zeroVal<Value>(), sum = base, value;
    double total = 0;
    for (const Source& source : sources) {
        const std::size_t e = std::size_t(source.exemplar);
        const typename Grid::ConstPtr& grid = grids[e];
        if (!grid) continue;
        const openvdb::Vec3d world = exemplars[e]->grid->transform().indexToWorld(toVec(source.position));
        if (!readNear(grid->getConstUnsafeAccessor(), grid->transform(), world, value)) continue;
        if (rotates(source.rotation) && grid->getVectorType() != openvdb::VEC_INVARIANT)
            value = turned(value, turnBy(cast<double>(source.rotation)));
        if (total == 0) base = value;
        sum += (value - base) * Element(source.weight);
        total += double(source.weight);
    }
    if (total == 0) return std::nullopt;
    return Value(base + sum * Element(1 / total));
}

// Puts the mean of all sources in place of each value that was copied.
template <typename Grid>
void blendThrough(const SourceMap& map, const std::vector<const LevelSet*>& exemplars, Grid& carried,
                  const RunContext& ctx) {
    const std::vector<typename Grid::ConstPtr> grids = sameGrids(exemplars, carried);
    std::vector<typename Grid::TreeType::LeafNodeType*> leaves;
    carried.tree().voxelizeActiveTiles();
    carried.tree().getNodes(leaves);
    parallelFor(ctx, leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (auto it = leaves[i]->beginValueOn(); it; ++it)
                if (const auto mean =
                        blended<Grid>(votingSources(map, fromCoord(it.getCoord())), grids, exemplars))
                    it.setValue(*mean);
    });
}

}  // namespace

bool carries(const LevelSet& model, const std::string& name) {
    return std::any_of(model.carried.begin(), model.carried.end(),
                       [&](const GridPtr& grid) { return grid->getName() == name; });
}

void keepCarriedNames(LevelSet& model, const std::vector<std::string>& names) {
    model.carried.erase(std::remove_if(model.carried.begin(), model.carried.end(),
                                       [&](const GridPtr& grid) {
                                           return std::find(names.begin(), names.end(), grid->getName()) ==
                                                  names.end();
                                       }),
                        model.carried.end());
}

std::vector<GridPtr> carryThroughMap(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                                     const openvdb::FloatGrid& result, CarriedValues values,
                                     const RunContext& ctx) {
    bool any = false;
    for (const LevelSet* exemplar : exemplars) any = any || !exemplar->carried.empty();
    if (!any) return {};
    std::vector<GridPtr> carried = carryToVoxels(mappedVoxels(map, result, ctx), exemplars, result, {}, ctx);
    if (values == CarriedValues::Copied || map.method == MapMethod::Analogy) return carried;
    Stage stage(ctx, "blending attributes", carried.size());
    for (const GridPtr& grid : carried) {
        grid->apply<Blendable>([&](auto& typed) { blendThrough(map, exemplars, typed, ctx); });
        stage.advance();
    }
    return carried;
}

std::vector<GridPtr> carryToVoxels(const std::vector<MappedVoxel>& voxels,
                                   const std::vector<const LevelSet*>& exemplars,
                                   const openvdb::FloatGrid& result, std::vector<GridPtr> into,
                                   const RunContext& ctx) {
    std::vector<GridPtr> carried = std::move(into);
    if (voxels.empty()) return carried;
    Stage stage(ctx, "carrying attributes", exemplars.size());
    const std::vector<std::vector<Link>> links = linksOf(voxels, exemplars);
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        for (const GridPtr& grid : exemplars[e]->carried) {
            if (isOfSourceMap(grid->getName())) continue;
            const auto same = std::find_if(carried.begin(), carried.end(), [&](const GridPtr& other) {
                return other->getName() == grid->getName() && other->type() == grid->type();
            });
            const GridPtr existing = same != carried.end() ? *same : nullptr;
            GridPtr made;
            const bool read = grid->transform().isLinear() && grid->apply<Carriable>([&](const auto& typed) {
                made = readThrough(typed, links[e], result, existing);
            });
            if (!read)
                message(ctx, MessageLevel::Warning,
                        "grid \"" + grid->getName() + "\" (" + grid->valueType() +
                            ") cannot be carried and is left out");
            else if (!existing)
                carried.push_back(made);
        }
        stage.advance();
    }
    return carried;
}

}  // namespace vdbsynth
