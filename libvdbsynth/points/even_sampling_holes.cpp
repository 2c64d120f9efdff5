#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/points/even_sampling_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// A point in a plane.
struct Planar {
    double x, y;
};

double squaredLength(const Planar& p) {
    return p.x * p.x + p.y * p.y;
}

// The middle of the circle through the origin and two others, to be met counter-clockwise; nothing if they
// are nearly on a line.
bool circleMiddle(const Planar& p, const Planar& q, Planar& middle) {
    const double area = p.x * q.y - p.y * q.x, a = squaredLength(p), b = squaredLength(q);
    if (!(area > 1e-6 * (a + b))) return false;
    middle = {(q.y * a - p.y * b) / (2 * area), (p.x * b - q.x * a) / (2 * area)};
    return true;
}

// What was found from one point.
using Found = std::vector<AddedPoint>;

class HoleSearch {
public:
    HoleSearch(const PointSetSurface& surface, double scale, const SampledPoints& sampled, double radius)
        : mSurface(surface), mScale(scale), mSampled(sampled), mRadius(radius) {}

    // Circles through the point and two neighbours that hold none of the others.
    void from(std::size_t i, Found& found) const {
        thread_local std::vector<PlanarNeighbour> neighbours;
        thread_local std::vector<Planar> around;
        const Vec3d place = cast<double>(mSampled.points()[i]), normal = cast<double>(mSampled.normals()[i]);
        mSampled.around(place, normal, std::int64_t(i), neighbours);
        // The nearest first: they are in most circles.
        std::sort(neighbours.begin(), neighbours.end(),
                  [](const PlanarNeighbour& a, const PlanarNeighbour& b) {
                      return a.distance != b.distance ? a.distance < b.distance : a.number < b.number;
                  });
        around.clear();
        for (const PlanarNeighbour& n : neighbours) around.push_back({n.x * n.distance, n.y * n.distance});
        if (!touchesHole(around)) return;
        const TangentFrame frame(normal);
        for (const Planar& p : around)
            for (const Planar& q : around) {
                Planar middle;
                if (!circleMiddle(p, q, middle) || !isEmpty(around, middle)) continue;
                const auto foot =
                    projectScaled(mSurface, place + frame.u * middle.x + frame.v * middle.y, normal, mScale);
                if (foot && isHole(*foot)) found.push_back({*foot, std::uint32_t(i)});
            }
    }

private:
    // Whether any circle of the least radius through the point is empty: then one of those is that also go
    // through a neighbour.
    bool touchesHole(const std::vector<Planar>& around) const {
        for (const Planar& p : around) {
            const double rest = mRadius * mRadius / squaredLength(p) - 0.25;
            if (rest <= 0) continue;
            const double aside = std::sqrt(rest);
            for (const double side : {-aside, aside})
                if (holdsNone(around, {0.5 * p.x - side * p.y, 0.5 * p.y + side * p.x}, mRadius * mRadius))
                    return true;
        }
        return false;
    }

    static bool holdsNone(const std::vector<Planar>& around, const Planar& middle, double squared) {
        for (const Planar& p : around)
            if (squaredLength({p.x - middle.x, p.y - middle.y}) < 0.999 * squared) return false;
        return true;
    }

    bool isEmpty(const std::vector<Planar>& around, const Planar& middle) const {
        const double squared = squaredLength(middle);
        if (squared < mRadius * mRadius || squared > 6.25 * mRadius * mRadius) return false;
        return holdsNone(around, middle, squared);
    }

    bool isHole(const SurfaceFoot& foot) const {
        if (mSampled.any(foot.point, foot.normal, mRadius)) return false;
        thread_local std::vector<PlanarNeighbour> rim;
        mSampled.around(foot.point, foot.normal, -1, rim);
        return isSurrounded(rim);
    }

    const PointSetSurface& mSurface;
    double mScale;
    const SampledPoints& mSampled;
    double mRadius;
};

}  // namespace

std::vector<AddedPoint> middlesOfHoles(const PointSetSurface& surface, double scale,
                                       const SampledPoints& sampled, const std::vector<std::uint32_t>& from,
                                       double radius, const RunContext& ctx) {
    const HoleSearch search(surface, scale, sampled, radius);
    std::vector<Found> found(from.size());
    parallelFor(ctx, from.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) search.from(from[k], found[k]);
    });
    std::vector<AddedPoint> all;
    std::vector<Vec3f> places, normals;
    for (const Found& some : found)
        for (const AddedPoint& point : some) {
            all.push_back(point);
            places.push_back(cast<float>(point.foot.point));
            normals.push_back(cast<float>(point.foot.normal));
        }
    if (all.empty()) return all;
    std::vector<AddedPoint> kept;
    for (std::uint32_t i : withoutNear(places, normals, {}, radius, ctx)) kept.push_back(all[i]);
    return kept;
}

}  // namespace vdbsynth
