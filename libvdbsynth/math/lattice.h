#pragma once
#include "libvdbsynth/math/index_box.h"

#include <array>
#include <cstddef>

// The words for loops over voxels: every voxel of a box, a voxel's place in an array, its neighbours.
namespace vdbsynth {

/// Calls visit(p) for every voxel of a box, x slowest, z fastest; none if it is empty.
/// @param step  from one visited voxel to the next along each axis, at least 1
template <typename Visit>
void forEachVoxel(const IndexBox& box, const Visit& visit, int step = 1) {
    for (int x = box.min.x; x <= box.max.x; x += step)
        for (int y = box.min.y; y <= box.max.y; y += step)
            for (int z = box.min.z; z <= box.max.z; z += step) visit(Index3{x, y, z});
}

/// Number of voxels in a box of this size; every side at least 0.
inline std::size_t latticeCount(const Index3& size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// Place of voxel p of a box that begins at 0 in an array, x slowest, z fastest. @param p  within `size`
inline std::size_t latticeIndex(const Index3& p, const Index3& size) {
    return (std::size_t(p.x) * std::size_t(size.y) + std::size_t(p.y)) * std::size_t(size.z) +
           std::size_t(p.z);
}

/// The inverse of latticeIndex. @param i  under latticeCount(size)
inline Index3 latticeVoxel(std::size_t i, const Index3& size) {
    const std::size_t row = i / std::size_t(size.z);
    return {int(row / std::size_t(size.y)), int(row % std::size_t(size.y)), int(i % std::size_t(size.z))};
}

/// Steps to the six neighbours by faces: low and high x, y, z.
inline constexpr std::array<Index3, 6> kFaceNeighbours{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// Steps to the 26 neighbours by faces, edges and corners, x slowest, z fastest.
inline constexpr std::array<Index3, 26> kAllNeighbours = [] {
    std::array<Index3, 26> steps{};
    std::size_t n = 0;
    for (int i = 0; i < 27; ++i)
        if (i != 13) steps[n++] = Index3{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
    return steps;
}();

}  // namespace vdbsynth
