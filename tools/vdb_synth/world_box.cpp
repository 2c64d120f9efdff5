#include "tools/vdb_synth/world_box.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {
namespace {

constexpr double kFar = 1 << 28;  // [voxels] beyond this, sizes of boxes exceed int
// [voxels] for centres that lie on an end but for rounding.
constexpr double kOnEnd = 1e-6;

bool isRotated(const Affine& transform) {
    const double side = std::abs(transform[0]);
    for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            if (row == column ? !(transform[4 * column + row] > 0)
                              : std::abs(transform[4 * column + row]) > 1e-9 * side)
                return true;
    return false;
}

}  // namespace

IndexBox voxelsOf(const BoxValue& box, const Affine& transform, const std::string& given) {
    const bool world = std::any_of(box.begin(), box.end(), [](const SizeValue& end) { return end.world; });
    if (world && isRotated(transform))
        throw Error(ErrorCode::InvalidOption,
                    given + ": the model's voxels are rotated in the world; give the box in voxels");
    IndexBox voxels;
    for (std::size_t i = 0; i < 6; ++i) {
        const int axis = int(i % 3);
        double end = box[i].value;
        if (box[i].world) {
            const double index = (end - transform[std::size_t(12 + axis)]) / transform[std::size_t(5 * axis)];
            end = std::ceil(index - kOnEnd) - (i < 3 ? 0 : 1);
        }
        if (!(std::abs(end) <= kFar))
            throw Error(ErrorCode::InvalidOption, given + ": must be within 268 million voxels of " +
                                                      roundedText(transform[std::size_t(5 * axis)], 6) +
                                                      " (world)");
        (i < 3 ? voxels.min : voxels.max)[axis] = int(end);
    }
    if (voxels.empty())
        throw Error(ErrorCode::InvalidOption,
                    given + ": holds no voxel; voxels are " + roundedText(transform[0], 6) + " wide (world)");
    return voxels;
}

}  // namespace vdbsynth::cli
