#pragma once
#include "libvdbsynth/geometry/mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A point of a plane on a grid so coarse that the products of two differences are exact: both coordinates
/// are from 0 to kPlaneMost.
struct PlanePoint {
    std::int64_t x = 0, y = 0;

    bool operator==(const PlanePoint& other) const { return x == other.x && y == other.y; }
};
inline constexpr std::int64_t kPlaneMost = (std::int64_t(1) << 31) - 1;

/// Twice the signed area of a triangle, exact; positive if it runs counter-clockwise.
inline std::int64_t doubleArea(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Triangulates polygons by cutting off one corner after the other. An object keeps its buffers, so that
/// many small polygons cost no allocations.
class EarClipper {
public:
    /// n - 2 triangles of places in `ring`, which runs counter-clockwise. They cover the polygon exactly,
    /// touch every corner and keep its edges, collinear corners included; the ring may touch itself and may
    /// go along an edge twice, as the bridge to a hole does. Triangles of zero area come only where the ring
    /// has a spike or a corner twice.
    /// @return false if the ring crosses itself so that some triangles are flipped or overlap; their signed
    ///         areas still add up to that of the ring
    /// @par Cost    about O(n log n); O(n sqrt n) at most, with a large constant, for rings that cross
    /// themselves
    /// @par Repeats yes
    bool triangulate(const std::vector<PlanePoint>& ring, std::vector<Triangle>& triangles);

private:
    enum class Rule { Strict, DiagonalMayTouch, FlatToo, Convex };
    /// Of a tree of boxes around corners that are near each other; the children of i are 2 i and 2 i + 1.
    struct Box {
        PlanePoint low, high;
        std::uint32_t left = 0;  ///< corners in it that are not cut off yet
    };

    void start(const std::vector<PlanePoint>& ring);
    void buildBox(std::size_t box, std::size_t firstLeaf, std::size_t leaves);
    std::size_t leafBegin(std::size_t leaf) const { return mSorted.size() * leaf / mLeaves; }
    bool isSpikeAt(std::uint32_t corner) const;
    void enqueue(std::uint32_t corner);
    std::uint32_t nextEar();
    bool isEar(std::uint32_t corner, Rule rule);
    bool isBlocked(const std::uint32_t (&ear)[3], Rule rule);
    bool blocks(std::uint32_t corner, const std::uint32_t (&ear)[3], Rule rule) const;
    void unlink(std::uint32_t corner);

    const PlanePoint* mRing = nullptr;
    std::vector<std::uint32_t> mNext, mPrevious;  // of the corners that are left; kGone for the others
    std::size_t mLeft = 0;
    std::uint32_t mFirst = 0;            // a corner that is left
    std::vector<std::uint32_t> mSpikes;  // corners without area, to cut at once
    std::vector<std::uint32_t> mQueue;   // corners to try, some of them outdated
    std::vector<std::size_t> mEntry;     // the valid place of each corner in the queue
    std::size_t mHead = 0;
    std::size_t mLeaves = 1;  // a power of two
    std::vector<Box> mBoxes;
    std::vector<std::uint32_t> mSorted;  // corners by leaf
    std::vector<std::uint32_t> mLeafOf;
    double mWork = 0, mMostWork = 0;  // corners and boxes looked at
    std::size_t mSecondLooks = 0;
    bool mSimple = true;
};

}  // namespace vdbsynth
