#include "libvdbsynth/points/point_set_surface.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/points/point_set_surface_steps.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

const double kReachOverSpread = std::sqrt(12.0);  // R / h, see point_set_surface.h
constexpr float kSameSheet = 0.9f;  // cosine up to which what was gathered for a point serves another
constexpr double kStay = 0.05;      // [reach] steps that need not gather again
constexpr int kMostSteps = 24;
constexpr int kSettling = 3;         // steps that may grow
constexpr double kTolerance = 1e-4;  // spacings
constexpr double kFarthest = 1e18;   // squares of larger lengths are not floats

bool isFinite(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Vec3f unitNormal(const Vec3f& normal, std::size_t number) {
    const Vec3d n = cast<double>(normal);
    const double size = length(n);
    if (!(size > 0) || !std::isfinite(size))
        throw Error(ErrorCode::BadData, "the normal of point " + std::to_string(number) + " has no length");
    return cast<float>(n * (1 / size));
}

// Points by their coordinates, so that those that coincide are found.
class Places {
public:
    explicit Places(std::size_t count) {
        std::size_t size = 64;
        while (size < 2 * count) size *= 2;
        mNumbers.assign(size, -1);
    }
    // @return false if a point that faces the same way is there
    bool add(const OrientedPoints& points, std::size_t i) {
        // + 0 makes the two zeros one.
        const Vec3f& p = points.point[i];
        const float key[3] = {p.x + 0.f, p.y + 0.f, p.z + 0.f};
        std::size_t at = std::size_t(hash64(key, sizeof key)) & (mNumbers.size() - 1);
        for (; mNumbers[at] >= 0; at = (at + 1) & (mNumbers.size() - 1)) {
            const auto other = std::size_t(mNumbers[at]);
            const Vec3f gap = points.point[other] - p;
            if (gap.x == 0 && gap.y == 0 && gap.z == 0 && dot(points.normal[other], points.normal[i]) > 0)
                return false;
        }
        mNumbers[at] = std::int64_t(i);
        return true;
    }

private:
    std::vector<std::int64_t> mNumbers;
};

OrientedPoints distinctPoints(std::vector<Vec3f> points, std::vector<Vec3f> normals) {
    OrientedPoints all;
    all.point = std::move(points);
    all.normal = std::move(normals);
    Places places(all.point.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all.point.size(); ++i) {
        if (!isFinite(all.point[i]))
            throw Error(ErrorCode::BadData,
                        "a coordinate of point " + std::to_string(i) + " is not a finite number");
        all.point[kept] = all.point[i];
        all.normal[kept] = unitNormal(all.normal[i], i);
        if (places.add(all, kept)) ++kept;
    }
    all.point.resize(kept);
    all.normal.resize(kept);
    return all;
}

void requireBetween(double value, double low, double high, const std::string& field) {
    requireOption(value >= low && value <= high, field, exactText(value),
                  exactText(low) + " to " + exactText(high));
}

}  // namespace

void validate(const PointSetSurfaceOptions& options) {
    requireBetween(options.kernel, 1, 8, "kernel");
    requireBetween(options.normalWidth, 0.1, 2, "normalWidth");
}

PointSetSurface::PointSetSurface(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                                 const PointSetSurfaceOptions& options, const RunContext& ctx)
    : mImpl(new Impl) {
    validate(options);
    throwIfCancelled(ctx);
    if (points.size() != normals.size())
        throw Error(ErrorCode::ShapeMismatch, "there are " + countText(points.size(), "point") + " but " +
                                                  countText(normals.size(), "normal"));
    if (points.empty()) throw Error(ErrorCode::EmptyInput, "a point-set surface needs points");
    mImpl->options = options;
    OrientedPoints all = distinctPoints(std::move(points), std::move(normals));
    const double spread = coreOf(all.point).spread;
    if (spread > 0) mImpl->scale = std::ldexp(1.0, -std::ilogb(spread));
    for (Vec3f& p : all.point) p = cast<float>(cast<double>(p) * mImpl->scale);
    std::vector<float> reach = facingSpacing(all, ctx);
    std::vector<float> sorted = reach;
    const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    mImpl->spacing = double(*middle) / mImpl->scale;
    if (!(*middle > 0)) return;
    // A point without a neighbour that floats can tell from it takes the median.
    for (float& r : reach)
        r = float(options.kernel * kReachOverSpread) * (r > 0 && std::isfinite(r) ? r : *middle);
    mImpl->blocks = std::make_unique<PointBlocks>(all, reach);
}

PointSetSurface::~PointSetSurface() = default;
PointSetSurface::PointSetSurface(PointSetSurface&&) noexcept = default;
PointSetSurface& PointSetSurface::operator=(PointSetSurface&&) noexcept = default;

double PointSetSurface::spacing() const {
    return mImpl->spacing;
}

bool SurfaceWalk::begin(const Vec3d& place) {
    const std::int64_t found = mBlocks.heaviest(cast<float>(place), mGiven);
    if (found < 0) return false;
    mHeaviest = std::size_t(found);
    const StoredPoint& point = heaviest();
    if (mGathered && mSheet.shares(point).sure && dot(point.normal, mSheet.anchor.normal) > kSameSheet)
        return true;
    mSheet = {mGiven, point};
    mGathered = false;
    return true;
}

Vec3d SurfaceWalk::onTangentPlane(const Vec3d& place) const {
    const Vec3d p = cast<double>(heaviest().point), n = cast<double>(heaviest().normal);
    const Vec3d aside = (place - p) - n * dot(n, place - p);
    const double far = length(aside), most = 0.25 * double(heaviest().reach);
    return p + aside * (far > most ? most / far : 1);
}

std::optional<SurfaceFits> SurfaceWalk::at(const Vec3d& place) {
    thread_local std::vector<PointPack> packs;
    const double stay = mStay * double(heaviest().reach);
    const Vec3d away = place - cast<double>(mCentre);
    if (!mGathered || !(dot(away, away) <= stay * stay)) {
        mCentre = cast<float>(place);
        mGathered = true;
        mSure = mBlocks.gather(mCentre, mSheet, float(1.5 * mStay), packs);
    }
    const Vec3f relative = cast<float>(place - cast<double>(mCentre));
    if (!mSure) sharesOfSheet(packs, relative, heaviest().reach);
    return fitSurface(packs, relative, heaviest().reach / float(kReachOverSpread), mOptions);
}

double SurfaceWalk::spacing() const {
    return double(heaviest().reach) / (kReachOverSpread * mOptions.kernel);
}

bool PointSetSurface::Impl::inRange(const Vec3d& scaled) const {
    return std::abs(scaled.x) < kFarthest && std::abs(scaled.y) < kFarthest && std::abs(scaled.z) < kFarthest;
}

std::optional<SurfaceFoot> PointSetSurface::Impl::project(const Vec3d& place,
                                                          const SheetFacing* facing) const {
    const Vec3d scaled = place * scale;
    if (!blocks || !inRange(scaled)) return {};
    SurfaceWalk walk(*blocks, options, facing, kStay);
    if (!walk.begin(scaled)) return {};
    const double enough = kTolerance * walk.spacing();
    Vec3d x = walk.onTangentPlane(scaled), normal;
    double last = 1e300;
    bool fromPlace = true;
    for (int step = 0; step < kMostSteps; ++step) {
        const std::optional<SurfaceFits> fits = walk.at(x);
        const auto foot = fits ? fits->foot(fromPlace ? scaled - x : Vec3d{}) : std::nullopt;
        if (!foot || !inRange(x + foot->point)) return {};
        const double moved = length(foot->point);
        x = x + foot->point;
        normal = foot->normal;
        if (moved <= enough) break;
        // Over an edge the feet of the place jump between its sides; from the last of them the way down ends.
        if (step >= kSettling && moved > 0.5 * last) fromPlace = false;
        last = moved;
    }
    return SurfaceFoot{x * (1 / scale), normal};
}

std::optional<SurfaceFoot> PointSetSurface::project(const Vec3d& place) const {
    return mImpl->project(place, nullptr);
}

std::optional<SurfaceFoot> PointSetSurface::project(const Vec3d& place, const Vec3d& facing) const {
    const SheetFacing sheet{cast<float>(normalized(facing)), 0};
    return mImpl->project(place, &sheet);
}

}  // namespace vdbsynth
