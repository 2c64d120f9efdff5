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

double scaleOfSize(const Arguments& arguments, double side, double voxelSize, const std::string& finer) {
    if (arguments.has("scale"))
        throw Error(ErrorCode::InvalidOption, "--scale and --texture-size: give one of them");
    const double wanted = arguments.real("texture-size") / voxelSize, scale = wanted / side;
    const Option& option = *findOption(arguments.command(), "scale");
    if (scale < option.low || scale > option.high)
        throw Error(ErrorCode::InvalidOption,
                    "--texture-size " + roundedText(arguments.real("texture-size"), 6) + ": is " +
                        roundedText(wanted, 4) + " voxels of the target for a sample of " +
                        roundedText(side, 6) + ", a scale of " + roundedText(scale, 4) + " where " +
                        rangeText(option) + " is allowed; for a mesh sample " + finer + " " +
                        std::to_string(std::max(2L, std::lround(wanted))) +
                        " makes it 1, for a .vdb `convert --resolution`");
    return scale;
}

}  // namespace vdbsynth::cli
