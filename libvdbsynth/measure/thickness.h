#pragma once
#include "libvdbsynth/measure/distance_transform.h"

#include <vector>

namespace vdbsynth {

/// Which side of the surface is meant.
enum class Phase { Solid, Void };

/// Local thickness at every sample of a phase: the diameter of the largest ball that lies in the phase and
/// holds the sample [hildebrand1997]. Of the void it is known as the pore size.
struct Thickness {
    Index3 size;
    int coarsening = 1;           ///< side of a sample in the voxels of the field
    std::vector<float> diameter;  ///< [size, x slowest] in the voxels of the field; 0 in the other phase
};

/// Balls stand near the ridges of the distances, where, within half a sample, the distances around bound
/// their radius least; of those close together in relation to their radius the largest is drawn. Balls of a
/// radius over 16 samples are drawn on a lattice coarser by a power of two, at least 8 of its samples a
/// radius. Balls may reach out of the box: what lies there is not known.
/// @param coarsening  that of the distances
/// @par Cost    memory 8 bytes a sample   @par Repeats same bits for any number of threads
Thickness localThickness(const Distances& distances, int coarsening, Phase phase, const RunContext& ctx = {});

/// Mean, deviation and distribution of the thickness over the phase's voxels in a box.
struct ThicknessSummary {
    double mean = 0, deviation = 0, largest = 0;  ///< [voxels]
    std::vector<double> share;  ///< [reach + 1] share of the phase with a diameter of r to r + 1; the last
                                ///< holds all above
};

/// @param box  [voxels of the field]
ThicknessSummary summarize(const Thickness& thickness, const IndexBox& box, int reach);

}  // namespace vdbsynth
