#pragma once
#include "libvdbsynth/patch/patch_arrangement.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Gives a patch its part of the sheet: all columns under it at which nothing lies, and of the others the
/// nodes on its side of a minimum cut [kwatra2003], in three dimensions, so that a cut may run between two
/// sheets of a texture. Two adjacent nodes a and b of different patches cost M(a) + M(b),
///
///     M = 64 (|D_old - D_new| + 0.05 [|D_old| < 1 or |D_new| < 1] + 0.005),
///
/// D clamped to +-1.5 steps: nothing where both are empty, little where both have the same surface, 3 where
/// one has a wall that the other lacks. Nodes beside what only the old patches cover stay with these, nodes
/// beside what only the new one covers go to it; fixed columns (PatchArrangement::fixed) stay.
/// Where the overlap has over 6000 nodes, cells of 2^3 of them go to one side together.
/// @param patch  number of the patch, already in arrangement.patches
/// @param core   columns from its middle that go to the patch in any case; -1: none. For a patch over what is
///                covered already, which would get nothing else
/// @return true if any node was given to the patch
/// @par Cost    near linear in the overlap's nodes   @par Repeats same bits
bool cutIntoSheet(const PatchField& exemplar, std::int32_t patch, int core, PatchArrangement& arrangement);

}  // namespace vdbsynth
