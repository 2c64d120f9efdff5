#include "libvdbsynth/io/readers/tiff/tiff_geography.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/math/trigonometry.h"

#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

// Where pixels lie on the map: the size of a pixel, and the latitude (if in degrees) of the image's middle.
struct Placement {
    double across = 0, down = 0, middle = 0;
    bool turned = false, mirrored = false;
};

bool usable(double size) {
    return size > 0 && size < 1e30;
}

bool placementOf(const TiffFile& file, const Raster& raster, Placement& place) {
    const std::vector<double> scale = file.reals(TiffTag::PixelScale);
    const std::vector<double> tie = file.reals(TiffTag::TiePoint);
    if (scale.size() >= 2 && usable(scale[0]) && usable(scale[1])) {
        place.across = scale[0];
        place.down = scale[1];
        if (tie.size() >= 6) place.middle = tie[4] - (raster.size.y / 2.0 - tie[1]) * scale[1];
        return true;
    }
    // A matrix of four rows by which columns and rows become places.
    const std::vector<double> m = file.reals(TiffTag::Transformation);
    if (m.size() < 16) return false;
    place.across = std::sqrt(m[0] * m[0] + m[4] * m[4]);
    place.down = std::sqrt(m[1] * m[1] + m[5] * m[5]);
    place.middle = m[7] + m[4] * raster.size.x / 2.0 + m[5] * raster.size.y / 2.0;
    constexpr double kLeast = 1e-6;
    place.turned = std::abs(m[4]) > kLeast * place.across || std::abs(m[1]) > kLeast * place.down;
    place.mirrored = !place.turned && (m[0] < 0 || m[5] > 0);
    return usable(place.across) && usable(place.down) && std::isfinite(place.middle);
}

bool inDegrees(const TiffFile& file) {
    constexpr std::uint16_t kModelType = 1024, kGeographic = 2;
    const std::vector<std::uint16_t> keys = file.shorts(TiffTag::GeoKeys);
    for (std::size_t i = 4; i + 3 < keys.size(); i += 4)
        if (keys[i] == kModelType && keys[i + 3] == kGeographic) return true;
    return false;
}

}  // namespace

void readGeography(const std::string& path, const TiffFile& file, Raster& raster, const RunContext& ctx) {
    Placement place;
    if (!placementOf(file, raster, place)) {
        constexpr std::size_t kTwoPoints = 12;
        if (file.reals(TiffTag::TiePoint).size() >= kTwoPoints)
            message(ctx, MessageLevel::Note,
                    path +
                        ": is placed on the map by control points only, which are not applied; "
                        "`pixelSize` sets the size of a pixel");
        return;
    }
    raster.spacing = {place.across, place.down, 1};
    raster.knownSpacing = true;
    if (inDegrees(file)) {
        constexpr double kMetresPerDegree = 111320, kRadians = 3.14159265358979323846 / 180;
        const double narrowing = std::abs(place.middle) < 89 ? cosine(place.middle * kRadians) : 1;
        raster.spacing = {place.across * kMetresPerDegree * narrowing, place.down * kMetresPerDegree, 1};
        raster.unit = "m";
    }
    if (place.turned || place.mirrored)
        message(ctx, MessageLevel::Note,
                path + ": is " + (place.turned ? "turned" : "mirrored") +
                    " on the map by its GeoTIFF matrix; of that only the size of a pixel is applied, " +
                    roundedText(raster.spacing.x, 6) + " x " + roundedText(raster.spacing.y, 6));
}

void dropNoData(const TiffFile& file, Raster& raster) {
    std::string word = file.text(TiffTag::NoData);
    while (!word.empty() && word.back() == ' ') word.pop_back();
    float value = 0;
    if (!parseAnyReal(word, value)) return;
    for (float& sample : raster.values)
        if (sample == value) sample = std::nanf("");
}

}  // namespace vdbsynth
