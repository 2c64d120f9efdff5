#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <optional>
#include <string>
#include <utility>

namespace vdbsynth {

/// What a mask holds.
enum class MaskKind {
    Box,     ///< the voxels of `box`
    Ball,    ///< the voxels whose centre is within `radius` of `center`
    Inside,  ///< the voxels inside a level set
    Range    ///< the active voxels of a grid with a value of `range`
};

/// Each kind needs the fields that it names, and no other.
struct MaskOptions {
    MaskKind kind = MaskKind::Box;
    std::optional<IndexBox> box;                     ///< [index] both corners inclusive, within 2^28
    std::optional<Vec3d> center;                     ///< [world] within 100 million voxels of the origin
    std::optional<double> radius;                    ///< [world] above 0, under ten thousand voxels
    std::optional<std::pair<double, double>> range;  ///< lowest and highest value, the lowest first
    std::optional<double>
        voxelSize;  ///< [world] of a box and a ball, above 0; none: 1. Others have the grid's
};

/// "box", "ball", "inside" or "range". @return false if it is none of these
bool parseMaskKind(const std::string& text, MaskKind& kind);

/// @throw Error InvalidOption (a field that the kind needs is missing or out of its range)
void validate(const MaskOptions& options);

/// A bool grid named "mask", active and true where the mask holds, else inactive. A field that the kind does
/// not need is said in a note.
/// @param grid  of Inside a level set, of Range a grid of floats, whose transform the mask has; null for the
/// others
/// @throw Error as validate; InvalidOption (no grid where one is needed, or one where none is), Memory,
/// Cancelled
/// @par Cost    a box by its surface and a 128^3th of its voxels, a ball by the voxels of the cube around it,
/// the others by the values of the grid
/// @par Repeats yes
GridPtr makeMask(const MaskOptions& options, const FloatGridConstPtr& grid = nullptr,
                 const RunContext& ctx = {});

}  // namespace vdbsynth
