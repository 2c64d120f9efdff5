#pragma once
#include "libvdbsynth/raster/raster.h"
#include "tests/support/makers.h"

#include <cmath>
#include <functional>

// Rasters by formula, and where a field's surface is, for the tests of fields made from rasters.
namespace vdbsynth::test {

inline Raster rasterOf(const Index3& size, const std::function<float(int, int, int)>& value) {
    Raster raster;
    raster.size = size;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) raster.values.push_back(value(x, y, z));
    return raster;
}

/// Where the zero level crosses a line of voxels upwards, by linear interpolation; NaN if nowhere.
inline double crossing(const BrickField& field, Index3 p, int axis) {
    for (; p[axis] < field.box().max[axis]; ++p[axis]) {
        Index3 next = p;
        ++next[axis];
        const double a = double(field.at(p)), b = double(field.at(next));
        if (a < 0 && b >= 0) return p[axis] + a / (a - b);
    }
    return std::nan("");
}

}  // namespace vdbsynth::test
