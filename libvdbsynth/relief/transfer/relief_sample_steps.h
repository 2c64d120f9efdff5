#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/relief/transfer/relief_charts.h"
#include "libvdbsynth/relief/transfer/relief_sample.h"

namespace vdbsynth {

/// Packs charts into an atlas, in rows by their heights, and fills its places, normals and mask, and the
/// share that is covered. An area that several charts show is in each of them.
/// @param largest  texels @throw Error Memory
void packCharts(const std::vector<ReliefChart>& charts, const std::vector<Triangle>& triangles,
                const SurfaceSites& sites, std::size_t largest, ReliefSample& sample, const RunContext& ctx);

/// Values of texels that no chart shows: ring by ring the means of those beside them.
void continueBeyondCharts(ReliefSample& sample, const RunContext& ctx);

/// Takes what is plain from the valid texels (ReliefSampleOptions::rough).
/// @param radius  [texels] around a texel that counts
void leavePlainOut(ReliefSample& sample, double share, double radius, const RunContext& ctx);

/// A place on the base and the normal there.
struct Placed3 {
    Vec3f place, normal;
};

/// Between texels, from those that a chart shows.
Placed3 placeAt(const ReliefSample& sample, const Vec2f& at);

}  // namespace vdbsynth
