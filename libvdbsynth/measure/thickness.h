#pragma once
#include "libvdbsynth/distance/distance_transform.h"

#include <vector>

namespace vdbsynth {

/// The side of the surface that is measured.
enum class Phase { Solid, Void };

/// Local thickness at every sample of a phase: the diameter of the largest ball inside the phase that
/// contains the sample [hildebrand1997]. For the void it is the pore size.
struct Thickness {
    Index3 size;
    int coarsening = 1;           ///< side of a sample in the voxels of the field
    std::vector<float> diameter;  ///< [size, x slowest] in the voxels of the field; 0 in the other phase
};

/// Balls are centred near the ridges of the distances, where, within half a sample, the surrounding distances
/// bound their radius least; of balls that are close relative to their radius the largest is drawn. Balls of
/// a radius over 16 samples are drawn on a lattice coarser by a power of two, with at least 8 of its samples
/// per radius. Balls may extend beyond the box, where nothing is known.
/// @param coarsening  that of the distances
/// @par Cost    memory 8 bytes per sample   @par Repeats same bits for any number of threads
Thickness localThickness(const Distances& distances, int coarsening, Phase phase, const RunContext& ctx = {});

/// Mean, deviation and distribution of the thickness over the phase's voxels in a box.
struct ThicknessSummary {
    double mean = 0, deviation = 0, largest = 0;  ///< [voxels]
    std::vector<double> share;  ///< [reach + 1] of the phase, by diameter r to r + 1; last: all above
};

/// @param box  [voxels of the field]
ThicknessSummary summarize(const Thickness& thickness, const IndexBox& box, int reach);

}  // namespace vdbsynth
