#pragma once
#include "libvdbsynth/math/vec3.h"

#include <vector>

namespace vdbsynth {

/// Points with unit normals that face out of the solid.
struct PointCloud {
    std::vector<Vec3f> points;   ///< [points] world space
    std::vector<Vec3f> normals;  ///< [points], or empty
};

}  // namespace vdbsynth
