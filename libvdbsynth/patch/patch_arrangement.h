#pragma once
#include "libvdbsynth/patch/patch_candidates.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A patch that was laid on the sheet.
struct LaidPatch {
    PatchPlace from;     ///< its first column in the exemplar
    PatchPlace at;       ///< the same column on the sheet
    int nx = 0, ny = 0;  ///< columns
    Vec3d fine;          ///< [steps] by how much it is moved beyond that, along the plane
    double cost = 0;     ///< d^2 over the number of values, where it overlapped others
};

/// Which patch every node of a sheet is copied from: the source map of patch synthesis. A node (x, y, z) of
/// patch p is the exemplar's node (x - at + from, z), moved by `fine`.
struct PatchArrangement {
    static constexpr std::int32_t kNone = -1;

    PatchLattice lattice;  ///< of the sheet, with the exemplar's step and height
    int overlap = 1;       ///< [columns] that patches reach over earlier ones; warps fade within it
    bool tile = false;     ///< the sheet continues at its opposite side
    std::vector<LaidPatch> patches;
    /// [columns] other than 0: stays its patch's whatever is laid over it; empty: none does
    std::vector<std::uint8_t> fixed;
    std::vector<std::int32_t> label;  ///< [nodes] patch, kNone where nothing lies yet; whole columns of it

    /// The sheet's column for one that may lie outside; -1 if there is none.
    std::ptrdiff_t columnAt(int i, int j) const;
    bool isFixed(std::ptrdiff_t column) const {
        return column >= 0 && !fixed.empty() && fixed[std::size_t(column)] != 0;
    }
    bool known(std::ptrdiff_t column) const {
        return label[std::size_t(column) * std::size_t(lattice.nz)] != kNone;
    }
};

/// From plane space of the exemplar to that of the sheet, for a patch that is laid; both begin at their
/// lattice's corner.
Vec3d shiftOf(const PatchArrangement& arrangement, std::int32_t patch);

/// The exemplar's column that a patch has at a column of the sheet; of a tile in the period that is nearest
/// to the patch. It may lie outside the exemplar if the column is not the patch's.
PatchPlace sourceColumn(const PatchArrangement& arrangement, const LaidPatch& patch, int i, int j);

/// The field of a column of the sheet, as its patches' fields tell: distances are moved by `fine` along the
/// gradient.
/// @param values  array of nz x 4
void readColumn(const PatchField& exemplar, const PatchArrangement& arrangement, int i, int j, float* values);

/// One column of the exemplar moved by a fraction of a step: d - g . fine, clamped; gradients as they are.
void moveColumn(const float* from, int nz, const Vec3d& fine, float* values);

}  // namespace vdbsynth
