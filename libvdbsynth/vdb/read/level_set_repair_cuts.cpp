#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/read/level_set_repair_steps.h"
#include "libvdbsynth/vdb/read/neighbour_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

// Two voxels, or squares of them, on two sides of a cut.
struct Cut {
    openvdb::Coord inside, outside;
    int span, face;  // 0 low x, 1 high x, 2 low y ...
};

Cut cutAt(const VoxelPair& pair) {
    const bool insideA = pair.valueA < 0;
    Cut cut{insideA ? pair.a : pair.b, insideA ? pair.b : pair.a, pair.span, 0};
    for (int axis = 0; axis < 3; ++axis)
        if (cut.inside[axis] != cut.outside[axis])
            cut.face = 2 * axis + (cut.outside[axis] > cut.inside[axis] ? 1 : 0);
    return cut;
}

// Steps from the inside to an inactive outside, by more than distances differ.
std::vector<Cut> cutsOf(const openvdb::FloatGrid& grid, double unit) {
    std::vector<Cut> cuts;
    const auto take = [&](const VoxelPair& pair) {
        const bool insideA = pair.valueA < 0;
        if (insideA == (pair.valueB < 0) || (insideA ? pair.activeB : pair.activeA)) return;
        if (std::abs(double(pair.valueA) - double(pair.valueB)) > 1.5 * unit) cuts.push_back(cutAt(pair));
    };
    const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) forEachPairOfLeaf(*leaf, accessor, take);
    forEachPairOfTiles(grid.tree(), take);
    return cuts;
}

void close(openvdb::FloatGrid::Accessor& accessor, const Cut& cut, float half) {
    const int axis = cut.face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < cut.span; ++i)
        for (int j = 0; j < cut.span; ++j) {
            openvdb::Coord inside = cut.inside, outside = cut.outside;
            inside[u] += i, outside[u] += i;
            inside[v] += j, outside[v] += j;
            accessor.setValue(inside, std::max(accessor.getValue(inside), -half));
            accessor.setValue(outside, half);
        }
}

// The sides of which most of the area that is open lies in the outermost plane.
CutFaces planesOf(const std::vector<Cut>& cuts) {
    std::array<double, 6> open{}, outermost{};
    std::array<int, 6> plane{};
    for (const Cut& cut : cuts) {
        const std::size_t face = std::size_t(cut.face);
        const double area = double(cut.span) * double(cut.span);
        const int at = cut.face % 2 ? cut.inside[cut.face / 2] : -cut.inside[cut.face / 2];
        if (open[face] == 0 || at > plane[face]) {
            plane[face] = at;
            outermost[face] = 0;
        }
        open[face] += area;
        if (at == plane[face]) outermost[face] += area;
    }
    CutFaces planes{};
    for (std::size_t face = 0; face < 6; ++face) planes[face] = outermost[face] > 0.5 * open[face];
    return planes;
}

}  // namespace

ClosedCuts closedCuts(openvdb::FloatGrid& grid, double unit, const RunContext& ctx) {
    static constexpr std::array<const char*, 6> kFaces{"low x",  "high x", "low y",
                                                       "high y", "low z",  "high z"};
    const std::vector<Cut> cuts = cutsOf(grid, unit);
    double voxels = 0;
    std::array<bool, 6> open{};
    for (const Cut& cut : cuts) {
        voxels += double(cut.span) * double(cut.span);
        open[std::size_t(cut.face)] = true;
    }
    requireMemory(ctx, voxels * 80, "closing a level set that is cut open", "use larger voxels");
    openvdb::FloatGrid::Accessor accessor = grid.getAccessor();
    for (const Cut& cut : cuts) close(accessor, cut, float(unit / 2));
    ClosedCuts closed;
    for (std::size_t face = 0; face < 6; ++face)
        if (open[face]) closed.names += std::string(closed.names.empty() ? "" : ", ") + kFaces[face];
    closed.planes = planesOf(cuts);
    return closed;
}

}  // namespace vdbsynth
