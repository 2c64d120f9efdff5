#include "libvdbsynth/vdb/convert/band_grids.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

namespace vdbsynth {
namespace {

using VectorGrid = openvdb::Vec3SGrid;

// Every leaf of the level set as a leaf of a grid of its own kind, in the level set's order.
template <typename GridType>
std::vector<typename GridType::TreeType::LeafNodeType*> leavesOf(GridType& grid) {
    std::vector<typename GridType::TreeType::LeafNodeType*> leaves;
    for (auto leaf = grid.tree().beginLeaf(); leaf; ++leaf) leaves.push_back(leaf.getLeaf());
    return leaves;
}

// A grid to fill: one of the two kinds.
struct Filled {
    openvdb::FloatGrid::Ptr scalars;
    VectorGrid::Ptr vectors;
    std::vector<openvdb::FloatTree::LeafNodeType*> scalarLeaves;
    std::vector<VectorGrid::TreeType::LeafNodeType*> vectorLeaves;

    void set(std::size_t leaf, openvdb::Index offset, const float* values) const {
        if (scalars)
            scalarLeaves[leaf]->setValueOnly(offset, values[0]);
        else
            vectorLeaves[leaf]->setValueOnly(offset, {values[0], values[1], values[2]});
    }
    openvdb::GridBase::Ptr grid() const {
        if (scalars) return scalars;
        return vectors;
    }
};

Filled emptyGrid(const openvdb::FloatGrid& levelSet, const BandValue& value) {
    Filled filled;
    if (value.width == 1) {
        filled.scalars = openvdb::FloatGrid::create(
            std::make_shared<openvdb::FloatTree>(levelSet.tree(), 0.f, openvdb::TopologyCopy()));
        filled.scalarLeaves = leavesOf(*filled.scalars);
    } else {
        filled.vectors = VectorGrid::create(std::make_shared<VectorGrid::TreeType>(
            levelSet.tree(), openvdb::Vec3s(0.f), openvdb::TopologyCopy()));
        filled.vectorLeaves = leavesOf(*filled.vectors);
    }
    filled.grid()->setTransform(levelSet.transform().copy());
    filled.grid()->setName(value.name);
    return filled;
}

}  // namespace

std::vector<GridPtr> bandGrids(const openvdb::FloatGrid& levelSet, const std::vector<BandValue>& values,
                               const std::function<void(const Vec3d& world, float* out)>& read,
                               const RunContext& ctx) {
    std::vector<Filled> filled;
    std::size_t numbers = 0;
    for (const BandValue& value : values) {
        requireOption(value.width == 1 || value.width == 3, "width", std::to_string(value.width), "1 or 3");
        filled.push_back(emptyGrid(levelSet, value));
        numbers += value.width;
    }
    std::vector<const openvdb::FloatTree::LeafNodeType*> leaves;
    for (auto leaf = levelSet.tree().cbeginLeaf(); leaf; ++leaf) leaves.push_back(leaf.getLeaf());
    parallelFor(ctx, leaves.size(), 8, [&](std::size_t begin, std::size_t end) {
        std::vector<float> row(numbers);
        for (std::size_t n = begin; n < end; ++n)
            for (auto voxel = leaves[n]->cbeginValueOn(); voxel; ++voxel) {
                read(fromVec(levelSet.indexToWorld(voxel.getCoord())), row.data());
                const float* from = row.data();
                for (std::size_t v = 0; v < values.size(); from += values[v++].width)
                    filled[v].set(n, voxel.pos(), from);
            }
    });
    std::vector<GridPtr> grids;
    for (const Filled& of : filled) grids.push_back(of.grid());
    return grids;
}

}  // namespace vdbsynth
