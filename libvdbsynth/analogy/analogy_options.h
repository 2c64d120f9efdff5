#pragma once
#include <cstddef>

namespace vdbsynth {

struct VolumeAnalogyOptions {
    int levels = 0;       ///< of the pyramid, 1..6; 0: as many as resolve the texture, at most 3
    int sweeps = 2;       ///< over the voxels of every level, 1..10
    int half = 2;         ///< a neighbourhood is (2 half + 1)^3 samples, 1..4
    int coarseHalf = 1;   ///< the same at the next coarser level, 1..3
    int components = 16;  ///< principal axes that features are compared along, 4..256
    /// At level l a source that continues a neighbour's copy is preferred if its feature distance is at most
    /// 1 + this * 2^-l times the nearest one's [ashikhmin2001; hertzmann2001, 3.2]. 0..100
    double coherence = 1;
    /// Of the approximate search: a source's squared feature distance is at most 1 + epsilon times the least;
    /// 0..100; 0: exact.
    double epsilon = 4;
    bool causal = false;  ///< true: compares only voxels behind the current one in the sweep, as in the paper
    /// True: neighbourhoods follow the surface's curvature; false: straight cubes, as in the paper.
    bool curvatureAdapted = true;
    bool aligned = true;  ///< false: the paper's naive variant, axis-aligned neighbourhoods
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const VolumeAnalogyOptions& options);

/// Measurements of one level.
struct AnalogyLevelStats {
    std::size_t voxels = 0;      ///< that were synthesised
    std::size_t waves = 0;       ///< of voxels that were computed in parallel
    std::size_t features = 0;    ///< of the pairs
    std::size_t components = 0;  ///< axes used
    double explained = 0;        ///< share of the features' variance along them
    double coherent = 0;         ///< share of voxels whose source continues a neighbour's
    /// Root of the mean squared feature distance at the end of the level, for at most kProbed evenly spread
    /// voxels: to their sources, and to the nearest of all.
    double meanDistance = 0, exactDistance = 0;
};

inline constexpr std::size_t kProbed = 2000;

struct FilterAnalogyOptions {
    int half = 2;         ///< a voxel is computed from the (2 half + 1)^3 around it, 1..4, and
    int levels = 3;       ///< at each further level from 3^3 positions 2^level apart, smoothed as much; 1..4
    int components = 16;  ///< principal axes for the search of nonlinear effects, 4..256
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const FilterAnalogyOptions& options);

struct FilterAnalogyStats {
    std::size_t rows = 0;    ///< voxels of the pairs used for training
    double change = 0;       ///< root mean square of after - before, over held-out voxels
    double affineError = 0;  ///< the same of after - the affine map's prediction
    double searchError = 0;  ///< the same with the nearest row's residual added
    bool searched = false;   ///< the residuals are used: searchError was below affineError
};

}  // namespace vdbsynth
