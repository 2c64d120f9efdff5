#pragma once
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vdbsynth {

/// Numbered places by cubic cells, for all that may be within a cell's side of a place. Unlike
/// PointNeighbours it grows, and a query costs the few places around, not the logarithm of all.
class PointCells {
public:
    /// @param side  [world] of a cell
    /// @throw Error InvalidOption (a side that is not above 0)
    explicit PointCells(double side);
    /// With all points in it, by their number.
    PointCells(const std::vector<Vec3f>& points, double side);

    /// @param place  finite   @par Cost    O(1)
    void add(const Vec3d& place, std::uint32_t number);

    /// Calls visit(number) for all that lie in the place's cell or one of the 26 around it: all that are
    /// within a side, and others, whose distance the caller looks at. In ascending order of cells, then in
    /// the order of adding.
    /// @par Cost    O(27 + visited)   @par Repeats yes
    template <typename Visit>
    void near(const Vec3d& place, const Visit& visit) const {
        anyNear(place, [&](std::uint32_t number) {
            visit(number);
            return false;
        });
    }

    /// Whether holds(number) for any of these; none is asked after the first that does.
    template <typename Holds>
    bool anyNear(const Vec3d& place, const Holds& holds) const {
        bool found = false;
        forEachVoxel(IndexBox{{-1, -1, -1}, {1, 1, 1}}, [&](const Index3& step) {
            if (found) return;
            const auto cell = mCells.find(keyOf(place, step));
            if (cell == mCells.end()) return;
            for (const std::uint32_t number : cell->second)
                if (holds(number)) {
                    found = true;
                    return;
                }
        });
        return found;
    }

private:
    std::uint64_t keyOf(const Vec3d& place, const Index3& step) const;

    double mSide;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> mCells;
};

}  // namespace vdbsynth
