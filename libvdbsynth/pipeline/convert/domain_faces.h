#pragma once
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

/// The faces of its recorded domain that a solid passes through: there it is cut, and continues beyond.
CutFaces facesTouched(const LevelSet& model);

/// A domain with a margin at the faces that are not cuts.
IndexBox grownBox(const IndexBox& domain, const CutFaces& cut, int by);

}  // namespace vdbsynth
