#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/relief/transfer/relief_sample.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A surface to grow relief on.
struct ReliefTarget {
    BrickField distance;              ///< [voxels] negative inside, its box beginning at 0
    float reach = 3;                  ///< [voxels] that it is known for, on both sides
    std::vector<Vec3f> point;         ///< [sites] on its surface [voxels], about one a voxel
    std::vector<Vec3f> normal;        ///< [sites] outward, length 1
    std::vector<Vec3f> direction;     ///< [sites] wanted directions of u, 0 where none; empty: none
    std::vector<std::int32_t> label;  ///< [sites] number of the sample; empty: 0
    std::vector<float> strength;      ///< [sites] 0..1 share of the relief; empty: 1 everywhere
};

/// The target's sites: the vertices of its zero level, with the normals of its distances.
/// @throw Error EmptyInput (no surface), Cancelled
void makeSites(ReliefTarget& target, const RunContext& ctx = {});

struct ReliefTransferOptions {
    double texel = 1;             ///< [target's voxels] 0.01..100: side of a texel on the target
    double strength = 1;          ///< -100..100: 1 as the sample, 0 nothing, below 0 inverted
    double minWall = 0;           ///< [target's voxels] at least 0: what carving leaves of thin parts
    CoordinateOptions synthesis;  ///< its maxRotation is for targets without directions
};

inline constexpr double kGivenReliefRotation = 8;  ///< [degrees] of charts from given directions

/// @throw Error InvalidOption (a field out of its range)
void validate(const ReliefTransferOptions& options);

/// Where the relief of every site comes from.
struct ReliefMap {
    std::vector<std::int32_t> sample;          ///< [sites]
    std::vector<Vec2f> coordinate;             ///< [sites] in texels
    std::vector<Vec3f> tangent;                ///< [sites] length 1, the direction of u
    std::vector<CoordinateLevelStats> levels;  ///< coarse to fine
    std::vector<Vec3f> singularities;          ///< [voxels] of the directions
};

/// Gives every site of a target a place in a sample, by coordinate synthesis over heights
/// (coordinates/coordinate_synthesis.h), the default instead of the exhaustive growth of [breckon2006].
/// @throw Error InvalidOption, EmptyInput (no sites, no samples), ShapeMismatch (samples with different
/// channels, arrays of different lengths, labels without a sample), Unusable (directions only along normals),
/// Cancelled
/// @par Cost    about 3 microseconds a site and core   @par Repeats same bits for any number of threads
ReliefMap matchRelief(const ReliefTarget& target, const std::vector<ReliefSample>& samples,
                      const ReliefTransferOptions& options = {}, const RunContext& ctx = {});

/// [target's voxels] around the target's surface within which relief changes anything.
float reliefReach(const std::vector<ReliefSample>& samples, const ReliefTransferOptions& options);

/// The target with relief, as an edit of its distance d: with x's foot on the target at depth d(x),
///     phi(x) = d + s (sum w_j phi_j(u_j, d) / sum w_j - d),
/// where phi_j is the distance to the sample's relief (reliefDistance) over the place u_j that site j's
/// chart, extended to the foot by the position formula, gives there; j are the nearest sites within three
/// voxels, so that inside a piece of the sample all agree and across its border one fades into the next. s is
/// the strength times the site's. Distances keep overhangs and loose parts. Carving leaves a wall:
/// phi is at most d + (thickness - minWall) / 2 (min with the target moved inward), the thickness being
/// measured along the inward normal.
/// @return a field over the target's box whose zero level is meant, clamped to -3..3; the target's own values
/// where nothing changes
/// @throw Error as matchRelief; InvalidOption (the target is not known for reliefReach)
/// @par Cost    about 2 microseconds a voxel within reach and core
/// @par Repeats same bits for any number of threads
BrickField reliefOnTarget(const ReliefTarget& target, const std::vector<ReliefSample>& samples,
                          const ReliefMap& map, const ReliefTransferOptions& options = {},
                          const RunContext& ctx = {});

}  // namespace vdbsynth
