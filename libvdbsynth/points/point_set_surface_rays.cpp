#include "libvdbsynth/points/point_set_surface_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kStay = 0.2;        // [reach] samples that need not gather again
constexpr double kShortest = 0.25;   // [spacings] of a step along the ray
constexpr double kOnSurface = 1e-4;  // [spacings]
constexpr double kJump = 0.02;       // [spacings] a value whose sign changes and is larger is no surface
constexpr int kHalvings = 40;
constexpr double kMostSteps = 2000;  // through space without points

// A ray in the blocks' units, and the value of the surface's function along it.
class Ray {
public:
    Ray(SurfaceWalk& walk, const Vec3d& origin, const Vec3d& direction)
        : mWalk(walk), mOrigin(origin), mDirection(direction) {}

    struct Sample {
        double t = 0, value = 0, spacing = 0;
        Vec3d normal;
    };
    Vec3d at(double t) const { return mOrigin + mDirection * t; }

    // How far the ray may go on from here without a sample: to a spacing before the nearest point. Nothing
    // where none is near.
    std::optional<double> free(double t) {
        if (!mWalk.begin(at(t))) return {};
        return length(at(t) - cast<double>(mWalk.heaviest().point)) - mWalk.spacing();
    }

    std::optional<Sample> sample(double t) {
        if (!mWalk.begin(at(t))) return {};
        const std::optional<SurfaceFits> fits = mWalk.at(at(t));
        const auto foot = fits ? fits->foot(Vec3d{}) : std::nullopt;
        if (!foot) return {};
        return Sample{t, foot->distance, mWalk.spacing(), foot->normal};
    }

    // The root between two samples of different sign, by secants that are halved where they are slow
    // (Illinois); nothing where the value jumps over zero.
    std::optional<Sample> root(Sample a, Sample b) {
        double weightA = a.value, weightB = b.value;
        for (int i = 0; i < kHalvings; ++i) {
            const double width = b.t - a.t;
            const double part = std::min(std::max(weightA / (weightA - weightB), 0.01), 0.99);
            const std::optional<Sample> middle = sample(a.t + width * (i % 8 == 7 ? 0.5 : part));
            if (!middle) return {};
            const double small = middle->spacing * kOnSurface;
            if (std::abs(middle->value) <= small) return middle;
            if (width <= small)
                return std::abs(middle->value) <= kJump * middle->spacing ? middle : std::nullopt;
            if (middle->value * a.value > 0) {
                a = *middle;
                weightA = a.value;
                weightB *= 0.5;
            } else {
                b = *middle;
                weightB = b.value;
                weightA *= 0.5;
            }
        }
        return {};
    }

private:
    SurfaceWalk& mWalk;
    Vec3d mOrigin, mDirection;
};

// The part of 0..reach for which a ray is in a box; empty if the second is less than the first.
std::pair<double, double> clipped(const Vec3d& origin, const Vec3d& direction, double reach, const Vec3f& low,
                                  const Vec3f& high) {
    double from = 0, to = reach;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = double(low[axis]) - origin[axis], b = double(high[axis]) - origin[axis];
        if (direction[axis] == 0) {
            if (a > 0 || b < 0) return {1, 0};
            continue;
        }
        const double first = a / direction[axis], second = b / direction[axis];
        from = std::max(from, std::min(first, second));
        to = std::min(to, std::max(first, second));
    }
    return {from, to};
}

}  // namespace

std::optional<SurfaceFoot> PointSetSurface::Impl::intersect(const Vec3d& origin, const Vec3d& direction,
                                                            double reach, const SheetFacing* facing) const {
    const Vec3d scaled = origin * scale, along = normalized(direction);
    if (!blocks || !inRange(scaled) || !(dot(along, along) > 0.5)) return {};
    const auto [from, to] = clipped(scaled, along, reach * scale, blocks->low(), blocks->high());
    SurfaceWalk walk(*blocks, options, facing, kStay);
    Ray ray(walk, scaled, along);
    // Space without points is crossed by steps that no kernel fits between.
    const double blind = std::max(0.5 * double(blocks->leastReach()), (to - from) / kMostSteps);
    const auto foot = [&](const Ray::Sample& hit) {
        return SurfaceFoot{ray.at(hit.t) * (1 / scale), hit.normal};
    };
    std::optional<Ray::Sample> last;
    for (double t = from, step = 0; t <= to; t = std::min(t + step, to)) {
        const std::optional<double> free = ray.free(t);
        const std::optional<Ray::Sample> now = free && *free < walk.spacing() ? ray.sample(t) : std::nullopt;
        if (now && std::abs(now->value) <= kOnSurface * now->spacing) return foot(*now);
        if (now && last && now->value * last->value < 0)
            if (const auto hit = ray.root(*last, *now)) return foot(*hit);
        last = now;
        step = !free ? blind : std::max(now ? std::abs(now->value) : *free, kShortest * walk.spacing());
        if (t == to || !(t + step > t)) break;
    }
    return {};
}

std::optional<SurfaceFoot> PointSetSurface::intersect(const Vec3d& origin, const Vec3d& direction,
                                                      double reach) const {
    return mImpl->intersect(origin, direction, reach, nullptr);
}

std::optional<SurfaceFoot> PointSetSurface::intersect(const Vec3d& origin, const Vec3d& direction,
                                                      double reach, const Vec3d& facing) const {
    const SheetFacing sheet{cast<float>(normalized(facing)), 0};
    return mImpl->intersect(origin, direction, reach, &sheet);
}

}  // namespace vdbsynth
