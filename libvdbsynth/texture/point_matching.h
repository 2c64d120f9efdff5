#pragma once
#include "libvdbsynth/texture/point_surface.h"

#include <vector>

namespace vdbsynth {

struct PointMatchingOptions {
    int neighbours = 25;    ///< k, 3..256: a neighbourhood is about sqrt(k) texels wide
    double scale = 1;       ///< above 0: side of a texel in spacings; 2 makes the texture twice as large
    int levels = 1;         ///< of the hierarchy, 1..8
    bool coherent = false;  ///< tries only texels where coloured neighbours came from, shifted
    PointOrientationOptions orientation;
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointMatchingOptions& options);

struct PointMatchingResult {
    TexturedSites sites;                  ///< one per point of the target; every coordinate a texel's centre
    double texel = 0;                     ///< [world]
    std::vector<std::size_t> levelSites;  ///< coarse to fine
    double tried = 0;  ///< mean number of texels that a point's neighbourhood was compared with
};

/// Colours points one after another by their neighbourhoods, the second of the paper's methods [zhang2004,
/// 4]. A point's neighbourhood are those of its k neighbours that have a colour, at their places on its
/// tangent plane (flattened in coordinates/site_chart.h). It is laid on every texel of the sample, which is
/// read between texels at eighths (the nearest texel of one with 8 x 8 as many), and the texel with the
/// smallest sum of squared differences gives the colour; ties go to the lowest texel number. Differences are
/// summed along the principal axes of the sample's colours, the same sum, the longest axis first, so that
/// most texels are given up early. Texels where a neighbourhood would reach beyond the sample are left out,
/// unless it is tileable or no other is left.
///
/// Points with the most coloured neighbours come first (site_queue.h). Decision: up to 16 of them at once
/// where none is a neighbour of another and none has less than 3/4 of the first one's coloured neighbours, so
/// that threads have work; the coherent variant goes one by one.
///
/// With more levels the coarsest, of clusters of four (point_hierarchy.h), begins with random texels; each
/// finer one also compares the coarser points over the neighbourhood with the coarser sample, whose texels
/// are means of four. Neighbours over 2 sqrt(k) spacings, or over half the sample, away are left out.
/// @throw Error InvalidOption (a field out of its range), EmptyInput, ShapeMismatch, Unusable (as
/// requireTarget and requireSample), Memory, Cancelled
/// @par Cost    O(points * texels * k); O(points * k^2) if coherent. Memory: 64 times the sample's where that
///              is at most 256 MB and within ctx.maxMemory, else it is read between texels as it goes
/// @par Repeats same bits for any number of threads
PointMatchingResult matchPoints(const TextureTarget& target, const SampleImage& sample,
                                const PointMatchingOptions& options = {}, const RunContext& ctx = {});

/// One level of sites and what they have so far.
struct MatchLevel {
    SurfaceSites sites;
    std::vector<Vec3f> tangent;
    std::vector<std::uint32_t> parent;  ///< [sites] the coarser site; empty on the coarsest level
    std::vector<char> coloured;         ///< [sites]
    std::vector<Vec2f> coordinate;      ///< [sites] in texels of the level's sample
    std::vector<float> values;          ///< [sites x channels]
    double texel = 1;                   ///< [world]
};

/// Colours what is not yet coloured on one level, with `coarser` (null: none) whole.
/// @param sample         at this level   @param coarserSample  at the coarser one; null: none
/// @return number of texels compared
/// @throw Error Cancelled   @par Repeats same bits for any number of threads
double matchLevel(MatchLevel& level, const SampleImage& sample, const MatchLevel* coarser,
                  const SampleImage* coarserSample, const PointMatchingOptions& options,
                  const RunContext& ctx = {});

/// The next coarser level of sites: clusters of four (point_hierarchy.h), coloured where all members are,
/// with the mean of their values and the first one's coordinate. Sets the finer one's parents.
MatchLevel coarserLevel(MatchLevel& finer, int neighbours, const RunContext& ctx = {});

/// The levels above `levels[0]` added, up to `count`, and all coloured from the coarsest on.
/// @return number of texels compared, over all sites
double matchLevels(std::vector<MatchLevel>& levels, const SampleImage& sample, int count,
                   const PointMatchingOptions& options, const RunContext& ctx = {});

/// Half as wide and high, rounded up: means of 2 x 2 texels.
SampleImage halved(const SampleImage& image);

}  // namespace vdbsynth
