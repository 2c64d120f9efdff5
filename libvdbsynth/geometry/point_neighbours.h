#pragma once
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// The nearest of a set of points (a kd-tree of nanoflann's, exact).
class PointNeighbours {
public:
    /// @param points  borrowed for the life of this; finite
    explicit PointNeighbours(const std::vector<Vec3f>& points);
    ~PointNeighbours();
    PointNeighbours(const PointNeighbours&) = delete;
    PointNeighbours& operator=(const PointNeighbours&) = delete;

    /// The `count` nearest points, nearest first. May be called from many threads.
    /// @param numbers, squared  room for `count`
    /// @return how many there are: fewer only if the set is smaller
    /// @par Repeats yes, equal distances too
    std::size_t nearest(const Vec3f& place, std::size_t count, std::uint32_t* numbers, float* squared) const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

}  // namespace vdbsynth
