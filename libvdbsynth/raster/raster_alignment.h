#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/nearest_frame.h"
#include "libvdbsynth/raster/raster.h"

#include <array>
#include <string>

namespace vdbsynth {

/// True for kWorldAxes, to the bit.
bool runAlongWorld(const std::array<Vec3d, 3>& axes);

/// How far three axes are turned from those of the world [degrees, 0..180], and the largest difference of
/// their mutual cosines from a right angle's. A reflection counts as the rotation of its mirror image.
struct AxesTurn {
    double degrees = 0, shear = 0;
};
AxesTurn turnOf(const std::array<Vec3d, 3>& axes);

/// A volume placed by an affine map of its indices: columns, rows and slices are exchanged and reversed until
/// they run along the nearest axes of the world, the rest of the rotation goes into Raster::axes. Axes within
/// 1e-5 of the world's become them, axes within 1e-4 of right angles exactly that.
/// @param toWorld  of the centres of samples, from columns, rows, slices
/// @throw Error BadData (a map that is not finite or flattens the volume), Memory
/// @par Cost    O(samples), a copy unless the order is kept   @par Repeats yes
Raster alignedToWorld(const std::string& name, Raster stored, const Affine& toWorld,
                      const RunContext& ctx = {});

}  // namespace vdbsynth
