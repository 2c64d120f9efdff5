#include "libvdbsynth/vdb/attribute_transfer.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace vdbsynth {
namespace {

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

// A vector that has a direction, rotated with its place.
template <typename Value>
Value rotatedValue(const Value& value, const Affine& matrix) {
    if constexpr (std::is_same_v<Value, openvdb::Vec3f> || std::is_same_v<Value, openvdb::Vec3d>) {
        using Element = typename Value::value_type;
        const Vec3d to = transformed(matrix, {double(value.x()), double(value.y()), double(value.z())});
        return Value(Element(to.x), Element(to.y), Element(to.z));
    } else {
        return value;
    }
}

// Offsets of the voxels within a distance, nearest first.
std::vector<openvdb::Coord> stepsWithin(int distance) {
    std::vector<openvdb::Coord> steps;
    forEachVoxel(IndexBox::cube({-2, -2, -2}, 5), [&](const Index3& p) { steps.push_back(toCoord(p)); });
    const auto squared = [](const openvdb::Coord& c) {
        return c.x() * c.x() + c.y() * c.y() + c.z() * c.z();
    };
    std::stable_sort(steps.begin(), steps.end(), [&](const openvdb::Coord& a, const openvdb::Coord& b) {
        return squared(a) < squared(b);
    });
    steps.erase(std::remove_if(steps.begin(), steps.end(),
                               [&](const openvdb::Coord& c) { return squared(c) > distance * distance; }),
                steps.end());
    return steps;
}

// The value of the active voxel nearest to a position, within a distance of it.
template <typename Accessor, typename Value>
bool readNear(const Accessor& from, const openvdb::math::Transform& transform, const openvdb::Vec3d& world,
              Value& value, int within = 2) {
    static const std::vector<openvdb::Coord> all[3] = {stepsWithin(0), stepsWithin(1), stepsWithin(2)};
    const std::vector<openvdb::Coord>& steps = all[within];
    const openvdb::Coord middle = openvdb::Coord::round(transform.worldToIndex(world));
    return std::any_of(steps.begin(), steps.end(),
                       [&](const openvdb::Coord& step) { return from.probeValue(middle + step, value); });
}

// @param into  a grid of the same name and kind to write into, or null
template <typename Grid>
GridPtr readThrough(const Grid& grid, const std::vector<Link>& links, const openvdb::FloatGrid& result,
                    const GridPtr& into, int within) {
    auto made = openvdb::gridPtrCast<Grid>(into);
    if (!made) {
        made = openvdb::gridPtrCast<Grid>(anyKind(grid).copyGridWithNewTree());
        made->setTransform(result.transform().copy());
    }
    const bool directional = grid.getVectorType() != openvdb::VEC_INVARIANT;
    Vec3f rotation;
    Affine matrix = kIdentity;
    const auto from = grid.getConstAccessor();
    auto to = made->getAccessor();
    typename Grid::ValueType value;
    for (const Link& link : links) {
        if (!readNear(from, grid.transform(), link.from, value, within)) continue;
        const bool rotated = directional && rotates(link.rotation);
        if (rotated && rotates(link.rotation - rotation)) {
            rotation = link.rotation;
            matrix = rotationMatrix(cast<double>(rotation));
        }
        to.setValueOn(link.to, rotated ? rotatedValue(value, matrix) : value);
    }
    return made;
}

// The grid of each exemplar with the same name and kind; null: none.
template <typename Grid>
std::vector<typename Grid::ConstPtr> sameGrids(const std::vector<const LevelSet*>& exemplars,
                                               const Grid& like) {
    std::vector<typename Grid::ConstPtr> grids(exemplars.size());
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        for (const GridPtr& grid : exemplars[e]->attributes)
            if (!grids[e] && grid->getName() == like.getName()) grids[e] = openvdb::gridPtrCast<Grid>(grid);
    return grids;
}

// The mean over all sources of a voxel; nothing if none has a value.
template <typename Grid>
std::optional<typename Grid::ValueType> blended(const std::vector<Source>& sources,
                                                const std::vector<typename Grid::ConstPtr>& grids,
                                                const std::vector<const LevelSet*>& exemplars) {
    using Value = typename Grid::ValueType;
    using Element = typename openvdb::VecTraits<Value>::ElementType;
    // Differences from one value are summed, so that the mean of equal values is exactly that value.
    Value base = openvdb::zeroVal<Value>(), sum = base, value;
    double total = 0;
    for (const Source& source : sources) {
        const std::size_t e = std::size_t(source.exemplar);
        const typename Grid::ConstPtr& grid = grids[e];
        if (!grid) continue;
        const openvdb::Vec3d world = exemplars[e]->grid->transform().indexToWorld(toVec(source.position));
        if (!readNear(grid->getConstUnsafeAccessor(), grid->transform(), world, value)) continue;
        if (rotates(source.rotation) && grid->getVectorType() != openvdb::VEC_INVARIANT)
            value = rotatedValue(value, rotationMatrix(cast<double>(source.rotation)));
        if (total == 0) base = value;
        sum += (value - base) * Element(source.weight);
        total += double(source.weight);
    }
    if (total == 0) return std::nullopt;
    return Value(base + sum * Element(1 / total));
}

// Replaces each copied value by the mean over all sources.
template <typename Grid>
void blendThrough(const SourceMap& map, const std::vector<const LevelSet*>& exemplars, Grid& attributes,
                  const RunContext& ctx) {
    const std::vector<typename Grid::ConstPtr> grids = sameGrids(exemplars, attributes);
    std::vector<typename Grid::TreeType::LeafNodeType*> leaves;
    attributes.tree().voxelizeActiveTiles();
    attributes.tree().getNodes(leaves);
    parallelFor(ctx, leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (auto it = leaves[i]->beginValueOn(); it; ++it)
                if (const auto mean =
                        blended<Grid>(votingSources(map, fromCoord(it.getCoord())), grids, exemplars))
                    it.setValue(*mean);
    });
}

}  // namespace

bool hasAttribute(const LevelSet& model, const std::string& name) {
    return std::any_of(model.attributes.begin(), model.attributes.end(),
                       [&](const GridPtr& grid) { return grid->getName() == name; });
}

void keepAttributes(LevelSet& model, const std::vector<std::string>& names) {
    model.attributes.erase(std::remove_if(model.attributes.begin(), model.attributes.end(),
                                          [&](const GridPtr& grid) {
                                              return std::find(names.begin(), names.end(), grid->getName()) ==
                                                     names.end();
                                          }),
                           model.attributes.end());
}

std::vector<GridPtr> transferAttributes(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                                        const openvdb::FloatGrid& result, AttributeValues values,
                                        const RunContext& ctx) {
    bool any = false;
    for (const LevelSet* exemplar : exemplars) any = any || !exemplar->attributes.empty();
    if (!any) return {};
    std::vector<GridPtr> attributes =
        transferToVoxels(mappedVoxels(map, result, ctx), exemplars, result, {}, ctx);
    if (map.method == MapMethod::Analogy) return attributes;
    attributes = transferBeyondBand(map, exemplars, result, std::move(attributes), ctx);
    if (values == AttributeValues::Copied) return attributes;
    Stage stage(ctx, "blending attributes", attributes.size());
    for (const GridPtr& grid : attributes) {
        grid->apply<RealGrids>([&](auto& typed) { blendThrough(map, exemplars, typed, ctx); });
        stage.advance();
    }
    return attributes;
}

std::vector<GridPtr> transferToVoxels(const std::vector<MappedVoxel>& voxels,
                                      const std::vector<const LevelSet*>& exemplars,
                                      const openvdb::FloatGrid& result, std::vector<GridPtr> into,
                                      const RunContext& ctx, int within) {
    std::vector<GridPtr> attributes = std::move(into);
    if (voxels.empty()) return attributes;
    const std::vector<std::vector<Link>> links = linksOf(voxels, exemplars);
    Stage stage(ctx, "transferring attributes", links.size());
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        for (const GridPtr& grid : exemplars[e]->attributes) {
            if (isOfSourceMap(grid->getName())) continue;
            const auto same = std::find_if(attributes.begin(), attributes.end(), [&](const GridPtr& other) {
                return other->getName() == grid->getName() && other->type() == grid->type();
            });
            const GridPtr existing = same != attributes.end() ? *same : nullptr;
            GridPtr made;
            const bool read =
                grid->transform().isLinear() && grid->apply<AttributeGrids>([&](const auto& typed) {
                    made = readThrough(typed, links[e], result, existing, within);
                });
            if (!read)
                message(ctx, MessageLevel::Warning,
                        "grid \"" + grid->getName() + "\" (" + grid->valueType() +
                            ") cannot be transferred and is left out");
            else if (!existing)
                attributes.push_back(made);
        }
        stage.advance();
    }
    return attributes;
}

}  // namespace vdbsynth
