#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/relief/base_scale.h"
#include "libvdbsynth/relief/base_surface.h"
#include "libvdbsynth/relief/relief_statistics.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

struct ReliefExtractOptions {
    BaseKind base = BaseKind::Twicing;
    double baseRadius =
        0;  ///< [world] standard deviation of the base's Gaussian, 1 to 1000 voxels; 0: at the gap
            ///< of the spectrum (relief/base_scale.h). The cut-off wavelength is kCutOff times that
    std::optional<double> strength;  ///< -100..100: also makes base + strength * relief
    double halfWidth = 3;            ///< [voxels] of the level sets' bands, 1.5..100
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const ReliefExtractOptions& options);

/// Connected components and tunnels of a solid.
struct SurfaceCounts {
    std::size_t solids = 0, voids = 0;  ///< voids: those that are enclosed
    long tunnels = 0;                   ///< of a whole object; of a texture 0
};

struct ReliefExtraction {
    LevelSet base;   ///< named `base`
    GridPtr relief;  ///< float `relief` [world]: the height along the base's normal over the nearest point
                     ///< of the base, active in the base's band over the domain
    GridPtr reliefVector;  ///< Vec3S `relief_vector` [world], from the base's nearest point to the scan's
                           ///< surface; active only where the relief folds; null if it does so nowhere
    LevelSet surface;      ///< base + strength * relief; without a grid if no strength was given
    double radius = 0;     ///< [world] of the base
    BaseScale scale;       ///< radii that were tried; empty if one was given
    ReliefStatistics statistics;  ///< [voxels]
    double voxelSize = 1;         ///< [world]
    SurfaceCounts scanCounts, baseCounts;
    BaseSurface fields;     ///< in voxels, for outputs at other places
    Index3 corner;          ///< index of the grids' voxel for the fields' voxel 0
    IndexBox domain;        ///< within the fields' box
    bool recorded = false;  ///< the model's domain is one of a texture: its surface continues beyond it
};

/// Splits a scan into a smooth base and the relief on it (relief/base_surface.h, relief_layer.h), and adds
/// them up again. A model without a recorded domain is a whole object; the surface of one with a domain is
/// taken to continue beyond its faces, and statistics leave out two radii beside the faces that cut it.
///
/// Warnings say where the base has other components or tunnels than the scan, where more than a hundredth of
/// the scan is too far from the base to be its relief, and a relief of nothing.
/// @throw Error InvalidOption, what requireModel (vdb/level_set.h) throws, EmptyInput (no surface, no base
/// left), Memory, Cancelled
/// @par Cost    as baseSurface and findBaseRadius
/// @par Repeats same bits for any number of threads
ReliefExtraction extractRelief(const LevelSet& model, const ReliefExtractOptions& options = {},
                               const RunContext& ctx = {});

}  // namespace vdbsynth
