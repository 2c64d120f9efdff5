#include "libvdbsynth/distance/widen_band.h"

#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/distance/signed_distance.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/pyramid.h"

namespace vdbsynth {
namespace {

// The zero level within the reach of the domain.
Mesh zeroLevelAround(const KnownBand& known, float halfWidth, const RunContext& ctx) {
    return zeroLevel(known.field, known.domain.expanded(reachToWiden(halfWidth)), Facing::Inward, ctx);
}

}  // namespace

BrickField widenBand(const KnownBand& known, float halfWidth, const RunContext& ctx) {
    const Mesh mesh = zeroLevelAround(known, halfWidth, ctx);
    const BrickField distance = meshDistance(mesh, known.domain, halfWidth, ctx);
    return keepingDistances({distance, known.domain.min}, {known.field, known.domain.min},
                            known.domain.size(), known.band, ctx);
}

BrickField widenBandCoarse(const KnownBand& known, float halfWidth, const RunContext& ctx) {
    Mesh mesh = zeroLevelAround(known, 2 * halfWidth, ctx);
    // Coarse voxel i covers 2i and 2i + 1 of the domain. A thin bar's coarse mean is no distance; this is.
    for (Vec3f& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis) p[axis] = (p[axis] - float(known.domain.min[axis]) - 0.5f) / 2;
    const Index3 size = known.domain.size();
    const IndexBox box = IndexBox::fromSize({(size.x + 1) / 2, (size.y + 1) / 2, (size.z + 1) / 2});
    const BrickField distance = meshDistance(mesh, box, halfWidth, ctx);
    const BrickField inside =
        BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
            known.field.readBox(brick.min + known.domain.min, brick.size(), samples);
        });
    return withSigns({distance, {0, 0, 0}}, {halved(inside, ctx), {0, 0, 0}}, box.size(), ctx);
}

}  // namespace vdbsynth
