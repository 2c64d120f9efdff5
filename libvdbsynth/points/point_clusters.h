#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

struct PointClusterOptions {
    std::size_t most = 32;    ///< points of a cluster, 1..1000000
    double variation = 0.05;  ///< 0..1/3, surface variation of a cluster above which it is split
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointClusterOptions& options);

struct PointClusters {
    std::vector<std::uint32_t> representative;  ///< [clusters] number of an actual point: the nearest to the
                                                ///< cluster's centroid
    std::vector<std::uint32_t> label;           ///< [n] number of each point's cluster
};

/// Adaptive clusters by halving [pauly2002, 4.1]: all points are one; a cluster of more than `most`, or whose
/// surface variation l0 / (l0 + l1 + l2) is over `variation`, is split by the plane through its centroid
/// across the direction of its greatest extent, until none is. With normals, one whose normals cancel (the
/// mean is shorter than a half) is split by them, along their principal direction: opposite sheets never
/// share a cluster. Clusters of up to three points are flat.
/// @param points   [n] finite   @param normals  [n] length 1, or empty
/// @return clusters in the order of the splits, near ones with near numbers
/// @throw Error InvalidOption, ShapeMismatch (normals of another number), Cancelled
/// @par Cost    O(n log n)   @par Repeats same bits for any number of threads
PointClusters clusterPoints(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals = {},
                            const PointClusterOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
