#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

struct CoordinateOptions {
    int passes = 2;        ///< of correction on every level, 0..20
    int coarsePasses = 4;  ///< on the coarsest level, which begins with charts, 0..100
    int similar = 2;       ///< texels like a candidate that are tried beside it (k of k-coherence), 0..8
    double coherence = 2;  ///< 0..10: how much more a jump must improve than a continuation, as a share of
                           ///< its cost
    double uniformity = 0.25;  ///< 0..10: how much a place of the sample costs that is used twice as often as
                               ///< others, as a share of the features' variance
    double histogram = 0.75;   ///< 0..10: the same for values that are used twice as often as in the sample
    /// [degrees] 0..180: how far charts may be rotated from the sites' tangents. A field of directions bends
    /// with the surface and between its singularities; charts that follow it exactly are sheared and break
    /// up.
    double maxRotation = 60;
    int levels = 0;  ///< of the hierarchy, 1..12; 0: as many as the sample's size asks for
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const CoordinateOptions& options);

/// What one level of the hierarchy did.
struct CoordinateLevelStats {
    std::size_t sites = 0;
    double step = 0;      ///< [texels] between sites
    double coherent = 0;  ///< share of the sites that continue one of their neighbours at the end
    double cost = 0;      ///< mean squared feature distance at the end, over that of two random texels
};

inline constexpr std::size_t kSiteNeighbours = 8;  ///< that coordinate synthesis looks at

/// Sites with frames and the sample that each takes.
struct CoordinateSites {
    SurfaceSites sites;               ///< with kSiteNeighbours neighbours each; fastest in Morton order
    std::vector<Vec3f> tangent;       ///< [sites] length 1, perpendicular to the normal: the direction of +u
                                      ///< that is wanted
    std::vector<std::int32_t> label;  ///< [sites] number of the sample; empty: 0 everywhere
};

struct CoordinateResult {
    std::vector<Vec2f> coordinate;             ///< [sites] in texels of the site's sample
    std::vector<Vec3f> tangent;                ///< [sites] of length 1, the direction of +u
    std::vector<CoordinateLevelStats> levels;  ///< coarse to fine
};

/// A coordinate in a sample for every site, so that what neighbouring sites read there fits together: coarse
/// to fine over ever smaller cells, as texture synthesis by corrected coordinates does on an image's lattice
/// [lefebvre2005; lefebvre2006], here on irregular sites. On each level a site's neighbourhood are the
/// appearances at four taps a step away, each read from the sample where the neighbours in that quadrant
/// continue to (site_chart.h), the mean of them. Candidates are the continuations of the neighbours' own
/// coordinates, the site's own, and `similar` texels like each [ashikhmin2001; tong2002, k-coherence]. The
/// one with the nearest feature is taken; ties go to the first. On the coarsest
/// level whole charts of the sample are laid first (coordinate_charts.h).
///
/// Sites are updated in classes of which no two are neighbours, those of a class at once, so that the order
/// within it means nothing. Sites denser than the texels continue the nearest coarser site.
/// @param texel    [world] side of a texel on the surface, above 0
/// @param samples  all with the same number of channels
/// @throw Error InvalidOption, ShapeMismatch (arrays or masks of different lengths, different channels,
/// labels without a sample), EmptyInput (no samples, no texels), Cancelled
/// @par Cost    O(sites log sites + texels), about 2 microseconds a site and core
/// @par Repeats same bits for any number of threads
CoordinateResult synthesizeCoordinates(CoordinateSites sites, const std::vector<SampleImage>& samples,
                                       double texel, const CoordinateOptions& options = {},
                                       const RunContext& ctx = {});

}  // namespace vdbsynth
