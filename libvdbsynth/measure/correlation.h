#pragma once
#include "libvdbsynth/grid/occupancy.h"

#include <array>
#include <vector>

namespace vdbsynth {

/// S2(r): the probability that two points r apart are both solid [torquato2002, section 2.1]. Only pairs
/// inside the box are counted, so that boxes of any size agree in the mean.
struct TwoPointCorrelation {
    std::vector<double> radial;               ///< [reach + 1] over all directions
    std::array<std::vector<double>, 3> axis;  ///< [reach + 1] along x, y, z
};

/// One of each pair of opposite displacements whose length rounds to r: all of them if there are at most 48,
/// else at most 48 spread evenly over the half sphere. @param r  0 and more
std::vector<Index3> radialShifts(int r);

/// @param reach  longest r [voxels], at least 1; if no pair lies in the box, values are 0
/// The radial value at r is the mean over radialShifts(r).
/// @par Cost    O(48 * reach * voxels / 64)   @par Repeats same bits for any number of threads
TwoPointCorrelation twoPointCorrelation(const Occupancy& solid, int reach, const RunContext& ctx = {});

/// Statistics of a solid along lines of voxels of one axis.
struct LineStatistics {
    /// [reach + 1] lineal path: the probability that a segment from one voxel to the r-th after it is all
    /// solid; 0: one voxel [torquato2002, section 2.4]
    std::vector<double> linealPath;
    /// [reach + 1] share of the chords of that length; the last holds all longer ones. Chords cut by the box
    /// are not counted; whole ones of length l are weighted by 1 / (n - 1 - l) in a line of n, because the
    /// longer a chord, the less often the box contains it whole [miles1974].
    std::vector<double> chords;
    double meanChord = 0;  ///< [voxels] solid voxels over chord beginnings, including cut chords, unbiased
};

/// @param axis  0, 1, 2   @param reach  [voxels] at least 1   @par Repeats yes
LineStatistics lineStatistics(const Occupancy& solid, int axis, int reach);

}  // namespace vdbsynth
