#pragma once
#include "libvdbsynth/math/vec3.h"

#include <cstddef>

namespace vdbsynth {

/// A place in a flat patch. Lengths of charts are in spacings: the mean distance of a point to its nearest.
struct ChartPosition {
    double x = 0, y = 0;
};

/// Where a point lies in a patch and how the patch stands there: x along s, y along n x s [zhang2004, 3.2].
struct ChartSite {
    ChartPosition q;
    Vec3d n, s;  ///< of length 1, perpendicular
};

/// What one patch point says of a point beside it.
struct ChartEstimate {
    ChartSite site;
    Vec3d t;            ///< n x s
    double weight = 0;  ///< 1 / distance [1 / spacings]
};

/// Weights of the distortion [zhang2004, Eq. 2 to 4].
struct ChartDistortion {
    double w1 = 1, w2 = 1;   ///< mean against maximum, of positions and of orientations, at least 0
    double w3 = 3, w4 = 2;   ///< orientations and positions, at least 0
    double threshold = 1.6;  ///< a point above it becomes a gap, at least 0
};

/// Continues the patch from one of its points P to F = P + v [zhang2004, appendix A, corrected]:
///     v0 = v / |v|,  c = (v0.s_P, v0.t_P) / |(v0.s_P, v0.t_P)|,  q_F = q_P + |v| c
///     n_F = normalised(n_P - (v0.n_P) v0),  t_F = c_2 v0 + c_1 (n_F x v0),  s_F = t_F x n_F
/// The paper prints v0.s_P and v0.t_P in place of c, which shrinks the frame wherever v leaves the tangent
/// plane, and leaves q_P out.
/// @param v  [spacings] not 0
/// @return false, and no estimate, where |v0.n_P| > 1 - 1e-6: F lies along the normal
bool continueChart(const ChartSite& p, const Vec3d& v, ChartEstimate& estimate);

/// The mean of estimates by their weights, on the surface: n is the point's normal, s the direction of the
/// mean of s, made perpendicular to n. Deviation: the paper takes the mean of n as well, which lags behind
/// the surface, as each estimate's n is that of half the way; a cylinder's charts are then longer by 0.6 % at
/// s/r = 0.03, of which this leaves 0.04 %.
/// @param count   at least 1
/// @param normal  the surface's at the point, length 1
ChartSite meanSite(const ChartEstimate* estimates, std::size_t count, const Vec3d& normal);

/// How far estimates differ from their mean [zhang2004, Eq. 2 to 4]:
///     D_pos = w1 sum(w |q_l - q|) / sum(w) + max(w |q_l - q|),
///     D_ori = w2 sum(w o_l) / sum(w) + max(w o_l),  o_l = 2 - s_l.s - t_l.t,   D = w3 D_ori + w4 D_pos
double chartDistortion(const ChartEstimate* estimates, std::size_t count, const ChartSite& mean,
                       const ChartDistortion& weights);

}  // namespace vdbsynth
