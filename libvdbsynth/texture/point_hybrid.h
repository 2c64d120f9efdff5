#pragma once
#include "libvdbsynth/texture/point_matching.h"
#include "libvdbsynth/texture/point_parameterization.h"

namespace vdbsynth {

struct PointHybridOptions {
    PointParameterizationOptions parameterization;  ///< its `blend` is not used
    int levels = 1;                                 ///< of the matching in gaps, 1..8
    bool coherent = false;   ///< matching tries only texels where coloured neighbours came from, shifted
    double featureSize = 0;  ///< [texels] gaps get about this wide; 0: featureSize(sample)
    int matchSample = 0;     ///< [texels] gaps are matched in a window of the sample with this side, at
                             ///< least 8; 0: in the whole sample
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointHybridOptions& options);

struct PointHybridResult {
    TexturedSites sites;                ///< one per point of the target
    std::vector<char> matched;          ///< [points] nonzero where matching gave the colour
    double texel = 0;                   ///< [world]
    double featureSize = 0;             ///< [texels]
    std::size_t patches = 0, gaps = 0;  ///< numbers of patches, and of points in gaps before widening
    std::size_t widened = 0;            ///< and after
    double tried = 0;                   ///< mean number of texels compared for a point in a gap
};

/// The third of the paper's methods [zhang2004, 5]: the surface is cut into patches
/// (point_parameterization.h), their gaps are widened to the texture's feature size, and the points in them
/// matched (point_matching.h). A gap of sqrt(k) / 2 points grows by sqrt(k) in a step, in which all points
/// with a gap point among their k nearest join it; the number of steps is that which comes nearest to the
/// feature size. Patches that vanish leave their points to the matching.
///
/// Decisions: a gap point's direction is the mean of those around it, from the patches inward, so that what
/// is matched stands as the patches beside it do. With more levels a coarse point counts as coloured
/// only if all its members are; the others are random on the coarsest level.
/// @throw Error InvalidOption (a field out of its range), EmptyInput, ShapeMismatch, Unusable (as
/// requireTarget and requireSample), Memory, Cancelled
/// @par Repeats same bits for any number of threads
PointHybridResult texturePointsHybrid(const TextureTarget& target, const SampleImage& sample,
                                      const PointHybridOptions& options = {}, const RunContext& ctx = {});

/// Size of the sample's features [texels], 1..side/4: the first distance at which the correlation of texels,
/// the mean along both axes over the channels by variance, falls below 0.1. Held to a quarter of the side, as
/// wider gaps leave little of patches that fit into the sample.
double featureSize(const SampleImage& sample);

/// Lower left corner and size of a window of the sample.
struct SampleWindow {
    int x = 0, y = 0, width = 0, height = 0;
};

/// The window of a side with means and deviations of the channels nearest to the sample's, among at most 16 x
/// 16 places; the whole sample if that is no larger.
SampleWindow typicalWindow(const SampleImage& sample, int side);

}  // namespace vdbsynth
