#include "libvdbsynth/texture/point_surface.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr double kBytesOfPoint = 250;  // beside the neighbours, found and kept
constexpr std::uint32_t kOrientationDraw = 0x7a01;

template <typename T>
std::vector<T> permuted(const std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    std::vector<T> out;
    out.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) out.push_back(values[order[i]]);
    return out;
}

}  // namespace

PointSurface pointSurface(const TextureTarget& target, int neighbours, const RunContext& ctx) {
    requireOption(neighbours >= 3 && neighbours <= 256, "neighbours", std::to_string(neighbours),
                  "a whole number from 3 to 256");
    requireTarget(target);
    requireMemory(ctx, double(target.point.size()) * (8.0 * neighbours + kBytesOfPoint),
                  "the points' neighbours", "ask for fewer neighbours or points");
    PointSurface surface;
    surface.order = mortonOrder(target.point, ctx);
    std::vector<Vec3f> normals = permuted(target.normal, surface.order);
    for (Vec3f& normal : normals) normal = normalized(normal);
    surface.direction = permuted(target.direction, surface.order);
    surface.sites = sitesOfPoints(permuted(target.point, surface.order), std::move(normals),
                                  std::size_t(neighbours), ctx);
    const double spacing = meanNearestDistance(surface.sites);
    if (spacing > 0) surface.spacing = spacing;
    return surface;
}

Vec3f siteTangent(const PointSurface& surface, std::size_t site, const PointOrientationOptions& options,
                  std::uint64_t seed) {
    const Vec3f& normal = surface.sites.normal[site];
    if (!surface.direction.empty() && dot(surface.direction[site], surface.direction[site]) > 0)
        return tangentNear(normal, surface.direction[site]);
    if (options.orientation == PointOrientation::Up) return cross(tangentNear(normal, options.up), normal);
    const double angle = Random(seed, surface.order[site], kOrientationDraw).uniform(0, 2 * kPi);
    const Vec3f s = tangentNear(normal, {1, 0, 0});
    return s * float(cosine(angle)) + cross(normal, s) * float(sine(angle));
}

std::vector<Vec3f> siteTangents(const PointSurface& surface, const PointOrientationOptions& options,
                                const RunContext& ctx) {
    std::vector<Vec3f> tangents(surface.sites.size());
    parallelFor(ctx, tangents.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) tangents[i] = siteTangent(surface, i, options, ctx.seed);
    });
    return tangents;
}

ChartSite seedChart(const SurfaceSites& sites, std::size_t site, const Vec3f& tangent) {
    const Vec3d n = siteNormal(sites, site), s = cast<double>(tangent);
    return {{}, n, normalized(s - n * dot(s, n))};
}

Vec3f surfaceTangent(const PointSurface& surface, std::size_t site, const Vec3d& direction) {
    return tangentNear(surface.sites.normal[site], cast<float>(direction));
}

void validate(const PointOrientationOptions& options) {
    const double size = double(dot(options.up, options.up));
    requireOption(size > 0 && std::isfinite(size), "up", "of length 0 or not finite", "a direction");
}

TexturedSites inTargetOrder(const TexturedSites& sites, const std::vector<std::uint32_t>& order) {
    const std::size_t n = order.size(), channels = n > 0 ? sites.values.size() / n : 0;
    TexturedSites out = uncoloured(n, int(channels));
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t to = order[i];
        out.sample[to] = sites.sample[i];
        out.coordinate[to] = sites.coordinate[i];
        out.tangent[to] = sites.tangent[i];
        out.blended[to] = sites.blended[i];
        std::copy_n(sites.values.begin() + std::ptrdiff_t(i * channels), channels,
                    out.values.begin() + std::ptrdiff_t(to * channels));
    }
    return out;
}

TexturedSites uncoloured(std::size_t sites, int channels) {
    TexturedSites out;
    out.sample.assign(sites, TexturedSites::kNone);
    out.coordinate.assign(sites, {});
    out.tangent.assign(sites, {});
    out.values.assign(sites * std::size_t(channels), 0.f);
    out.blended.assign(sites, 0);
    return out;
}

void requireSample(const SampleImage& sample) {
    if (sample.width < 1 || sample.height < 1 || sample.channels < 1)
        throw Error(ErrorCode::EmptyInput, "the sample has no texels");
    if (sample.values.size() != sample.texels() * std::size_t(sample.channels))
        throw Error(ErrorCode::ShapeMismatch, "the sample's values are not as many as its texels");
    const auto finite = [](float v) { return std::isfinite(v); };
    if (!std::all_of(sample.values.begin(), sample.values.end(), finite))
        throw Error(ErrorCode::Unusable, "the sample has values that are not finite");
}

RandomOrder::RandomOrder(std::size_t count, std::uint64_t seed, std::uint32_t purpose)
    : mNumbers(count), mSeed(seed), mPurpose(purpose) {
    std::iota(mNumbers.begin(), mNumbers.end(), 0u);
}

std::uint32_t RandomOrder::draw() {
    const std::uint32_t left = std::uint32_t(mNumbers.size() - mDone);
    std::swap(mNumbers[mDone], mNumbers[mDone + Random(mSeed, mDone, mPurpose).below(left)]);
    return mNumbers[mDone++];
}

}  // namespace vdbsynth
