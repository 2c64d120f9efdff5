#include "libvdbsynth/relief/transfer/relief_transfer.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_tangents.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kSpacing = 1;  // [voxels] between vertices of a zero level

void requireTarget(const ReliefTarget& target) {
    const std::size_t n = target.point.size();
    if (n == 0) throw Error(ErrorCode::EmptyInput, "the target has no surface");
    const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
    if (target.normal.size() != n || !fits(target.direction.size()) || !fits(target.label.size()) ||
        !fits(target.strength.size()))
        throw Error(ErrorCode::ShapeMismatch, "the target's sites and what they have differ in number");
}

// A map's sites in the order of the target's; sites are sorted along a curve for the synthesis.
struct Sorted {
    CoordinateSites sites;
    std::vector<std::uint32_t> order;
};

Sorted sortedSites(const ReliefTarget& target, std::vector<Vec3f>* singularities, const RunContext& ctx) {
    Sorted sorted;
    sorted.order = mortonOrder(target.point, ctx);
    std::vector<Vec3f> point, normal, direction;
    for (std::uint32_t i : sorted.order) {
        point.push_back(target.point[i]);
        normal.push_back(target.normal[i]);
        if (!target.direction.empty()) direction.push_back(target.direction[i]);
        if (!target.label.empty()) sorted.sites.label.push_back(target.label[i]);
    }
    sorted.sites.sites = sitesOfPoints(std::move(point), std::move(normal), kSiteNeighbours, ctx);
    sorted.sites.tangent = siteTangents(sorted.sites.sites, direction, kSpacing, singularities, ctx);
    return sorted;
}

}  // namespace

void makeSites(ReliefTarget& target, const RunContext& ctx) {
    target.point = zeroLevel(target.distance, target.distance.box(), Facing::Outward, ctx).points;
    if (target.point.empty()) throw Error(ErrorCode::EmptyInput, "the target has no surface");
    target.normal.resize(target.point.size());
    parallelFor(ctx, target.point.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f n = normalized(sampleGradient(target.distance, target.point[i]));
            target.normal[i] = dot(n, n) > 0 ? n : Vec3f{0, 0, 1};
        }
    });
}

void validate(const ReliefTransferOptions& options) {
    requireOption(options.texel >= 0.01 && options.texel <= 100, "texel", roundedText(options.texel, 6),
                  "from 0.01 to 100 (voxels)");
    requireOption(std::abs(options.strength) <= 100, "strength", roundedText(options.strength, 6),
                  "from -100 to 100");
    requireOption(options.minWall >= 0 && options.minWall < 1e6, "minWall", roundedText(options.minWall, 6),
                  "at least 0 (voxels)");
    validate(options.synthesis);
}

ReliefMap matchRelief(const ReliefTarget& target, const std::vector<ReliefSample>& samples,
                      const ReliefTransferOptions& options, const RunContext& ctx) {
    validate(options);
    requireTarget(target);
    return withThreads(ctx, [&] {
        ReliefMap map;
        const Sorted sorted = sortedSites(target, &map.singularities, ctx);
        CoordinateOptions synthesis = options.synthesis;
        if (anyDirection(target.direction))
            synthesis.maxRotation = std::min(synthesis.maxRotation, kGivenReliefRotation);
        std::vector<SampleImage> images;
        for (const ReliefSample& sample : samples) images.push_back(sample.image);
        CoordinateResult found = synthesizeCoordinates(sorted.sites, images, options.texel, synthesis, ctx);
        const std::size_t n = target.point.size();
        map.sample = target.label.empty() ? std::vector<std::int32_t>(n, 0) : target.label;
        map.coordinate.resize(n);
        map.tangent.resize(n);
        for (std::size_t k = 0; k < n; ++k) {
            map.coordinate[sorted.order[k]] = found.coordinate[k];
            map.tangent[sorted.order[k]] = found.tangent[k];
        }
        map.levels = std::move(found.levels);
        return map;
    });
}

float reliefReach(const std::vector<ReliefSample>& samples, const ReliefTransferOptions& options) {
    float most = 0;
    for (const ReliefSample& sample : samples) most = std::max({most, -sample.lowest, sample.highest});
    return most * float(options.texel * std::max(1.0, std::abs(options.strength))) + 3;
}

}  // namespace vdbsynth
