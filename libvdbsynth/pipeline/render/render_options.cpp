#include "libvdbsynth/pipeline/render/render_options.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/render/preview.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace vdbsynth {
namespace {

// A slice has no camera, no light and no colours.
void refuseWithSlice(const RenderOptions& options) {
    if (!options.slice) return;
    const std::pair<const char*, bool> given[] = {
        {"directions", options.directions != nullptr},
        {"view", options.view.has_value()},
        {"up", options.up.has_value()},
        {"wireframe", options.wireframe},
        {"turntable", options.turntable > 0},
        {"background", options.background.kind != Background::Kind::Studio},
        {"ground", !options.ground},
        {"sameScale", options.sameScale},
        {"color", !options.color.empty()}};
    for (const auto& [field, is] : given)
        if (is)
            throw Error(ErrorCode::InvalidOption,
                        std::string("`") + field + "`: cannot be combined with `slice`");
    requireOption(options.slice->axis >= 0 && options.slice->axis <= 2, "slice",
                  std::to_string(options.slice->axis), "an axis, 0, 1 or 2 for x, y or z");
    requireOption(options.slice->fraction >= 0 && options.slice->fraction <= 1, "slice",
                  roundedText(options.slice->fraction, 6), "a fraction from 0 to 1");
}

void requireView(const Vec3d& view) {
    const double reach = length(view);
    requireOption(reach > 1e-6 && reach < 1e6, "view",
                  roundedText(view.x, 6) + "," + roundedText(view.y, 6) + "," + roundedText(view.z, 6),
                  "a direction from the model to the camera, for example 1,-1.6,0.9");
}

void requireCaptions(const std::vector<std::string>& captions, std::size_t models) {
    if (captions.empty() || captions.size() == models) return;
    std::string all;
    for (const std::string& caption : captions) all += (all.empty() ? "" : ",") + caption;
    throw Error(ErrorCode::InvalidOption, "`captions` " + all + ": has " + std::to_string(captions.size()) +
                                              " captions for " + std::to_string(models) +
                                              " models; give one for each, or none");
}

// Of a hexadecimal digit; -1: it is none.
int digitOf(char letter) {
    const char digit = char(std::tolower(static_cast<unsigned char>(letter)));
    if (!std::isxdigit(static_cast<unsigned char>(digit))) return -1;
    return digit <= '9' ? digit - '0' : digit - 'a' + 10;
}

}  // namespace

void validate(const RenderOptions& options, std::size_t models) {
    if (models == 0) throw Error(ErrorCode::InvalidOption, "no model to draw; give at least one");
    requireOption(std::min(options.size[0], options.size[1]) >= 16 &&
                      std::max(options.size[0], options.size[1]) <= 8192,
                  "size", std::to_string(options.size[0]) + "x" + std::to_string(options.size[1]),
                  "from 16 to 8192 pixels each");
    PreviewOptions each;
    each.width = options.size[0];
    each.height = options.size[1];
    each.samples = options.samples;
    each.density = options.density;
    each.directions = options.directions;
    validate(each);
    if (options.view) requireView(*options.view);
    requireOption(options.turntable == 0 || (options.turntable >= 2 && options.turntable <= 3600),
                  "turntable", std::to_string(options.turntable), "from 2 to 3600 pictures, or 0 for one");
    requireOption(options.columns >= 1 && options.columns <= 64, "columns", std::to_string(options.columns),
                  "from 1 to 64");
    requireCaptions(options.captions, models);
    refuseWithSlice(options);
    if (!options.directions) return;
    if (!options.color.empty())
        throw Error(ErrorCode::InvalidOption, "`directions`: cannot be combined with `color`");
    if (models > 1)
        throw Error(ErrorCode::InvalidOption, "`directions`: belongs to one model, but several are given");
}

bool parseBackground(const std::string& text, Background& background) {
    background = {};
    if (text == "studio") return true;
    if (text == "transparent") {
        background.kind = Background::Kind::Transparent;
        return true;
    }
    background.kind = Background::Kind::Plain;
    for (const auto& [name, grey] :
         {std::pair<const char*, float>{"white", 1.f}, {"grey", 0.5f}, {"black", 0.f}})
        if (text == name) {
            background.colour = {grey, grey, grey};
            return true;
        }
    if (text.size() != 7 || text[0] != '#') return false;
    for (int c = 0; c < 3; ++c) {
        const int high = digitOf(text[std::size_t(1 + 2 * c)]), low = digitOf(text[std::size_t(2 + 2 * c)]);
        if (high < 0 || low < 0) return false;
        background.colour[c] = float(16 * high + low) / 255;
    }
    return true;
}

}  // namespace vdbsynth
