#pragma once
#include "libvdbsynth/measure/distance_transform.h"

#include <vector>

namespace vdbsynth {

/// Local thickness at every voxel of a phase: the diameter of the largest ball that lies in the phase and
/// holds the voxel's centre [hildebrand1997]. Of the void it is known as the pore size.
struct Thickness {
    Index3 size;
    int coarsening = 1;           ///< side of one sample in the voxels of the field: 1, 2, 4 ...
    std::vector<float> diameter;  ///< [size, x slowest] in the voxels of the field; 0 in the other phase
};

/// Distances are those of distancesWithin. Balls stand within half a sample of the samples whose ball lies in
/// no neighbour's, where the distances around bound the radius least. Balls of a radius over 16 samples are
/// drawn on a lattice coarser by a power of two, at least 8 of its samples a radius. Balls may reach out of
/// the box: what lies there is not known.
/// @param field  [voxels], box beginning at 0, right where |value| < `band`
/// @param limit  most samples; the field is halved until it has no more
/// @throw Error Memory, Cancelled
/// @par Cost    memory 12 bytes a sample   @par Repeats same bits for any number of threads
Thickness localThickness(const BrickField& field, float band, Phase phase, double limit,
                         const RunContext& ctx = {});

/// Mean, deviation and distribution of the thickness over the phase's voxels in a box.
struct ThicknessSummary {
    double mean = 0, deviation = 0, largest = 0;  ///< [voxels]
    std::vector<double> share;  ///< [reach + 1] share of the phase with a diameter of r to r + 1; the last
                                ///< holds all above
};

/// @param box  [voxels of the field]
ThicknessSummary summarize(const Thickness& thickness, const IndexBox& box, int reach);

}  // namespace vdbsynth
