#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/scanline/scanline_steps.h"
#include "libvdbsynth/patch/scanline/thin_plate_warp.h"
#include "libvdbsynth/points/point_clusters.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

void append(const ScanlinePoint& point, PairingPoints& points) {
    points.points.push_back(point.point);
    points.normals.push_back(point.normal);
    points.variation.push_back(point.variation);
}

// Q: representatives of clusters of the points that lie in O_k.
PairingPoints targetsOf(const ScanlinePatch& patch, const std::vector<ScanlinePoint>& neighbours,
                        const ScanlineOptions& options, const RunContext& ctx) {
    PairingPoints inside, targets;
    const PlaneBox whole{patch.x, patch.y, patch.x + patch.side, patch.y + patch.side};
    for (const ScanlinePoint& point : neighbours)
        if (whole.holds(point.point) && patch.kept(point.point) > 0) append(point, inside);
    if (inside.points.empty()) return targets;
    const PointClusters clusters = clusterPoints(
        inside.points, inside.normals, {std::size_t(options.clusterPoints), options.clusterVariation}, ctx);
    for (const std::uint32_t number : clusters.representative) {
        targets.points.push_back(inside.points[number]);
        targets.normals.push_back(inside.normals[number]);
        targets.variation.push_back(inside.variation[number]);
    }
    return targets;
}

// Corners of F that no overlap reaches map to themselves, at both ends of its height.
void addAnchors(const ScanlinePatch& patch, const std::vector<ScanlinePoint>& points,
                std::vector<Vec3d>& from, std::vector<Vec3d>& to) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ScanlinePoint& point : points) {
        low = std::min(low, double(point.point.z));
        high = std::max(high, double(point.point.z));
    }
    const PlaneBox box = patch.box();
    for (const bool right : {false, true})
        for (const bool above : {false, true}) {
            if ((patch.left && !right) || (patch.below && !above)) continue;
            for (const double z : {low, high}) {
                from.push_back({right ? box.x1 : box.x0, above ? box.y1 : box.y0, z});
                to.push_back(from.back());
            }
        }
}

}  // namespace

std::size_t warpToNeighbours(const ScanlinePatch& patch, const std::vector<ScanlinePoint>& neighbours,
                             double spacing, const ScanlineOptions& options,
                             std::vector<ScanlinePoint>& points, const RunContext& ctx) {
    const PairingPoints targets = targetsOf(patch, neighbours, options, ctx);
    PairingPoints sources;
    for (const ScanlinePoint& point : points) append(point, sources);
    const std::vector<std::int32_t> pairs = pairPoints(sources, targets, spacing, options.pairing);
    std::vector<Vec3d> from, to;
    for (std::size_t q = 0; q < pairs.size(); ++q) {
        if (pairs[q] < 0) continue;
        from.push_back(cast<double>(sources.points[std::size_t(pairs[q])]));
        to.push_back(cast<double>(targets.points[q]));
    }
    const std::size_t count = from.size();
    if (count < ThinPlateWarp::kLeastPairs) return count;
    addAnchors(patch, points, from, to);
    const ThinPlateWarp warp(from, to);
    parallelFor(ctx, points.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const WarpedPlace warped = warp.at(cast<double>(points[p].point));
            points[p].point = cast<float>(warped.place);
            points[p].normal = cast<float>(warpedNormal(warped.jacobian, cast<double>(points[p].normal)));
        }
    });
    return count;
}

void blendToNeighbours(const ScanlinePatch& patch, const PointSetSurface& surface,
                       std::vector<ScanlinePoint>& points, const RunContext& ctx) {
    parallelFor(ctx, points.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            ScanlinePoint& point = points[p];
            const double kept = patch.kept(point.point);
            if (kept <= 0) continue;
            const Vec3d place = cast<double>(point.point), normal = cast<double>(point.normal);
            auto image = surface.intersect(place, normal, patch.margin, normal);
            if (const auto below = surface.intersect(place, -normal, patch.margin, normal);
                below && (!image || length(below->point - place) < length(image->point - place)))
                image = below;
            if (!image) image = surface.project(place, normal);
            if (!image || length(image->point - place) > patch.margin) continue;
            point.point = cast<float>(place + (image->point - place) * kept);
            point.normal = cast<float>(normalized(normal + (image->normal - normal) * kept));
            point.blended = 1;
        }
    });
}

}  // namespace vdbsynth
