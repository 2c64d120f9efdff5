#pragma once
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/search/block_index.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace vdbsynth {

/// Positions first, first + 1, ..., first + length - 1, along z.
struct PositionRun {
    std::uint64_t first = 0;
    std::uint32_t length = 0;
};

/// Nodes whose first positions are in one cube of side kNodeGroup form a group; groups in one cube of side
/// kNodeCube are consecutive and bounded together.
inline constexpr int kNodeGroup = 4, kNodeCube = 8;

inline Index3 cubeCorner(const Index3& p) {
    return {p.x / kNodeCube * kNodeCube, p.y / kNodeCube * kNodeCube, p.z / kNodeCube * kNodeCube};
}
inline std::size_t placeInCube(const Index3& p) {
    return std::size_t((p.x % kNodeCube * kNodeCube + p.y % kNodeCube) * kNodeCube + p.z % kNodeCube);
}

/// A run of nodes whose positions are neighbours, with the range of each of their eight coarsest means.
struct BlockGroup {
    IndexBox box;                       // of the nodes' first positions
    std::uint32_t first = 0, last = 0;  // nodes
    bool shared = false;                // some node represents several positions, which may lie anywhere
    std::array<float, 8> low, high;
};

/// The field that bounds of one level are read from: in bricks, or as one array if nearly all of it varies.
struct LevelField {
    std::shared_ptr<const BrickField> bricks;  ///< null where `dense` is not empty
    DenseField dense;                          ///< kNodeCube voxels longer than the field along each axis

    float at(const Index3& p) const {
        return dense.samples.empty() ? bricks->inside(p) : *dense.row(p.x, p.y, p.z);
    }
    std::size_t memoryBytes() const {
        return (bricks ? bricks->memoryBytes() : 0) + dense.samples.size() * sizeof(float);
    }
};

/// The search tree as flat arrays, read by block_index.cpp and built by block_index_build.cpp.
struct BlockIndexData {
    std::shared_ptr<const BrickField> exemplar;
    std::shared_ptr<const BrickField> maskMeans;  // mean of the mask over each block; null: all are eligible
    int block = 0;
    float largest = 0;              // largest |sample|
    IndexBox positions;             // of block minimum corners
    std::vector<int> cells;         // sides of the means' cubes, coarse to fine
    std::vector<LevelField> means;  // one field a level, and the exemplar itself
    std::vector<BlockGroup> groups;
    std::vector<std::uint16_t> places;       // placeInCube of each node's first position
    std::vector<std::uint64_t> nodes;        // first position of each node, as its number in `positions`
    std::vector<std::uint32_t> memberBegin;  // [nodes + 1] into members
    std::vector<PositionRun> members;        // further positions of shared nodes, ascending

    Index3 positionOf(std::uint64_t number) const { return latticeVoxel(number, positions.size()); }
    std::uint64_t numberOf(const Index3& p) const { return latticeIndex(p, positions.size()); }
    Index3 position(std::uint32_t node) const { return positionOf(nodes[node]); }
    /// blockCost, from the representation that is fastest to read.
    double cost(const Index3& position, const BlockQuery& query, std::int64_t known, double giveUp) const;
    bool isShared(std::uint32_t node) const { return memberBegin[node] != memberBegin[node + 1]; }
    bool eligible(const Index3& p) const;
    std::size_t nodeCount() const { return nodes.size(); }
    std::size_t memoryBytes() const;

    /// Calls visit(position) for the node's positions inside `box`, ascending, until it returns false.
    template <typename Visit>
    void forMembers(std::uint32_t node, const IndexBox& box, Visit&& visit) const {
        const Index3 first = position(node);
        if (box.contains(first) && !visit(first)) return;
        const auto begin = members.begin() + std::ptrdiff_t(memberBegin[node]),
                   end = members.begin() + std::ptrdiff_t(memberBegin[node + 1]);
        const std::uint64_t low = numberOf(box.min), last = numberOf(box.max);
        auto run = std::partition_point(begin, end,
                                        [low](const PositionRun& r) { return r.first + r.length <= low; });
        for (; run != end && run->first <= last; ++run) {
            Index3 p = positionOf(run->first);  // a run stays in one row of z
            if (p.x < box.min.x || p.x > box.max.x || p.y < box.min.y || p.y > box.max.y) continue;
            const int stop = std::min(box.max.z, p.z + int(run->length) - 1);
            for (p.z = std::max(box.min.z, p.z); p.z <= stop; ++p.z)
                if (!visit(p)) return;
        }
    }
};

/// Box of all minimum corners of blocks inside a field. @throw Error Unusable (block larger than the field)
IndexBox blockPositions(const BrickField& exemplar, int block);
bool blockInsideMask(const BrickField& mask, const Index3& corner, int block);
BlockIndexData buildBlockIndexData(std::shared_ptr<const BrickField> exemplar,
                                   const BlockIndexOptions& options, const RunContext& ctx);

}  // namespace vdbsynth
