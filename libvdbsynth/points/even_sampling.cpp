#include "libvdbsynth/points/even_sampling.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/points/even_sampling_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kReach = 2;        // [spacings] of the forces
constexpr double kStrength = 0.16;  // [spacings] that a force of 1 moves a point; more makes them swing
constexpr double kLongest = 0.25;   // [spacings] of a step
constexpr int kSettling = 5;        // rounds after which points are put back on the surface
constexpr int kFillings = 3;        // as one point added to a wide hole leaves others

void requireSameLength(std::size_t points, std::size_t others, const char* what) {
    if (points != others)
        throw Error(ErrorCode::ShapeMismatch,
                    "there are " + countText(points, "point") + " but " + countText(others, what));
}

class Evening {
public:
    Evening(const PointSetSurface& surface, const EvenSamplingOptions& options, const RunContext& ctx)
        : mSurface(surface),
          mOptions(options),
          mContext(ctx),
          mScale(std::ldexp(1.0, -std::ilogb(options.spacing > 0 ? options.spacing : surface.spacing()))),
          mSpacing((options.spacing > 0 ? options.spacing : surface.spacing()) * mScale) {}

    EvenSampling run(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                     const std::vector<char>& fixed) {
        std::vector<Vec3f> scaled;
        for (const Vec3f& p : points) scaled.push_back(cast<float>(cast<double>(p) * mScale));
        mResult.source = withoutNear(scaled, normals, fixed, mOptions.tooNear * mSpacing, mContext);
        mResult.dropped = points.size() - mResult.source.size();
        for (std::uint32_t i : mResult.source) {
            mResult.points.push_back(scaled[i]);
            mResult.normals.push_back(normals[i]);
            mFixed.push_back(fixed.empty() ? 0 : fixed[i]);
        }
        // Points that were put on the surface make better neighbours.
        if (!mOptions.onSurface) forFree([&](std::size_t i) { settle(i, cast<double>(mResult.points[i])); });
        fill();
        for (int round = 1; round <= mOptions.rounds; ++round)
            moveApart(round == mOptions.rounds || round % kSettling == 0);
        for (std::size_t i = 0; i < mFixed.size(); ++i)
            mResult.points[i] = mFixed[i] ? points[mResult.source[i]]
                                          : cast<float>(cast<double>(mResult.points[i]) * (1 / mScale));
        return std::move(mResult);
    }

private:
    template <typename Work>
    void forFree(Work&& work) {
        parallelFor(mContext, mFixed.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (!mFixed[i]) work(i);
        });
    }

    void settle(std::size_t i, const Vec3d& place) {
        const auto foot = projectScaled(mSurface, place, cast<double>(mResult.normals[i]), mScale);
        if (!foot || length(foot->point - place) > mSpacing) return;
        mResult.points[i] = cast<float>(foot->point);
        mResult.normals[i] = cast<float>(foot->normal);
    }

    void fill() {
        std::vector<std::uint32_t> from;
        for (std::size_t i = 0; i < mFixed.size(); ++i)
            if (!mFixed[i]) from.push_back(std::uint32_t(i));
        for (int k = 0; k < kFillings && mOptions.tooWide > 0; ++k) {
            const double reach = std::max(kReach, 2.5 * mOptions.tooWide) * mSpacing;
            const SampledPoints sampled(mResult.points, mResult.normals, reach);
            const std::vector<AddedPoint> added =
                middlesOfHoles(mSurface, mScale, sampled, from, mOptions.tooWide * mSpacing, mContext);
            // What is left of a hole is beside what was added to it.
            from.clear();
            for (const AddedPoint& point : added) {
                from.push_back(std::uint32_t(mResult.points.size()));
                mResult.points.push_back(cast<float>(point.foot.point));
                mResult.normals.push_back(cast<float>(point.foot.normal));
                mResult.source.push_back(mResult.source[point.nearest]);
                mFixed.push_back(0);
            }
            mResult.added += added.size();
            if (added.empty()) return;
        }
    }

    // @param onSurface  else they only move within their planes: over few small steps these are as good
    void moveApart(bool onSurface) {
        const SampledPoints sampled(mResult.points, mResult.normals, kReach * mSpacing);
        forFree([&](std::size_t i) {
            thread_local std::vector<PlanarNeighbour> neighbours;
            const Vec3d place = cast<double>(sampled.points()[i]),
                        normal = cast<double>(sampled.normals()[i]);
            sampled.around(place, normal, std::int64_t(i), neighbours);
            if (!isSurrounded(neighbours)) {
                if (onSurface) settle(i, place);
                return;
            }
            double x = 0, y = 0;
            for (const PlanarNeighbour& neighbour : neighbours) {
                const double left = 1 - neighbour.distance / (kReach * mSpacing);
                x -= neighbour.x * left;
                y -= neighbour.y * left;
            }
            const double far = kStrength * std::sqrt(x * x + y * y);
            const double step = kStrength * mSpacing * (far > kLongest ? kLongest / far : 1);
            const TangentFrame frame(normal);
            const Vec3d moved = place + frame.u * (x * step) + frame.v * (y * step);
            if (onSurface)
                settle(i, moved);
            else
                mResult.points[i] = cast<float>(moved);
        });
    }

    const PointSetSurface& mSurface;
    EvenSamplingOptions mOptions;
    const RunContext& mContext;
    double mScale;    // of lengths here over those of the world: a power of two
    double mSpacing;  // 1 to 2
    EvenSampling mResult;
    std::vector<char> mFixed;
};

}  // namespace

void validate(const EvenSamplingOptions& options) {
    requireOption(options.spacing >= 0 && std::isfinite(options.spacing), "spacing",
                  exactText(options.spacing), "0 or more");
    requireOption(options.rounds >= 0 && options.rounds <= 100, "rounds", std::to_string(options.rounds),
                  "0 to 100");
    requireOption(options.tooNear >= 0 && options.tooNear <= 0.8, "tooNear", exactText(options.tooNear),
                  "0 to 0.8");
    requireOption(options.tooWide == 0 || (options.tooWide >= 0.8 && options.tooWide <= 5), "tooWide",
                  exactText(options.tooWide), "0, or 0.8 to 5");
}

EvenSampling evenSampling(const PointSetSurface& surface, const std::vector<Vec3f>& points,
                          const std::vector<Vec3f>& normals, const std::vector<char>& fixed,
                          const EvenSamplingOptions& options, const RunContext& ctx) {
    validate(options);
    requireSameLength(points.size(), normals.size(), "normal");
    if (!fixed.empty()) requireSameLength(points.size(), fixed.size(), "mark");
    throwIfCancelled(ctx);
    if (points.empty() || !(surface.spacing() > 0)) {
        // There is no surface to move on.
        EvenSampling same;
        same.points = points;
        same.normals = normals;
        for (std::size_t i = 0; i < points.size(); ++i) same.source.push_back(std::uint32_t(i));
        return same;
    }
    return Evening(surface, options, ctx).run(points, normals, fixed);
}

}  // namespace vdbsynth
