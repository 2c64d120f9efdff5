#pragma once
#include "libvdbsynth/measure/statistics.h"

#include <array>
#include <string>
#include <vector>

namespace vdbsynth {

/// Boxes of equal size that an exemplar is cut into: two along each of three stationary axes, three along
/// each of two, eight along one. The others keep their length.
/// @param stationary  x, y, z
/// @return empty if a box would be under `shortest` voxels long along a stationary axis
std::vector<IndexBox> subVolumes(const IndexBox& box, const std::array<bool, 3>& stationary, int shortest);

/// One statistic of a result beside the spread of the exemplar's own sub-volumes.
struct Verdict {
    std::string name;
    double mean = 0;      ///< of the sub-volumes; of a curve or several numbers: 0
    double sigma = 0;     ///< standard deviation, that is, root mean square distance from the mean
    double distance = 0;  ///< of the result from the mean
    double quartile = 0;  ///< 75th percentile (nearest rank) of the sub-volumes' distances from their mean
    double away() const { return sigma > 0 ? distance / sigma : distance > 0 ? 1e9 : 0; }
    /// Within two sigma and no further than three quarters of the sub-volumes.
    bool passes() const { return distance <= 2 * sigma && distance <= quartile; }
};

/// The mean of one statistic over several boxes, value by value. @param parts  one at least
Statistic meanOf(const std::vector<Statistic>& parts);

/// @param parts   the same statistic of each sub-volume, two at least
Verdict judge(const std::vector<Statistic>& parts, const Statistic& result);

/// The same for a distance to the exemplar: that of each sub-volume to the others, that of the result to the
/// exemplar; the mean is 0 by definition.
Verdict judgeDistance(const std::string& name, const std::vector<double>& parts, double result);

/// @return null if there is none of that name
const Verdict* findVerdict(const std::vector<Verdict>& verdicts, const std::string& name);

/// How far results are from an exemplar by the yardstick of its process.
struct Yardstick {
    std::string name;
    double results = 0;  ///< mean distance of the results from the exemplar
    double fresh = 0;    ///< mean distance of fresh exemplars of the process from it
    double shifted = 0;  ///< distance of the exemplar itself, shifted by half a voxel
    /// 1: as far as another exemplar of the process is.
    double ratio() const {
        const double unit = fresh > shifted ? fresh : shifted;
        return unit > 0 ? results / unit : results > 0 ? 1e9 : 0;
    }
};

}  // namespace vdbsynth
