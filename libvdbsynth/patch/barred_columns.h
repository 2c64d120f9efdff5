#pragma once
#include "libvdbsynth/patch/patch_field.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The columns of an exemplar that no patch may copy: a hole, and what is beside the texture. Says of any
/// place whether a patch there would have one, by a summed-area table [crow1984].
class BarredColumns {
public:
    /// @param barred  [columns] other than 0: barred
    /// @throw Error ShapeMismatch (another number of columns than the lattice's)
    /// @par Cost    O(columns)   @par Repeats yes
    BarredColumns(const PatchLattice& lattice, const std::vector<std::uint8_t>& barred);

    /// True if a column of the nx x ny that begin at (i, j), all within the lattice, is barred.
    /// @par Cost    O(1)
    bool any(int i, int j, int nx, int ny) const;
    /// The places at which a patch of nx x ny columns has none.
    std::size_t places(int nx, int ny) const;

private:
    std::size_t at(int i, int j) const { return std::size_t(i) * (std::size_t(mNy) + 1) + std::size_t(j); }

    int mNx, mNy;
    std::vector<std::uint32_t> mSums;  // [(nx + 1) x (ny + 1)] barred columns below (i, j)
};

}  // namespace vdbsynth
