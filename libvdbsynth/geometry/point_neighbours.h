#pragma once
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// Nearest neighbours in a set of points (nanoflann's kd-tree, exact).
class PointNeighbours {
public:
    /// @param points  borrowed for the lifetime of this; finite
    explicit PointNeighbours(const std::vector<Vec3f>& points);
    ~PointNeighbours();
    PointNeighbours(const PointNeighbours&) = delete;
    PointNeighbours& operator=(const PointNeighbours&) = delete;

    /// The `count` nearest points, nearest first. May be called from many threads.
    /// @param numbers, squared  arrays of `count`
    /// @return number found: fewer only if the set is smaller
    /// @par Repeats yes, also for equal distances
    std::size_t nearest(const Vec3f& place, std::size_t count, std::uint32_t* numbers, float* squared) const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

}  // namespace vdbsynth
