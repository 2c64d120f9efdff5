#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/raster/raster.h"

#include <array>
#include <string>

namespace vdbsynth {

/// A field whose zero level is a surface, negative inside, without unit, and the domain it was made for. The
/// field extends some voxels beyond the domain, where it repeats the outermost samples.
struct RasterField {
    BrickField field;
    IndexBox domain;
    double voxelSize = 1;                    ///< [world]
    Vec3d origin{0, 0, 0};                   ///< [world] of voxel 0,0,0
    std::array<Vec3d, 3> axes = kWorldAxes;  ///< unit directions of the voxels, at right angles
    /// [voxels] up to which the field's values are distances; 0: only its zero level means something.
    float distanceBand = 0;
    /// Share of an image's pixels whose heights lie farther than a voxel from the surface.
    double lostShare = 0;
    /// [voxels] of a volume's solid samples, within the domain, if they have only two sides; else 0.
    double solidVolume = 0;
    std::string keepsMore;    ///< begins what would keep more of that volume
    std::string description;  ///< the choices made, one line
};

inline constexpr float kRasterFieldLimit = 4.f;  ///< largest value of the fields here
inline constexpr int kRasterFieldMargin = 6;     ///< voxels by which they extend beyond the domain

}  // namespace vdbsynth
