#pragma once
#include <cstddef>

namespace vdbsynth {

struct VolumeAnalogyOptions {
    int levels = 0;       ///< of the pyramid, 1..6; 0: as many, at most 3, as still hold the texture
    int sweeps = 2;       ///< over the voxels of every level, 1..10
    int half = 2;         ///< a neighbourhood is (2 half + 1)^3 samples, 1..4
    int coarseHalf = 1;   ///< the same at the next coarser level, 1..3
    int components = 16;  ///< principal axes that features are compared along, 4..256
    /// How much farther in feature space a voxel may lie that continues what a neighbour copied, before
    /// the nearest of all is taken; at level l this counts 2^-l times [ashikhmin2001; hertzmann2001, 3.2].
    /// 0..100
    double coherence = 0.5;
    /// Of the approximate search: a source's squared feature distance is at most 1 + epsilon times the least;
    /// 0..100; 0: exact.
    double epsilon = 4;
    bool causal = false;  ///< true: of what is made only what lies behind a voxel counts, as in the paper
    /// True: neighbourhoods follow the surface's curvature; false: straight cubes, as in the paper.
    bool curvatureAdapted = true;
    bool aligned = true;  ///< false: the paper's naive variant, neighbourhoods along the grid's axes
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const VolumeAnalogyOptions& options);

/// What one level took.
struct AnalogyLevelStats {
    std::size_t voxels = 0;      ///< that were synthesised
    std::size_t waves = 0;       ///< of voxels that were computed in parallel
    std::size_t features = 0;    ///< of the pairs
    std::size_t components = 0;  ///< axes used
    double explained = 0;        ///< share of the features' variance along them
    double coherent = 0;         ///< share of voxels whose source continues a neighbour's
    /// Root of the mean squared feature distance, when the level is done, of at most kProbed voxels spread
    /// evenly: to what they copied, and to the nearest of all.
    double meanDistance = 0, exactDistance = 0;
};

inline constexpr std::size_t kProbed = 2000;

struct FilterAnalogyOptions {
    int half = 2;         ///< a voxel is computed from the (2 half + 1)^3 around it, 1..4, and
    int levels = 3;       ///< at each further level from 3^3 places 2^level apart, smoothed as much; 1..4
    int components = 16;  ///< principal axes that the search for what is not linear goes along, 4..256
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const FilterAnalogyOptions& options);

struct FilterAnalogyStats {
    std::size_t rows = 0;    ///< voxels of the pairs that were learnt from
    double change = 0;       ///< root mean square of after - before, over held-out voxels
    double affineError = 0;  ///< the same of after - what the affine map says
    double searchError = 0;  ///< the same with the nearest row's rest added
    bool searched = false;   ///< the rests are used: searchError was below affineError
};

}  // namespace vdbsynth
