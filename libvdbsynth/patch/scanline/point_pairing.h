#pragma once
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Points as pairing sees them.
struct PairingPoints {
    std::vector<Vec3f> points, normals;
    std::vector<float> variation;  ///< surface variation, 0..1/3
};

/// What a pair costs. Lengths are counted in spacings of the points, so that weights mean the same at every
/// scale; the paper does not say its unit.
struct PairingWeights {
    double position = 1, normal = 2, variation = 10, length = 6, direction = 6;  ///< w_p .. w_d
};

/// A pair one of whose terms exceeds its limit costs infinitely much.
struct PairingLimits {
    double position = 6;     ///< [spacings] of |p_s - p_q|
    double normal = 60;      ///< [degrees] between the normals
    double variation = 0.1;  ///< of |v_s - v_q|
};

struct PairingOptions {
    PairingWeights weights;
    PairingLimits limits;
    int rounds = 3;        ///< 0..20 of pairing again with coherence
    double coherence = 4;  ///< [spacings] standard deviation of theta, the Gaussian over neighbours
};

/// Pairs every target point with a source point, greedily [duranleau2006, 5.2, equations 1 to 3]: at first
/// each q with the free s of least
///
///     c(s, q) = w_p |p_s - p_q|^2 + w_n / 2 (1 - n_s . n_q) + w_v (v_s - v_q)^2,
///
/// then `rounds` times with that of least c(s, q) + g(s, q, pi), pi the pairing of the round before,
///
///     g(s, q, pi) = w_l | |p_s - p_q| - f_l(q, pi) | + w_d / 2 (1 - f_d(q, pi) . (p_s - p_q) / |p_s - p_q|),
///
/// f_l and f_d the means of length and direction over pi, weighted by theta(|p_q - p_r|), without q itself.
/// Targets are taken in their order. Where p_s = p_q, or no neighbour gives a direction, the last term is
/// w_d / 2.
/// @param spacing  [world] over 0
/// @return [target] number of the source point, -1 where every free one costs infinitely much
/// @throw Error InvalidOption (a weight or limit below 0, rounds, spacing), ShapeMismatch
/// @par Cost    O(targets x (sources within the limit + targets within three standard deviations))
/// @par Repeats yes
std::vector<std::int32_t> pairPoints(const PairingPoints& sources, const PairingPoints& targets,
                                     double spacing, const PairingOptions& options);

/// C(pi) of eq. 1, over all pairs.
double pairingCost(const PairingPoints& sources, const PairingPoints& targets,
                   const std::vector<std::int32_t>& pairs, double spacing, const PairingOptions& options);

/// @throw Error InvalidOption
void validate(const PairingOptions& options);

}  // namespace vdbsynth
