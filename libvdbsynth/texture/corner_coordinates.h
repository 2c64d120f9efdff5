#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/texture/textured_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Sites with what they were textured with. All are borrowed.
struct TexturedSurface {
    const std::vector<Vec3f>& point;   ///< [sites] world
    const std::vector<Vec3f>& normal;  ///< [sites] length 1
    const TexturedSites& sites;
    const std::vector<SampleImage>& samples;
    double texel = 1;  ///< [world]
};

/// The coordinate of a place in the chart of a site, by the paper's position formula: u(site) + ((V.S),
/// (V.T)), scaled to the length of V, where V goes from the site to the place [zhang2004, appendix A].
/// [texels]
Vec2f extendedCoordinate(const TexturedSurface& surface, std::size_t site, const Vec3f& place);

/// Coordinates of a mesh's corners, as pictures are mapped on it.
struct CornerCoordinates {
    std::vector<Vec2f> coordinate;     ///< [triangles x 3] in texels; corners of a triangle belong together
    std::vector<std::int32_t> sample;  ///< [triangles] TexturedSites::kNone: none of its sites has one
    std::size_t torn = 0;              ///< triangles across charts
};

/// A triangle whose corners continue each other takes their sites' coordinates, for tileable samples in the
/// same copy of the sample. A triangle across charts takes that of the corner which most others continue
/// (the first on a tie), extended to the others (extendedCoordinate). Two corners continue each other where
/// their coordinates differ from the extended one by at most half their distance and a texel.
/// @param triangles  of sites
/// @par Cost    O(triangles)   @par Repeats same bits for any number of threads
CornerCoordinates cornerCoordinates(const TexturedSurface& surface, const std::vector<Triangle>& triangles,
                                    const RunContext& ctx = {});

}  // namespace vdbsynth
