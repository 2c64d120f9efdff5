#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"

#include <optional>

namespace vdbsynth {

struct MinimalWallOptions {
    double share = 0.001;  ///< above 0, to 1: of the surface's area, the thinnest part that is looked at
};

/// @throw Error InvalidOption (`share`)
void validate(const MinimalWallOptions& options);

struct MinimalWall {
    double thickness = 0;  ///< [voxels]
    Vec3d place;           ///< [voxels] a point of the surface where the solid is that thick
};

/// The thinnest wall of a solid, for printing: the wall at a point of the surface is as thick as the way
/// from there along the inward normal to where it leaves the solid [shapira2008, with one ray]. The minimal
/// wall is the thickness that `share` of the area falls short of at most:
///     w = min { t : area(thickness <= t) >= share * area }.
/// So a plate gives its thickness, a ball its diameter, a box its shortest side; single noisy points do not
/// count, a spike counts from where it has that share of the area. The largest inner ball at a point
/// (thickness.h) is not meant: it shrinks to nothing in every corner of a box.
///
/// Points are the middles of the faces of the zero level (zero_level.h), of large surfaces about half a
/// million of them, evenly spaced in their order. Rays are marched through the trilinear field by nine tenths
/// of its value, at least a tenth of a voxel. Void thinner than that is not seen. Rays grow from 16 voxels on
/// until enough have left the solid.
/// @param field  distances [voxels], negative in the solid, at least in a narrow band; a box that begins at 0
/// @return none if less than `share` of the rays leave the solid within the box
/// @throw Error InvalidOption, BadData (as requireField), EmptyInput (no surface), Cancelled
/// @par Cost    O(cells of the surface), 0.25 seconds of one core for a ball that fills 128^3 voxels
/// @par Repeats same bits for any number of threads
std::optional<MinimalWall> minimalWall(const BrickField& field, const MinimalWallOptions& options = {},
                                       const RunContext& ctx = {});

}  // namespace vdbsynth
