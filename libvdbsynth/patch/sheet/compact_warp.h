#pragma once
#include "libvdbsynth/patch/place_warp.h"

#include <vector>

namespace vdbsynth {

/// A smooth warp that moves given centres by given amounts and nothing that is farther than `radius` from all
/// of them: x' = x + sum_i c_i phi(|x - p_i| / R), phi(r) = (1 - r)^4 (4 r + 1) for r < 1 [wendland1995],
/// with (Phi + lambda I) c = m. Where the centres' moves are all small beside R it does not fold; where it
/// would, it is shrunk (unfold).
class CompactWarp {
public:
    /// @param centres, moves  of the same number, at most kMostCentres; lambda is 0.02
    /// @param radius  [as the centres] over 0
    /// @throw Error ShapeMismatch, InvalidOption
    /// @par Cost    O(centres^3)   @par Repeats yes
    CompactWarp(std::vector<Vec3d> centres, const std::vector<Vec3d>& moves, double radius);

    static constexpr std::size_t kMostCentres = 1024;

    bool empty() const { return mCentres.empty(); }
    /// @par Cost    O(centres)
    WarpedPlace at(const Vec3d& place) const;
    /// Halves the moves until det J is above `least` at all places, and says where it then takes them.
    /// @par Cost    of `at` for each place, however often the moves are halved
    struct Unfolded {
        double factor = 1;  ///< of the moves; 0 where eight halvings were not enough: the warp is empty then
        std::vector<WarpedPlace> places;
    };
    Unfolded unfold(const std::vector<Vec3d>& places, double least = 0.2);

private:
    template <typename Visit>
    void forNear(const Vec3f& place, Visit&& visit) const;

    std::vector<Vec3d> mCentres, mWeights;
    std::vector<float> mX, mY, mZ;  // of the centres: what is near is found eight at once
    double mRadius;
};

}  // namespace vdbsynth
