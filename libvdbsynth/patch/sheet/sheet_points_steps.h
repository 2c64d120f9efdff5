#pragma once
#include "libvdbsynth/patch/sheet/border_moves.h"
#include "libvdbsynth/patch/sheet/sheet_points.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// What the steps of sheetPoints work on.
struct SheetSource {
    const PatchExemplar& exemplar;
    const PointSetSurface& surface;
    const PatchField& field;
    const PatchArrangement& arrangement;
    const SheetOptions& options;
};

/// The exemplar's points by the columns of its lattice, and of its margins kPad more: patches are moved by
/// up to 2.5 steps (LaidPatch::fine).
class PointColumns {
public:
    static constexpr int kPad = 3;

    PointColumns(const PatchExemplar& exemplar, const PatchLattice& lattice);
    /// @param i, j  from -kPad to the side plus kPad - 1
    const std::uint32_t* begin(int i, int j) const { return mPoints.data() + mBegin[column(i, j)]; }
    const std::uint32_t* end(int i, int j) const { return mPoints.data() + mBegin[column(i, j) + 1]; }

private:
    std::size_t column(int i, int j) const { return mPadded.column(i + kPad, j + kPad); }

    PatchLattice mPadded;
    std::vector<std::size_t> mBegin;
    std::vector<std::uint32_t> mPoints;
};

/// A patch's side of its borders.
BorderMoves borderMoves(const SheetSource& source, std::int32_t patch);

/// A place at a border of a patch: its normal there, and from it to the other patch's surface.
struct BorderPair {
    Vec3d normal, move;
    std::int32_t other = 0;
};
/// At every second node of a patch's borders.
std::vector<BorderPair> borderPairs(const SheetSource& source, std::int32_t patch);

/// How many nodes every node is from one of another patch, along any axis or diagonally, up to `most`.
std::vector<std::uint8_t> borderDistance(const PatchArrangement& arrangement, int most,
                                         const RunContext& ctx);

/// Projects points near borders on the surface of all points near them, spreads them evenly there and puts
/// them off it by as much as the exemplar's points are off the exemplar's own: where both sides agree nothing
/// is smoothed away. A tile's ends are borders like others.
void blendBorders(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx);

}  // namespace vdbsynth
