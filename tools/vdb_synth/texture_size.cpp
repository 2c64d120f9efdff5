#include "tools/vdb_synth/texture_size.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {

double longestSide(const LevelSet& model) {
    const Index3 size = model.domain.size();
    return double(std::max({size.x, size.y, size.z}));
}

namespace {

// @param unit  what `wanted` counts on the target, each of a length [world]
// @param advice  for a scale that is not allowed
double checkedScale(const Arguments& arguments, double wanted, double side, double length,
                    const std::string& unit, const std::string& advice) {
    if (arguments.has("scale"))
        throw Error(ErrorCode::InvalidOption, "--scale and --texture-size: give one of them");
    const double scale = wanted / side;
    const Option& option = *findOption(arguments.command(), "scale");
    if (scale < option.low || scale > option.high)
        throw Error(ErrorCode::InvalidOption,
                    "--texture-size " + roundedText(arguments.real("texture-size"), 6) + ": is " +
                        roundedText(wanted, 4) + " " + unit + " for a sample of " + roundedText(side, 6) +
                        ", a scale of " + roundedText(scale, 4) + " where " + rangeText(option) +
                        " is allowed; here sizes from " + roundedText(option.low * side * length, 4) +
                        " to " + roundedText(option.high * side * length, 4) + " fit; " + advice);
    return scale;
}

}  // namespace

double scaleOfSize(const Arguments& arguments, double side, double voxelSize, const std::string& sample) {
    const double wanted = arguments.real("texture-size") / voxelSize;
    const std::string voxels = std::to_string(std::max(2L, std::lround(wanted)));
    const std::string kind = extensionOf(sample);
    return checkedScale(arguments, wanted, side, voxelSize, "voxels of the target",
                        kind == "vdb" ? "`convert --resolution " + voxels + "` of the sample makes it 1"
                        : isMeshPath(sample) ? "--exemplar-resolution " + voxels + " makes it 1"
                                             : "a picture of " + voxels +
                                                   " pixels along that side makes it 1, other voxels of the "
                                                   "target change it too");
}

double scaleOfImage(const Arguments& arguments, double pixels, double spacing) {
    if (!(spacing > 0))
        throw Error(ErrorCode::Unusable, "--texture-size: the target is a single place; give --scale");
    return checkedScale(arguments, arguments.real("texture-size") / spacing, pixels, spacing,
                        "times the points' distance",
                        "--as levelset --resolution N makes points of another distance");
}

}  // namespace vdbsynth::cli
