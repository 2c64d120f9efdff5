#pragma once
#include "libvdbsynth/math/vec3.h"

#include <optional>
#include <utility>
#include <vector>

namespace vdbsynth {

/// The ground plane of a height field. Columns run along its first axis, rows from bottom to top along its
/// second, height along the third.
enum class HeightPlane { XY, YZ, ZX };

struct HeightOptions {
    double voxelSize = 0;       ///< [world] above 0; 0: the pixel's size, or by resolution
    int resolution = 0;         ///< voxels along the image's longer side; 0: one per pixel
    double pixelSize = 0;       ///< [world] of a pixel's smallest side, above 0; 0: the file's, else 1
    Vec3d pixelSides{0, 0, 0};  ///< [world] along columns and rows, above 0, instead of pixelSize; 0: unset
    double height = 0;  ///< [world] above 0, from black to white, or from the lowest to the highest real
                        ///< value; 0: a tenth of the image's longer side, real values unchanged
    double base = 0;  ///< [world] above 0, of solid under the lowest point; 0: a twentieth of the longer side
    HeightPlane plane = HeightPlane::XY;
};

/// Values from low to high, both inclusive.
using LabelRange = std::pair<double, double>;

struct VolumeOptions {
    std::optional<double> threshold;  ///< solid where the value is above it
    std::optional<double> below;      ///< solid where the value is below it, as of distances
    std::vector<LabelRange> labels;   ///< solid where the value is one of these
    double pixelSize = 0;  ///< [world] of the smallest side of a sample's cell; 0: the file's, else 1
    Vec3d pixelSides{
        0, 0, 0};  ///< [world] of a cell along columns, rows and slices, instead of pixelSize; 0: unset
};

}  // namespace vdbsynth
