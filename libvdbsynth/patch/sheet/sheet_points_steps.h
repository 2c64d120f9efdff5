#pragma once
#include "libvdbsynth/patch/sheet/border_moves.h"
#include "libvdbsynth/patch/sheet/compact_warp.h"
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

/// The exemplar's points by the columns of its lattice, margins not included.
class PointColumns {
public:
    PointColumns(const PatchExemplar& exemplar, const PatchLattice& lattice);
    const std::uint32_t* begin(int i, int j) const { return mPoints.data() + mBegin[mLattice.column(i, j)]; }
    const std::uint32_t* end(int i, int j) const {
        return mPoints.data() + mBegin[mLattice.column(i, j) + 1];
    }

private:
    PatchLattice mLattice;
    std::vector<std::size_t> mBegin;
    std::vector<std::uint32_t> mPoints;
};

/// A patch's side of its borders.
BorderMoves borderMoves(const SheetSource& source, std::int32_t patch);

/// How many nodes every node is from one of another patch, along any axis or diagonally, up to `most`.
std::vector<std::uint8_t> borderDistance(const PatchArrangement& arrangement, int most,
                                         const RunContext& ctx);

/// Projects points near borders on the surface of all points near them, and drops those too near to one of
/// another patch.
void blendBorders(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx);

}  // namespace vdbsynth
