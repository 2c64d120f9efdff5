#include "libvdbsynth/points/surface_variation.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/math/pca.h"
#include "libvdbsynth/points/surface_sites.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Of a point and those with the given numbers.
template <typename Number>
float variationOf(const std::vector<Vec3f>& points, std::size_t i, const Number* numbers, std::size_t count) {
    PointSums sums;
    sums.add({});
    for (std::size_t k = 0; k < count; ++k)
        if (numbers[k] != i) sums.add(cast<double>(points[numbers[k]]) - cast<double>(points[i]));
    return float(pointAxes(sums).variation());
}

}  // namespace

std::vector<float> surfaceVariation(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                                    std::size_t neighbours, const RunContext& ctx) {
    requireOption(neighbours >= 3 && neighbours <= 256, "neighbours", std::to_string(neighbours), "3 to 256");
    throwIfCancelled(ctx);
    if (!normals.empty() && normals.size() != points.size())
        throw Error(ErrorCode::ShapeMismatch, "there are " + countText(points.size(), "point") + " but " +
                                                  countText(normals.size(), "normal"));
    std::vector<float> variation(points.size());
    if (!normals.empty()) {
        const SurfaceSites sites = sitesOfPoints(points, normals, neighbours, ctx);
        parallelFor(ctx, points.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                variation[i] =
                    variationOf(points, i, sites.neighbours.data() + sites.begin[i], sites.degree(i));
        });
        return variation;
    }
    const PointNeighbours tree(points);
    parallelFor(ctx, points.size(), 512, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> numbers(neighbours + 1);
        std::vector<float> squared(neighbours + 1);
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t found = tree.nearest(points[i], neighbours + 1, numbers.data(), squared.data());
            variation[i] = variationOf(points, i, numbers.data(), found);
        }
    });
    return variation;
}

}  // namespace vdbsynth
