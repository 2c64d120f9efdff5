// What was lost, in words.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/solid/surface_loss.h"

#include <cmath>

namespace vdbsynth {

std::string lossText(const SurfaceLoss& loss, double voxelSize, double side) {
    std::string text = loss.share < 0.001   ? ""
                       : loss.share >= 0.01 ? std::to_string(int(100 * loss.share + 0.5)) + " %"
                                            : roundedText(100 * loss.share, 1) + " %";
    if (!text.empty()) text += " of its surface";
    if (loss.volumeLeft < 0.9)
        text += (text.empty() ? "" : " and ") + std::to_string(int(100 * (1 - loss.volumeLeft) + 0.5)) +
                " % of its volume";
    if (text.empty()) text = "less than a thousandth of its surface";
    text += loss.volumeLeft < 0.9 && loss.share >= 0.001 ? " are lost" : " is lost";
    if (loss.keepingVoxel > 0) text += ", as it is thinner than a voxel of " + roundedText(voxelSize, 4);
    std::string parts;
    const auto add = [&parts](std::size_t lost, std::size_t all, const char* one, const char* many) {
        if (lost == 0) return;
        parts += (parts.empty() ? ": " : ", ") + std::to_string(lost);
        if (all > 0) parts += " of " + std::to_string(all);
        parts += std::string(" ") + ((all > 0 ? all : lost) == 1 ? one : many);
    };
    add(loss.lostSolids, loss.solids, "closed part", "closed parts");
    add(loss.lostCavities, loss.cavities, "void", "voids");
    add(loss.lostOpen, 0, "open part", "open parts");
    text += parts + "; ";
    const double resolution = loss.keepingVoxel > 0 ? side / (voxelSize * loss.keepingVoxel) : 0;
    if (resolution > 0 && resolution < 10000)
        text += "`resolution` " + std::to_string(int(std::ceil(resolution))) + " would keep it, or ";
    return text + "`open` shell with a `thickness` of " + roundedText(2 * voxelSize, 3);
}

}  // namespace vdbsynth
