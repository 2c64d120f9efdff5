#pragma once
#include "libvdbsynth/patch/onto/onto_arrangement.h"

namespace vdbsynth {

/// Gives a patch its part of a surface, as cutIntoSheet (layout/patch_cut.h) does on a sheet, with the same
/// costs: all columns in its radius at which nothing lies, and of the others the nodes on its side of a
/// minimum cut [kwatra2003] over the sites' graph and along the columns.
/// Where the overlap has over 6000 nodes, two of a column go to one side together.
/// @param patch  number of the patch, already in arrangement.patches
/// @param core   [world] radius around its centre that goes to the patch in any case; 0: none
/// @return nodes that were given to the patch
/// @par Cost    near linear in the overlap's nodes   @par Repeats same bits
std::size_t cutOntoSurface(const OntoSurface& surface, const PatchField& exemplar, std::int32_t patch,
                           double core, OntoArrangement& arrangement);

}  // namespace vdbsynth
