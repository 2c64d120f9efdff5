// The paper's growth on a target.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_tangents.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/pipeline/relief/relief_steps.h"
#include "libvdbsynth/relief/growth/orientation_iteration.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::size_t kNeighbours = 8;
constexpr float kLimit = 3;  // [voxels]

// The sample's sites, in the target's voxels: `texel` of them are one of the sample's.
ReliefSites sitesOfSample(const ReliefSample& sample, float texel, const RunContext& ctx) {
    const BaseSurface& base = *sample.surface;
    const Mesh mesh = zeroLevel(base.distance, base.distance.box(), Facing::Outward, ctx);
    std::vector<Vec3f> normal, point;
    ReliefSites sites;
    for (const Vec3f& p : mesh.points) {
        const Vec3f n = normalized(sampleGradient(base.distance, p));
        normal.push_back(dot(n, n) > 0 ? n : Vec3f{0, 0, 1});
        point.push_back(p * texel);
        const ReliefPoint over = reliefAt(base, p, normal.back());
        const Vec3f off = over.folds ? over.vector : normal.back() * over.height;
        sites.displacement.push_back(off * texel);
    }
    std::vector<Vec3f> wanted;
    if (sample.directions) wanted = sample.directions(mesh.points, normal);
    sites.sites = sitesOfPoints(std::move(point), std::move(normal), kNeighbours, ctx);
    sites.tangent = siteTangents(sites.sites, wanted, double(texel), nullptr, ctx);
    return sites;
}

Mesh displacedMesh(const ReliefTarget& target, const std::vector<Vec3f>& displacement, float strength,
                   const RunContext& ctx) {
    Mesh mesh = zeroLevel(target.distance, target.distance.box(), Facing::Outward, ctx);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const float share = strength * (target.strength.empty() ? 1 : target.strength[i]);
        mesh.points[i] = mesh.points[i] + displacement[i] * share;
    }
    return mesh;
}

}  // namespace

BrickField grownOnTarget(const ReliefSample& sample, const PreparedTarget& prepared,
                         const ReliefOptions& options, ReliefResult& result, const RunContext& ctx) {
    if (!sample.surface)
        throw Error(ErrorCode::InvalidOption, "`method`: the paper's takes scans, no pictures of heights");
    const ReliefTarget& target = prepared.target;
    const float texel = float(result.texel / prepared.place.voxelSize);
    const ReliefSites sites = sitesOfSample(sample, texel, ctx);
    const SurfaceSites targetSites = sitesOfPoints(target.point, target.normal, kNeighbours, ctx);
    const BaseSurface& base = *sample.surface;
    const ReliefDistance distance(base.scan, {0, 0, 0}, double(texel), base.reach);
    GrownReliefOptions grow;
    grow.neighbourhood = options.neighbourhood / prepared.place.voxelSize;
    grow.top = options.top;
    // Without a direction the orientation is found by iteration.
    const GrownRelief grown =
        options.direction
            ? growRelief(sites, distance, targetSites,
                         siteTangents(targetSites, target.direction, 1, nullptr, ctx), grow, ctx)
            : growAndOrient(sites, distance, targetSites, grow, {}, ctx).relief;
    result.mismatch = grown.grownMean;
    const Mesh mesh = displacedMesh(target, grown.displacement, float(options.strength), ctx);
    const FloatGridPtr solid = meshToSolid(mesh, 1, kLimit, "the target with relief", {}, ctx);
    return gatherNarrowBand(*solid, target.distance.box(), ctx);
}

}  // namespace vdbsynth
