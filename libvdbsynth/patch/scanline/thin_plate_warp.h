#pragma once
#include "libvdbsynth/patch/place_warp.h"

#include <vector>

namespace vdbsynth {

/// The thin-plate spline in three dimensions through pairs of places [bookstein1989; duranleau2006, 5.2]:
/// x' = A x + b + sum_i w_i |x - p_i|, sum w_i = 0, sum w_i p_i^T = 0.
class ThinPlateWarp {
public:
    /// @param from, to  of the same number, at least 4 that lie on no plane, at most 4096; places of `from`
    /// that coincide are averaged by the smoothing
    /// @param smoothing  at least 0, of the diagonal: 0 goes through all pairs
    /// @throw Error ShapeMismatch, InvalidOption (too few or too many)
    /// @par Cost    O(pairs^3)   @par Repeats yes
    ThinPlateWarp(std::vector<Vec3d> from, const std::vector<Vec3d>& to, double smoothing = 0);

    static constexpr std::size_t kLeastPairs = 4, kMostPairs = 4096;

    /// @par Cost    O(pairs)
    WarpedPlace at(const Vec3d& place) const;

private:
    std::vector<Vec3d> mFrom, mWeights;
    Vec3d mMiddle, mConstant;
    Vec3d mLinear[3];  // columns of A
};

}  // namespace vdbsynth
