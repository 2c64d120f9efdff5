#pragma once
#include "libvdbsynth/grid/components.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Measurements as plain numbers; docs/measures.md defines each.
namespace vdbsynth {

/// One statistic of a box: a number, or a curve.
struct Statistic {
    std::string name;
    int power = 0;  ///< world value = value * voxel size^power (for a number; a curve's abscissa is a length)
    bool curve = false;
    std::vector<double> values;  ///< [1], [3] by axis, or the curve, for several axes one after another;
                                 ///< empty: not measured (pores of an object)
    bool measured() const { return !values.empty(); }
};

/// Counts of a whole model.
struct Topology {
    Components solid, empty;  ///< components of solid and void; of an object the outside is one of the void's
    double eulerCharacteristic = 0;  ///< total; density times volume if the texture continues
    double enclosed = 0;             ///< components of the void that touch no face
    double tunnels = 0;              ///< first Betti number, of a whole object only
};

/// Deviation of the field from a distance where |value| < 1: mean and 99th percentile of | |grad| - 1 |, by
/// central or upwind differences, whichever is closer (a ridge inside a wall has no central gradient). Two
/// voxels at the faces of a domain are excluded, where caps distort the field.
struct GradientError {
    double mean = 0, percentile99 = 0;
};

/// Local-patch similarity of occupancies [wu2022, section 5]: patches of 11^3 voxels, every fifth voxel,
/// whose middle 3^3 has both phases; for whole objects in boxes padded by 5 void voxels, for textures only
/// inside the box. Of up to 1000 patches of `other`, sampled at random, the share whose best match among all
/// of `reference` is over 0.95.
struct LocalPatches {
    double shareIoU = 0;    ///< LP-IoU
    double shareScore = 0;  ///< LP-F, the F-score instead of the intersection over union
    double meanIoU = 0;     ///< mean of the best intersection over union
};

/// Distance of two surfaces, both ways [aspert2002].
struct SurfaceDistance {
    double mean = 0;  ///< mean distance of the vertices of each, weighted by area, the larger of both ways
    double rootMean = 0;   ///< the same as root mean square
    double hausdorff = 0;  ///< the largest distance of any vertex
};

/// Runs: connected voxels (by faces) whose sources have the same offsets.
struct Novelty {
    std::size_t voxels = 0;    ///< that have a source
    double verbatimShare = 0;  ///< of the voxels considered: those with a neighbour in their run
    double meanRun = 0;        ///< [voxels] mean size of runs of two voxels and more
    double largestRun = 0;     ///< [voxels]
    double largestShare = 0;   ///< largestRun over the exemplar's own voxels near its surface
    double exemplarUsed = 0;   ///< share of the exemplar's own voxels near its surface that are a source
    double seamRatio = 0;      ///< mean change of the gradient between neighbours of different runs over that
                               ///< within runs; 1: invisible; 0: no seams
    double seamShare = 0;      ///< of the pairs of neighbours: those of different runs
};

/// One statistic of a result relative to the spread of the exemplar's own sub-volumes.
struct Verdict {
    std::string name;
    double mean = 0;      ///< of the sub-volumes; of a curve or several numbers: 0
    double sigma = 0;     ///< standard deviation: root mean square distance from the mean
    double distance = 0;  ///< of the result from the mean
    double quartile = 0;  ///< 75th percentile (nearest rank) of the sub-volumes' distances from their mean
    double away() const { return sigma > 0 ? distance / sigma : distance > 0 ? 1e9 : 0; }
    /// Within two sigma and no further than three quarters of the sub-volumes.
    bool passes() const { return distance <= 2 * sigma && distance <= quartile; }
};

/// Distances of results from an exemplar, relative to its process.
struct Yardstick {
    std::string name;
    double results = 0;  ///< mean distance of the results from the exemplar
    double fresh = 0;    ///< mean distance of fresh samples of the process from it
    double shifted = 0;  ///< distance of the exemplar itself, shifted by half a voxel
    /// 1: as far as another sample of the process.
    double ratio() const {
        const double unit = fresh > shifted ? fresh : shifted;
        return unit > 0 ? results / unit : results > 0 ? 1e9 : 0;
    }
};

}  // namespace vdbsynth
