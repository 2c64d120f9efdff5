#include "libvdbsynth/points/point_clusters.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/math/pca.h"

#include <algorithm>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr double kCancelling = 0.5;  // length of the mean normal below which a cluster is more than one sheet

class Splitting {
public:
    Splitting(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
              const PointClusterOptions& options)
        : mPoints(points), mNormals(normals), mOptions(options), mOrder(points.size()) {
        std::iota(mOrder.begin(), mOrder.end(), 0u);
    }

    PointClusters run(const RunContext& ctx) {
        PointClusters clusters;
        clusters.label.resize(mPoints.size());
        if (mPoints.empty()) return clusters;
        std::vector<Range> open{{0, mPoints.size()}};
        for (std::size_t done = 0; !open.empty(); ++done) {
            if (done % 256 == 0) throwIfCancelled(ctx);
            const Range range = open.back();
            open.pop_back();
            const std::size_t middle = split(range);
            if (middle == range.begin) {
                for (std::size_t k = range.begin; k < range.end; ++k)
                    clusters.label[mOrder[k]] = std::uint32_t(clusters.representative.size());
                clusters.representative.push_back(nearestTo(range, mCentroid));
                continue;
            }
            open.push_back({middle, range.end});
            open.push_back({range.begin, middle});
        }
        return clusters;
    }

private:
    struct Range {
        std::size_t begin, end;
    };

    // Sorts a range in two. @return where the second begins; the range's begin if it is a cluster
    std::size_t split(const Range& range) {
        const Vec3d origin = cast<double>(mPoints[mOrder[range.begin]]);
        PointSums sums, facing;
        for (std::size_t k = range.begin; k < range.end; ++k) {
            sums.add(cast<double>(mPoints[mOrder[k]]) - origin);
            if (!mNormals.empty()) facing.add(cast<double>(mNormals[mOrder[k]]));
        }
        const PointAxes axes = pointAxes(sums);
        mCentroid = origin + axes.mean;
        if (range.end - range.begin < 2) return range.begin;
        if (!mNormals.empty() && length(facing.first) < kCancelling * double(facing.count)) {
            const Vec3f across = cast<float>(pointAxes(facing, false).axis[2]);
            const std::size_t middle =
                partition(range, [&](std::uint32_t i) { return dot(mNormals[i], across) < 0; });
            if (middle > range.begin && middle < range.end) return middle;
        }
        if (range.end - range.begin <= mOptions.most && axes.variation() <= mOptions.variation)
            return range.begin;
        const std::size_t middle = partition(range, [&](std::uint32_t i) {
            return dot(cast<double>(mPoints[i]) - mCentroid, axes.axis[2]) < 0;
        });
        // Coinciding points have no two sides.
        return middle > range.begin && middle < range.end ? middle : (range.begin + range.end) / 2;
    }

    template <typename Before>
    std::size_t partition(const Range& range, Before&& before) {
        const auto begin = mOrder.begin();
        return std::size_t(std::stable_partition(begin + std::ptrdiff_t(range.begin),
                                                 begin + std::ptrdiff_t(range.end), before) -
                           begin);
    }

    std::uint32_t nearestTo(const Range& range, const Vec3d& place) const {
        std::uint32_t nearest = mOrder[range.begin];
        double least = 1e300;
        for (std::size_t k = range.begin; k < range.end; ++k) {
            const Vec3d away = cast<double>(mPoints[mOrder[k]]) - place;
            if (dot(away, away) >= least) continue;
            least = dot(away, away);
            nearest = mOrder[k];
        }
        return nearest;
    }

    const std::vector<Vec3f>& mPoints;
    const std::vector<Vec3f>& mNormals;
    PointClusterOptions mOptions;
    std::vector<std::uint32_t> mOrder;
    Vec3d mCentroid;  // of the range that was looked at last
};

}  // namespace

void validate(const PointClusterOptions& options) {
    requireOption(options.most >= 1 && options.most <= 1000000, "most", std::to_string(options.most),
                  "1 to 1000000");
    requireOption(options.variation >= 0 && options.variation <= 1.0 / 3, "variation",
                  exactText(options.variation), "0 to 1/3");
}

PointClusters clusterPoints(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                            const PointClusterOptions& options, const RunContext& ctx) {
    validate(options);
    if (!normals.empty() && normals.size() != points.size())
        throw Error(ErrorCode::ShapeMismatch, "there are " + countText(points.size(), "point") + " but " +
                                                  countText(normals.size(), "normal"));
    throwIfCancelled(ctx);
    return Splitting(points, normals, options).run(ctx);
}

}  // namespace vdbsynth
