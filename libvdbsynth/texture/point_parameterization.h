#pragma once
#include "libvdbsynth/texture/point_chart.h"
#include "libvdbsynth/texture/point_surface.h"

#include <vector>

namespace vdbsynth {

struct PointParameterizationOptions {
    int neighbours = 25;  ///< k, 3..256
    double scale = 1;     ///< above 0: side of a texel in spacings; 2 makes the texture twice as large
    ChartDistortion distortion;
    PointOrientationOptions orientation;  ///< of every patch's seed
    /// Largest size of a patch, as a share of each side of a sample that is not tileable, above 0, at most 1.
    double patchSize = 0.9;
    SampleBlend blend = SampleBlend::Automatic;  ///< of what patches say to gap points; not Off
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointParameterizationOptions& options);

/// A surface cut into flat patches.
struct PointPatches {
    static constexpr std::int32_t kGap = -1;

    std::vector<std::int32_t> patch;  ///< [sites] number of the patch, or kGap
    std::vector<ChartSite> chart;     ///< [sites] in patches: the place in them, the seed at (0, 0)
    std::vector<Vec2f> origin;        ///< [patches] the seed's coordinate in the sample [texels]
    std::size_t gaps = 0;             ///< number of sites in gaps

    Vec2f coordinate(std::int32_t number, const ChartPosition& q, double scale) const {
        const Vec2f& at = origin[std::size_t(number)];
        return {float(double(at.x) + q.x / scale), float(double(at.y) + q.y / scale)};
    }
};

/// Cuts a surface into patches by growing regions [zhang2004, 3.2]. A patch starts at a free point drawn at
/// random. The free point with the most points of the patch around it comes next (site_queue.h). It joins at
/// the mean of what its neighbours in the patch estimate (point_chart.h) if their distortion is within the
/// threshold and, for a sample that is not tileable, the patch's box stays within the size limit; else it
/// becomes a gap, which is why patches never touch: gaps are about sqrt(k) / 2 points wide. A patch of a
/// limited size takes a random window of the sample, one of a tileable sample begins anywhere in it.
///
/// Decisions: a point counts as a neighbour of those in whose k nearest it is, as in the paper; its estimates
/// come from its own k nearest. One none of whose own k nearest is in the patch stays free. Only orientations
/// of seeds are given; what follows is the surface's geometry.
/// @throw Error Cancelled
/// @par Cost    O(sites * k), on one thread   @par Repeats yes
PointPatches growPatches(const PointSurface& surface, const SampleImage& sample,
                         const PointParameterizationOptions& options, const RunContext& ctx = {});

struct PointParameterizationResult {
    TexturedSites sites;                  ///< one per point of the target
    std::vector<std::int32_t> patch;      ///< [points] number of the patch, or PointPatches::kGap
    std::vector<ChartPosition> position;  ///< [points] in the patch [spacings]; (0, 0) in gaps
    double texel = 0;                     ///< [world]
    double spacing = 0;                   ///< [world]
    std::size_t patches = 0, gaps = 0;    ///< numbers of patches, and of points in gaps
    bool histogram = false;               ///< gaps were mixed by histogram
};

/// Textures points by flattening the surface into patches, the first of the paper's methods [zhang2004, 3].
/// Points in gaps, those with the most coloured neighbours first, mix the colours that the patches around
/// them continue to. Decision: estimates in one patch and within a spacing of each other count as one place,
/// so that a mix has few parts; the kMostBlendParts with the largest weights are mixed. A point with no
/// estimate takes its nearest coloured neighbour's place, or, where none is coloured, one drawn at random.
/// @throw Error InvalidOption (a field out of its range), EmptyInput, ShapeMismatch, Unusable (as
/// requireTarget and requireSample), Memory, Cancelled
/// @par Cost    O(points * k) and the neighbours, see docs/texturing.md
/// @par Repeats same bits for any number of threads
PointParameterizationResult parameterizePoints(const TextureTarget& target, const SampleImage& sample,
                                               const PointParameterizationOptions& options = {},
                                               const RunContext& ctx = {});

/// Fills in what sites in patches get: coordinate, tangent and values, on all threads.
void colourPatches(const PointSurface& surface, const PointPatches& patches, const SampleImage& sample,
                   double scale, TexturedSites& out, const RunContext& ctx = {});

}  // namespace vdbsynth
