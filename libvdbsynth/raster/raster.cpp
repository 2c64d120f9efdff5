#include "libvdbsynth/raster/raster.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

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

void requirePixelSize(double size, const Vec3d& sides) {
    const char* const allowed = "above 0 (world), or 0 for the file's";
    for (const double length : {size, sides.x, sides.y, sides.z})
        requireOption(length >= 0 && length < 1e30, "pixelSize", roundedText(length, 6), allowed);
    const bool given = sides.x > 0 || sides.y > 0 || sides.z > 0;
    requireOption(!given || (sides.x > 0 && sides.y > 0), "pixelSize",
                  roundedText(sides.x, 6) + "," + roundedText(sides.y, 6), "above 0 along columns and rows");
    if (given && size > 0)
        throw Error(ErrorCode::InvalidOption, "`pixelSize`: give one size or one for each axis, not both");
}

Vec3d cellSides(const std::string& name, const Raster& raster, bool image, double size, const Vec3d& sides) {
    Vec3d own = raster.spacing;
    if (image) own.z = 1;
    if (sides.x > 0) {
        if (image != (sides.z <= 0))
            throw Error(ErrorCode::InvalidOption,
                        "`pixelSize`: " + name +
                            (image ? " is an image; give one size, or two for columns and rows"
                                   : " is a volume; give one size, or three for columns, rows and slices"));
        return image ? Vec3d{sides.x, sides.y, 1} : sides;
    }
    if (size <= 0) return own;
    const double factor = size / std::min({own.x, own.y, image ? own.x : own.z});
    return {own.x * factor, own.y * factor, image ? 1 : own.z * factor};
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
