#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/texture/texture_target.h"
#include "libvdbsynth/relief/base_surface.h"
#include "libvdbsynth/vdb/level_set.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

enum class ReliefMethod {
    Default,  ///< coordinates corrected coarse to fine (relief/transfer/relief_transfer.h)
    Paper     ///< exhaustive growth, vertex by vertex [breckon2006] (relief/growth/grown_relief.h)
};

/// What relief is taken from: a scan, or a picture of heights.
struct ReliefSource {
    const LevelSet* scan = nullptr;  ///< null: `heights`
    SampleImage heights;             ///< one channel, 0 black to 1 white
    double height =
        0;  ///< [world] above 0, of white over black; 0: kPictureHeight target voxels times the scale
    double pixelSize = 0;  ///< [world] above 0, of a pixel on the target at scale 1; 0: a voxel of the target
};

inline constexpr double kPictureHeight = 5;  ///< [voxels]

/// Numbers of the samples at the target's sites, of which the shape has places and normals.
using ReliefLabels = std::function<std::vector<std::int32_t>(const TextureShape& sites)>;

struct ReliefOptions {
    ReliefMethod method = ReliefMethod::Default;
    BaseKind base = BaseKind::Twicing;
    double baseRadius = 0;  ///< [world of the sample] as ReliefExtractOptions::baseRadius; 0: found
    bool wholeSample =
        false;            ///< also copies from parts of a scan that are plain (ReliefSampleOptions::rough)
    double scale = 1;     ///< 0.05..20: at 1 a voxel of the sample lands on a voxel of the target
    double strength = 1;  ///< -100..100 of the relief; below 0 inverted
    double minWall = 0;   ///< [world of the target] at least 0, that carving leaves of thin parts
    std::optional<DirectionSource> direction;          ///< of u over the target; none: free
    std::optional<DirectionSource> exemplarDirection;  ///< of u over scans; none: the smoothest field
    CoordinateOptions synthesis;                       ///< of the default method
    double neighbourhood =
        0;              ///< [world of the target] radius, of the paper's method; 0: as GrownReliefOptions
    double top = 0.02;  ///< [percent] eta of the paper's method
    GridConstPtr mask;  ///< 0..1 over the target, by which strength is multiplied; null: 1
    const LevelSet* maskModel = nullptr;  ///< relief only inside; null: everywhere
    std::string maskAttribute;  ///< name of a grid among the target's attributes, painted 0..1 (of a colour
                                ///< the mean of its channels); empty: none
    std::optional<SampleImage>
        maskImage;    ///< painted on the target's texture coordinates, its attribute `uv`
    double fade = 0;  ///< [world] at least 0: depth inside `maskModel` over which the relief rises to full
    bool fit =
        false;  ///< lays a tileable picture round the axis of `direction` (around), resized by the
                ///< least that makes a whole number of periods, in one phase; ends are matched as without
    float halfWidth = kHalfWidth;  ///< [voxels] of the result, 1.5..100
};

/// @throw Error InvalidOption (a field out of its range, `fit` without a direction around an axis)
void validate(const ReliefOptions& options);

struct ReliefResult {
    LevelSet model;
    std::vector<GridPtr> sources;  ///< over the result's band, floats: `source_u`, `source_v` [texels],
                                   ///< `exemplar`, and of scans Vec3S `source` [voxels of the scan]
    std::vector<CoordinateLevelStats> levels;
    std::vector<Vec3d> singularities;  ///< [world] of the target's directions
    double reach = 0;             ///< [world] from the target within which its distances may have changed
    double texel = 1;             ///< [world of the target] that a sample's texel is wide
    double baseRadius = 0;        ///< [world] of the first scan's base; 0 for pictures
    std::vector<double> covered;  ///< of each scan, share of its surface that was flattened
    std::size_t parts = 0;        ///< of the result; a warning says where the target has another number
    bool folds = false;           ///< distances were copied, not heights
    double unchanged = 0;         ///< share of the target's band that keeps its bits
    double fitted = 1;            ///< by which `fit` resized the picture
    double mismatch = 0;          ///< [texels^2] mean of eq. 1, of the paper's method
};

/// Grows the relief of samples on a target: each sample's base and relief (relief_extract.h), flattened
/// (relief/transfer/relief_sample.h), matched over the target's surface and applied as an edit of its
/// distances, rebuilt to a valid narrow band. Where a mask is 0, and farther from any change than the band,
/// voxels keep the target's bits. Faces of a recorded domain that the target touches stay cuts.
/// @param labels  null: the first sample everywhere
/// @throw Error as validate; what requireModel throws; Unusable (a sample without relief, a direction that
/// cannot be had), EmptyInput, Memory, Cancelled
/// @par Cost    100 000 vertices to 100 000: seconds (docs/relief.md)
/// @par Repeats same bits for any number of threads
ReliefResult transferRelief(const std::vector<ReliefSource>& samples, const LevelSet& target,
                            const ReliefLabels& labels, const ReliefOptions& options = {},
                            const RunContext& ctx = {});

}  // namespace vdbsynth
