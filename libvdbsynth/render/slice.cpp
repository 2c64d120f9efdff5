#include "libvdbsynth/render/slice.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/render/drawn_text.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Gamma 2 for 2.2: a square root has the same bits on every processor.
std::uint8_t encode(double light) {
    return std::uint8_t(std::clamp(std::sqrt(std::max(0.0, light)), 0.0, 1.0) * 255 + 0.5);
}

// @param value  distance [voxels]   @param scale  voxels per pixel
Vec3d colourOf(double value, double scale) {
    const double line = std::abs(value - std::floor(value + 0.5)) / scale;
    Vec3d colour = value < 0 ? Vec3d{0.85, 0.55, 0.30} : Vec3d{0.55, 0.68, 0.85};
    colour = colour * (1 - 0.12 * std::min(std::abs(value), 3.0));
    if (line < 0.7 && std::abs(value) < 2.9) colour = colour * 0.85;
    // The zero level is two pixels wide, with soft edges.
    const double ink = std::clamp(1.5 - std::abs(value) / scale, 0.0, 1.0);
    return colour * (1 - ink);
}

// @param unit  world units of a pixel
void drawScaleBar(Picture& picture, double unit) {
    const int size = std::max(12, picture.height / 36);
    if (picture.width < 160 || picture.height < 120) return;
    const double worldLength = roundLength(unit * picture.width * 0.25);
    const std::string text = roundedText(worldLength, 3) + (worldLength == 1 ? " unit" : " units");
    const int margin = size, bar = int(worldLength / unit + 0.5), thick = std::max(2, size / 5);
    const int wide = std::max(bar, textWidth(text, size)), left = picture.width - margin - wide;
    const int base = picture.height - margin;
    blendRectangle(picture, left - size / 2, base - thick - size * 2, left + wide + size / 2, base + size / 2,
                   {255, 255, 255}, 0.82);
    const int from = left + (wide - bar) / 2;
    blendRectangle(picture, from, base - thick, from + bar, base, {20, 22, 26}, 1);
    for (const int end : {from, from + bar - thick / 2 - 1})
        blendRectangle(picture, end, base - 3 * thick, end + thick / 2 + 1, base, {20, 22, 26}, 1);
    drawText(picture, text, left + (wide - textWidth(text, size)) / 2, base - thick - size - size / 2, size,
             {20, 22, 26});
}

}  // namespace

double roundLength(double most) {
    double power = 1;
    while (power > most) power /= 10;
    while (power * 10 <= most) power *= 10;
    return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

void validate(const SliceOptions& options, const IndexBox& box) {
    requirePictureSize(options.width, options.height);
    requireOption(options.axis >= 0 && options.axis <= 2, "axis", std::to_string(options.axis),
                  "0, 1 or 2 for x, y or z");
    requireOption(options.fraction >= 0 && options.fraction <= 1, "fraction",
                  roundedText(options.fraction, 6), "from 0 to 1");
    requireBox(box, "box");
}

Picture renderSlice(const openvdb::FloatGrid& grid, const IndexBox& box, const SliceOptions& options,
                    const RunContext& ctx) {
    validate(options, box);
    const int axis = options.axis, across = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
    const double slice = box.min[axis] + options.fraction * (box.max[axis] - box.min[axis]);
    const double scale =
        std::max(double(box.size()[across]) / options.width, double(box.size()[up]) / options.height) *
        1.04;  // voxels per pixel
    const double voxel = voxelSizeOf(grid);
    Picture picture{options.width, options.height,
                    std::vector<std::uint8_t>(std::size_t(options.width) * std::size_t(options.height) * 3)};
    parallelFor(ctx, std::size_t(options.height), 8, [&](std::size_t begin, std::size_t end) {
        const auto accessor = grid.getConstAccessor();
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < options.width; ++x) {
                Vec3d p;
                p[axis] = slice;
                p[across] =
                    0.5 * (box.min[across] + box.max[across]) + (x + 0.5 - 0.5 * options.width) * scale;
                p[up] = 0.5 * (box.min[up] + box.max[up]) - (y + 0.5 - 0.5 * options.height) * scale;
                const double value = double(openvdb::tools::BoxSampler::sample(accessor, toVec(p))) / voxel;
                const Vec3d colour = colourOf(value, scale);
                const std::size_t pixel = std::size_t(y) * std::size_t(options.width) + std::size_t(x);
                for (int c = 0; c < 3; ++c) picture.pixels[pixel * 3 + std::size_t(c)] = encode(colour[c]);
            }
    });
    if (options.scaleBar) drawScaleBar(picture, scale * voxel);
    return picture;
}

}  // namespace vdbsynth
