#pragma once
#include "libvdbsynth/math/vec3.h"

#include <vector>

namespace vdbsynth {

/// Which axis of the world points up in a picture.
enum class UpAxis { Y, Z };

/// The unit vector of an axis.
Vec3d upVector(UpAxis up);
/// The view that shows a model from its front, its right and a little above: 1,-1.6,0.9 where z is up, the
/// same view turned to 1,0.9,1.6 where y is.
Vec3d usualView(UpAxis up);

/// A perspective camera. `right`, `up` and `forward` are unit vectors at right angles.
struct Camera {
    Vec3d eye, forward, right, up;
    double spanX = 0, spanY = 0;  ///< half of what the picture shows at distance 1, along right and up

    /// Direction of a place in the picture, not of unit length: x and y from 0 to 1, from the left and top.
    Vec3d through(double x, double y) const {
        return forward + right * ((2 * x - 1) * spanX) + up * ((1 - 2 * y) * spanY);
    }
};

struct Framing {
    std::vector<Camera> cameras;  ///< one a view
    double distance = 0;          ///< [world] from the middle of the places' box to the eye, along the view
};

/// Cameras that show all of some places as large as the picture allows, with a margin of 4 % a side: of every
/// side of the picture the place that reaches farthest there decides, so that the model fills the frame. All
/// views share one distance and one offset, as frames of a turntable do.
/// @param places  [world] at least one
/// @param views   directions from the model to the camera, not zero; the picture's up is `up`, or along it
///                the world's next axis
/// @param aspect  width by height of the picture, above 0
/// @param least   [world] least distance of the eye: models of one row share the largest
/// @param below   0..0.5, share of the picture's height that stays free at its lower edge, for a label
/// @par Cost O(places * views)   @par Repeats yes
Framing framed(const std::vector<Vec3d>& places, const std::vector<Vec3d>& views, UpAxis up, double aspect,
               double least = 0, double below = 0);

/// Views around the up axis: the first is `view`, the model then turns counter-clockwise seen from above.
/// @param count  at least 1   @par Repeats same bits on every processor
std::vector<Vec3d> turntableViews(const Vec3d& view, UpAxis up, int count);

}  // namespace vdbsynth
