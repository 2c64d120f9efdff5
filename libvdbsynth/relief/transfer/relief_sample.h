#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/relief/base_surface.h"

#include <functional>
#include <memory>
#include <vector>

namespace vdbsynth {

/// Wanted directions of u (of any length, 0: none) at places of a surface [voxels] with these normals.
using PlaceDirections =
    std::function<std::vector<Vec3f>(const std::vector<Vec3f>& place, const std::vector<Vec3f>& normal)>;

/// A relief to be copied: flat, as heights over texels, whether it came as a picture or off a surface.
struct ReliefSample {
    /// The first channel is the height [texels] along the normal. Of a relief that folds two more follow: the
    /// distance to it below and above the base, by which matching tells what hides under an overhang.
    SampleImage image;
    std::vector<char> known;    ///< [texels] nonzero where a chart shows the base; empty for a picture
    std::vector<Vec3f> place;   ///< [texels] on the base [voxels]
    std::vector<Vec3f> normal;  ///< [texels] of the base, outward, length 1
    /// The surface it was taken off, in whose `scan` distances are read: overhangs and loose parts come
    /// along. Null: heights are all there is.
    std::shared_ptr<const BaseSurface> surface;
    Index3 corner;  ///< index of the scan's voxel for the surface's voxel 0; filled by the caller
    PlaceDirections directions;     ///< over the base; null: none given
    float lowest = 0, highest = 0;  ///< [texels] of the heights, and of what folds
    bool folds = false;
    std::size_t charts = 0;  ///< that the surface was flattened to
    double covered = 1;      ///< share of the surface's sites that charts show
    double rough = 1;        ///< share of what charts show that is rough enough to be copied
};

inline constexpr int kChartBorder = 3;  ///< [texels]

struct ReliefSampleOptions {
    /// 0..1: only where the root mean square height around is at least so much of its 9th decile over the
    /// sample are there sources: a statue's mane is copied, not its smooth flank. An even relief stays whole.
    /// 0: everywhere.
    double rough = 0.5;
    double maxRotation = 30;  ///< [degrees] 0..180: how far charts may be rotated from the tangents
    std::size_t largest = std::size_t(1) << 26;  ///< texels
};

/// The relief over a base, flattened: sites are the vertices of the base's zero level, about one a voxel;
/// they are laid out in charts (relief_charts.h) that overlap, the charts are packed in rows of an atlas, and
/// every texel (a voxel wide) that a chart's faces cover gets its place on the base, read between the faces'
/// corners and moved onto the base, and the height there (relief_layer.h). Texels within kChartBorder of a
/// chart's border are no sources, so that what surrounds a source can be read; those beyond it continue what
/// is beside them.
/// @param directions  null: the smoothest field
/// @throw Error EmptyInput (no base), Memory (an atlas over `largest`), Cancelled
/// @par Cost    O(sites * charts + texels)   @par Repeats same bits for any number of threads
ReliefSample reliefSample(std::shared_ptr<const BaseSurface> base, const PlaceDirections& directions,
                          const ReliefSampleOptions& options = {}, const RunContext& ctx = {});

/// A height picture as a relief. @param heights  one channel [texels], means of 0 wanted: the caller chooses
/// what is not raised
/// @throw Error EmptyInput (no texels), ShapeMismatch (several channels), BadData (not finite)
ReliefSample reliefSample(SampleImage heights);

/// Gives a sample the channels of those that fold, or only heights, so that several samples have the same.
void withChannels(ReliefSample& sample, bool folds);

/// The place on the base [voxels] at a coordinate. @param sample  of a surface
Vec3f reliefPlace(const ReliefSample& sample, const Vec2f& at);

/// Distance to the relief over a place of the sample [texels], negative inside; to first order for heights.
/// @param at     [texels]
/// @param depth  [texels] above the base
float reliefDistance(const ReliefSample& sample, const Vec2f& at, float depth);

}  // namespace vdbsynth
