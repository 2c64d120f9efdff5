#include "libvdbsynth/raster/raster.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

Raster luminance(Raster raster) {
    if (raster.channels == 1) return raster;
    const std::size_t count = raster.sampleCount();
    for (std::size_t i = 0; i < count; ++i) {
        const float* rgb = &raster.values[3 * i];
        raster.values[i] = float(0.2126 * double(rgb[0]) + 0.7152 * double(rgb[1]) + 0.0722 * double(rgb[2]));
    }
    raster.values.resize(count);
    raster.channels = 1;
    return raster;
}

RasterRange rangeOf(const Raster& raster) {
    constexpr std::size_t kMostDistinct = 256;
    RasterRange range;
    bool first = true, counting = true;
    float last = std::nanf("");
    for (float value : raster.values) {
        if (std::isnan(value)) {
            ++range.missing;
            continue;
        }
        if (std::isinf(value)) {
            ++range.infinite;
            continue;
        }
        if (value == last) continue;
        last = value;
        range.minimum = first ? double(value) : std::min(range.minimum, double(value));
        range.maximum = first ? double(value) : std::max(range.maximum, double(value));
        first = false;
        range.whole = range.whole && value == std::floor(value);
        if (!counting) continue;
        const auto at = std::lower_bound(range.distinct.begin(), range.distinct.end(), value);
        if (at == range.distinct.end() || *at != value) range.distinct.insert(at, value);
        counting = range.distinct.size() <= kMostDistinct;
    }
    if (!counting) range.distinct.clear();
    return range;
}

}  // namespace vdbsynth
