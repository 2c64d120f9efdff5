#pragma once
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/vec3.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vdbsynth {

inline constexpr std::array<Vec3d, 3> kWorldAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Samples on a regular lattice as stored in files: an image (one slice), a stack of images, a volume.
struct Raster {
    Index3 size{0, 0, 0};       ///< columns, rows, slices
    int channels = 1;           ///< 1 (grey) or 3 (red, green, blue)
    std::vector<float> values;  ///< [slices x rows x columns x channels] as stored; NaN marks no data
    double white = 0;           ///< the value of white in an integer format (255, 65535); 0: real values
    bool rowsFromTop = false;   ///< the first row is the top one, as in pictures
    bool stack = false;         ///< a volume even if it has one slice
    bool knownSpacing = false;
    Vec3d spacing{1, 1, 1};  ///< [world] between samples along columns, rows, slices
    Vec3d origin{0, 0, 0};   ///< [world] of the first sample
    /// Unit directions in the world along columns, rows, slices; not at right angles in a sheared volume.
    std::array<Vec3d, 3> axes = kWorldAxes;
    std::string unit;  ///< of the spacing, if the file has one: "m", "mm"; else empty
    /// Names of the arrays, channels or frames that the file holds where they are several; one was read.
    std::vector<std::string> arrays;

    std::size_t index(int x, int y, int z) const {
        return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) + std::size_t(x);
    }
    float at(int x, int y, int z) const { return values[index(x, y, z)]; }  ///< for one channel
    std::size_t sampleCount() const { return latticeCount(size); }
};

/// The luminance of a colour raster, 0.2126 R + 0.7152 G + 0.0722 B of the stored values (ITU-R BT.709
/// weights, without gamma correction: heights are painted in displayed values); a grey raster unchanged.
Raster luminance(Raster raster);

/// @param size   [world] of the smallest side of a cell; 0: unset
/// @param sides  [world] along columns, rows and, for volumes, slices; 0: unset
/// @throw Error InvalidOption `pixelSize` (negative, too large, both given, columns without rows)
void requirePixelSize(double size, const Vec3d& sides);

/// The sides [world] of a raster's cells: its own unless they are given. An image has two, its third is 1.
/// @throw Error InvalidOption (three sides for an image, two for a volume)
Vec3d cellSides(const std::string& name, const Raster& raster, bool image, double size, const Vec3d& sides);

/// The range of a raster's values.
struct RasterRange {
    double minimum = 0, maximum = 0;
    std::size_t missing = 0;      ///< samples without data
    std::size_t infinite = 0;     ///< samples with infinite values
    bool whole = true;            ///< every value is a whole number
    std::vector<float> distinct;  ///< the values in ascending order if there are at most 256, else empty
};
RasterRange rangeOf(const Raster& raster);

}  // namespace vdbsynth
