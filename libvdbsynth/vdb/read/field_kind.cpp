#include "libvdbsynth/vdb/read/field_kind.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr std::size_t kFewest = 8;  // voxels that tell something

// The slopes at one voxel, by central and by upwind differences [value per voxel along each axis].
struct Slopes {
    openvdb::Vec3d central, upwind;
};

// @return false unless the voxel lies next to the zero level, amid active voxels
bool slopesAt(const openvdb::FloatGrid::ConstAccessor& accessor, const openvdb::Coord& at, float value,
              Slopes& slopes) {
    bool crosses = false;
    const double sign = value < 0 ? -1 : 1;
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Coord low = at, high = at;
        --low[axis];
        ++high[axis];
        float before = 0, after = 0;
        if (!accessor.probeValue(low, before) || !accessor.probeValue(high, after)) return false;
        crosses = crosses || (before < 0) != (value < 0) || (after < 0) != (value < 0);
        slopes.central[axis] = (double(after) - double(before)) / 2;
        const double dropLow = sign * (double(value) - double(before)),
                     dropHigh = sign * (double(value) - double(after));
        slopes.upwind[axis] = std::max({0.0, dropLow, dropHigh}) * (dropHigh > dropLow ? -1 : 1);
    }
    return crosses;
}

// The one that is closer to 1: on the ridge inside a wall a true distance has no central slope.
double closerToOne(double a, double b) {
    return std::abs(a - 1) < std::abs(b - 1) ? a : b;
}

}  // namespace

DistanceFit distanceFitOf(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    DistanceFit fit;
    if (!grid.transform().isLinear()) return fit;
    openvdb::Mat3d toWorld;
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d unit(0);
        unit[axis] = 1;
        toWorld.setCol(axis, grid.transform().baseMap()->applyIJT(unit));
    }
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    std::vector<std::vector<std::pair<double, double>>> found(leaves.size());
    parallelFor(ctx, leaves.size(), 32, [&](std::size_t begin, std::size_t end) {
        const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
        for (std::size_t i = begin; i < end; ++i)
            for (auto it = leaves[i]->cbeginValueOn(); it; ++it) {
                Slopes slopes;
                if (slopesAt(accessor, it.getCoord(), *it, slopes))
                    found[i].push_back(
                        {closerToOne((toWorld * slopes.central).length(), (toWorld * slopes.upwind).length()),
                         closerToOne(slopes.central.length(), slopes.upwind.length())});
            }
    });
    std::vector<double> world;
    std::size_t inWorld = 0, inVoxels = 0;
    for (const auto& some : found)
        for (const auto& [perUnit, perVoxel] : some) {
            world.push_back(perUnit);
            inWorld += std::abs(perUnit - 1) <= 0.1 ? 1 : 0;
            inVoxels += std::abs(perVoxel - 1) <= 0.1 ? 1 : 0;
        }
    fit.measured = world.size();
    if (fit.measured < kFewest) return fit;
    fit.worldShare = double(inWorld) / double(world.size());
    fit.voxelShare = double(inVoxels) / double(world.size());
    const auto middle = world.begin() + std::ptrdiff_t(world.size() / 2);
    std::nth_element(world.begin(), middle, world.end());
    fit.slope = *middle;
    const auto uniform = std::count_if(world.begin(), world.end(), [&](double slope) {
        return std::abs(slope - fit.slope) <= 0.1 * fit.slope;
    });
    fit.uniformShare = double(uniform) / double(world.size());
    return fit;
}

FloatGridPtr withSurfaceVoxels(const openvdb::FloatGrid& grid) {
    if (grid.background() != 0) return nullptr;
    // Beyond the active voxels nothing is known: the surface may leave them there.
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    std::vector<openvdb::Coord> found;
    const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
        for (auto it = leaf->cbeginValueOff(); it; ++it) {
            if (*it != 0 || !box.isInside(it.getCoord())) continue;
            bool negative = false, positive = false;
            for (const Index3& step : kAllNeighbours) {
                float value = 0;
                if (!accessor.probeValue(it.getCoord() + toCoord(step), value)) continue;
                negative = negative || value < 0;
                positive = positive || value > 0;
            }
            if (negative && positive) found.push_back(it.getCoord());
        }
    if (found.empty()) return nullptr;
    const FloatGridPtr copy = grid.deepCopy();
    for (const openvdb::Coord& at : found) copy->tree().setValueOn(at, 0.f);
    return copy;
}

namespace {

// Most voxels lie at one of two opposite ends, as truncated distances do.
bool isClamped(const openvdb::FloatGrid& grid, const ValueRange& range) {
    if (std::abs(range.minimum + range.maximum) > 1e-3 * range.maximum) return false;
    const float end = float(0.999 * range.maximum);
    std::uint64_t ends = 0, all = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        all += it.getVoxelCount();
        if (std::abs(*it) >= end) ends += it.getVoxelCount();
    }
    return ends > all / 3;
}

}  // namespace

FieldKind kindOf(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return FieldKind::LevelSet;
    if (grid.getGridClass() != openvdb::GRID_UNKNOWN) return FieldKind::Density;
    const ValueRange range = rangeOf(grid);
    if (!range.finite || range.minimum >= 0 || range.maximum <= 0) return FieldKind::Density;
    const FloatGridPtr whole = withSurfaceVoxels(grid);
    const DistanceFit fit = distanceFitOf(whole ? *whole : grid, ctx);
    if (fit.inWorldUnits() || fit.inVoxels() || (fit.uniformShare >= 0.6 && isClamped(grid, range)))
        return FieldKind::Distances;
    // A band so narrow that no voxel has all its neighbours: by its form.
    const double background = std::abs(double(grid.background()));
    const bool thin = fit.measured < kFewest && background > 0 && range.maximum <= background * 1.001 &&
                      range.minimum >= -background * 1.001;
    return thin ? FieldKind::Distances : FieldKind::Density;
}

}  // namespace vdbsynth
