#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/relief/base_surface.h"

#include <vector>

namespace vdbsynth {

struct ReliefLayer;

/// The part of a relief between two wavelengths.
struct ReliefOctave {
    double shortest = 0,
           longest = 0;    ///< [voxels] where half of a wave is in this octave; shortest 0: all below
    double deviation = 0;  ///< [voxels] root mean square
};

/// Heights of a relief as one writes roughness [iso25178]: moments about their mean, weighted by the base's
/// area.
struct ReliefStatistics {
    double mean = 0;                 ///< [voxels]
    double sa = 0, sq = 0;           ///< [voxels] mean absolute and root mean square deviation
    double ssk = 0, sku = 0;         ///< skewness and kurtosis (3: a normal distribution); 0 without relief
    double lowest = 0, highest = 0;  ///< [voxels] from the base
    double area = 0;                 ///< [voxels^2] of the base that was measured
    double folded = 0, lost = 0;  ///< shares of that area where it is no height, and where nothing was found
    std::vector<ReliefOctave> octaves;  ///< short to long, to twice the base's cut-off wavelength
};

/// Statistics over the vertices of the base's mesh in a box, about one a voxel, without those that are lost.
/// Octaves: with M_L the mean of heights over the surface by a Gaussian of cut-off wavelength L (kCutOff; in
/// space over a layer of three voxels beside the base, so that both sides of a wall under L mix), an octave
/// is M_L - M_2L for L = 4, 8, 16 ... voxels, and what M_4 leaves is the first one. Of a wave of length w it
/// has 0.5^((L/w)^2) - 0.5^((2L/w)^2), at most 0.47 in amplitude: octaves compare two reliefs; their squares
/// do not add up to sq^2.
/// @param box    of the base's voxels; empty: all of it
/// @param known  a reliefLayer of the base, at least 1.5 voxels to either side, or null: it is made
/// @throw Error EmptyInput (no base in the box), Cancelled
/// @par Cost    as reliefLayer for a layer of three voxels   @par Repeats same bits for any number of threads
ReliefStatistics reliefStatistics(const BaseSurface& base, const IndexBox& box = {},
                                  const RunContext& ctx = {}, const ReliefLayer* known = nullptr);

}  // namespace vdbsynth
