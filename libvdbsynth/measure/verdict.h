#pragma once
#include "libvdbsynth/measure/measures.h"
#include "libvdbsynth/measure/statistics.h"

#include <array>
#include <string>
#include <vector>

namespace vdbsynth {

/// Boxes of equal size that an exemplar is cut into: two along each of three stationary axes, three along
/// each of two, eight along one. The other axes keep their length.
/// @param stationary  x, y, z
/// @return empty if a box would be shorter than `shortest` voxels along a stationary axis
std::vector<IndexBox> subVolumes(const IndexBox& box, const std::array<bool, 3>& stationary, int shortest);

/// The mean of one statistic over several boxes, value by value. @param parts  at least one
Statistic meanOf(const std::vector<Statistic>& parts);

/// @param parts   the same statistic of each sub-volume, at least two
Verdict judge(const std::vector<Statistic>& parts, const Statistic& result);

/// The same for a distance to the exemplar: of each sub-volume to the others, of the result to the exemplar;
/// the mean is 0 by definition.
Verdict judgeDistance(const std::string& name, const std::vector<double>& parts, double result);

/// Standard error of the volume fraction of one sample, from its own correlations:
///     s^2 = 1 / V sum_r 4 pi (r^2 + 1/12) (S2(r) - phi^2),
/// over shells of a voxel's width (one voxel for r = 0), up to the first r where S2 is down to phi^2
/// [torquato2002, section 2.2]. Unlike the spread of a few sub-volumes it is right for a sample of
/// any number of features. Too large where a texture repeats, as the sum is cut off.
/// @param radial  S2 [reach + 1]   @param fraction  phi   @param volume  V [voxels]
double fractionError(const std::vector<double>& radial, double fraction, double volume);

/// The volume fraction of a result against the exemplar's own standard error: within two of them.
Verdict judgeFraction(const std::vector<Statistic>& exemplar, double volume,
                      const std::vector<Statistic>& result);

/// @return null if none has that name
const Verdict* findVerdict(const std::vector<Verdict>& verdicts, const std::string& name);

}  // namespace vdbsynth
