#include "tools/vdb_synth/texture_size.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {

double longestSide(const LevelSet& model) {
    const Index3 size = model.domain.size();
    return double(std::max({size.x, size.y, size.z}));
}

namespace {

// @param unit  what `wanted` counts on the target   @param advice  for a scale that is not allowed
double checkedScale(const Arguments& arguments, double wanted, double side, const std::string& unit,
                    const std::string& advice) {
    if (arguments.has("scale"))
        throw Error(ErrorCode::InvalidOption, "--scale and --texture-size: give one of them");
    const double scale = wanted / side;
    const Option& option = *findOption(arguments.command(), "scale");
    if (scale < option.low || scale > option.high)
        throw Error(ErrorCode::InvalidOption,
                    "--texture-size " + roundedText(arguments.real("texture-size"), 6) + ": is " +
                        roundedText(wanted, 4) + " " + unit + " for a sample of " + roundedText(side, 6) +
                        ", a scale of " + roundedText(scale, 4) + " where " + rangeText(option) +
                        " is allowed; " + advice);
    return scale;
}

}  // namespace

double scaleOfSize(const Arguments& arguments, double side, double voxelSize, const std::string& finer) {
    const double wanted = arguments.real("texture-size") / voxelSize;
    return checkedScale(arguments, wanted, side, "voxels of the target",
                        "for a mesh sample " + finer + " " +
                            std::to_string(std::max(2L, std::lround(wanted))) +
                            " makes it 1, for a .vdb `convert --resolution`");
}

double scaleOfImage(const Arguments& arguments, double pixels, double spacing) {
    if (!(spacing > 0))
        throw Error(ErrorCode::Unusable, "--texture-size: the target is a single place; give --scale");
    return checkedScale(arguments, arguments.real("texture-size") / spacing, pixels,
                        "times the points' distance",
                        "--as levelset --resolution N makes points of another distance");
}

}  // namespace vdbsynth::cli
