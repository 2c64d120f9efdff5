#include "libvdbsynth/patch/patch_exemplar.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

int firstAxis(PatchPlane plane) {
    return plane == PatchPlane::XY ? 0 : plane == PatchPlane::YZ ? 1 : 2;
}

// The box's height reaches a little beyond the points, so that fields on it see both sides of them.
constexpr double kAbove = 2;  // [spacings]

}  // namespace

Vec3d toPlane(PatchPlane plane, const Vec3d& world) {
    const int first = firstAxis(plane);
    return {world[first], world[(first + 1) % 3], world[(first + 2) % 3]};
}

Vec3d fromPlane(PatchPlane plane, const Vec3d& place) {
    const int first = firstAxis(plane);
    Vec3d world;
    for (int axis = 0; axis < 3; ++axis) world[(first + axis) % 3] = place[axis];
    return world;
}

PatchExemplar patchExemplar(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                            const PatchBox& box, PatchPlane plane, double spacing, bool fitHeight) {
    if (points.size() != normals.size())
        throw Error(ErrorCode::ShapeMismatch, "the texture's points and normals differ in number");
    if (!(spacing > 0)) throw Error(ErrorCode::InvalidOption, "the points' spacing must be above 0");
    Vec3d low = toPlane(plane, box.min), high = toPlane(plane, box.max);
    if (!(high.x > low.x && high.y > low.y))
        throw Error(ErrorCode::InvalidOption, "the texture's box is empty");
    const Vec3d given{low.z, high.z, 0};
    low.z = std::numeric_limits<double>::infinity();
    high.z = -low.z;
    std::size_t inside = 0;
    for (const Vec3f& point : points) {
        const Vec3d place = toPlane(plane, cast<double>(point));
        if (place.x < low.x || place.x >= high.x || place.y < low.y || place.y >= high.y) continue;
        ++inside;
        low.z = std::min(low.z, place.z);
        high.z = std::max(high.z, place.z);
    }
    if (inside == 0) throw Error(ErrorCode::EmptyInput, "no point lies in the texture's box");
    low.z = fitHeight ? std::min(given.x, low.z - kAbove * spacing) : given.x;
    high.z = fitHeight ? std::max(given.y, high.z + kAbove * spacing) : given.y;
    PatchExemplar exemplar;
    exemplar.size = high - low;
    exemplar.spacing = spacing;
    exemplar.plane = plane;
    exemplar.corner = fromPlane(plane, low);
    for (std::size_t i = 0; i < points.size(); ++i) {
        exemplar.points.push_back(cast<float>(toPlane(plane, cast<double>(points[i])) - low));
        exemplar.normals.push_back(cast<float>(normalized(toPlane(plane, cast<double>(normals[i])))));
        exemplar.number.push_back(std::uint32_t(i));
    }
    return exemplar;
}

double fittingKernel(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals, double spacing,
                     const RunContext& ctx) {
    constexpr std::size_t kNearest = 48, kLooked = 20000;
    constexpr double kThin = 6, kOpposite = -0.5, kShare = 0.05;
    const PointNeighbours neighbours(points);
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kLooked),
                      looked = points.size() / stride;
    std::vector<std::uint8_t> thin(looked, 0);
    parallelFor(ctx, looked, 64, [&](std::size_t begin, std::size_t end) {
        std::uint32_t numbers[kNearest];
        float squared[kNearest];
        for (std::size_t n = begin; n < end; ++n) {
            const std::size_t point = n * stride;
            const std::size_t found = neighbours.nearest(points[point], kNearest, numbers, squared);
            for (std::size_t f = 0; f < found; ++f)
                if (double(squared[f]) < kThin * kThin * spacing * spacing &&
                    double(dot(normals[numbers[f]], normals[point])) < kOpposite)
                    thin[n] = 1;
        }
    });
    const auto count = std::count(thin.begin(), thin.end(), std::uint8_t(1));
    return double(count) > kShare * double(looked) ? 1 : 2;
}

}  // namespace vdbsynth
