#pragma once
#include "libvdbsynth/pipeline/patch/patch_outputs.h"
#include "libvdbsynth/pipeline/patch/patch_source.h"

namespace vdbsynth {

/// A sheet of an exemplar's geometry (patch/patch_synthesis.h), with a border around it, so that level sets
/// and meshes of it are right up to their sides. A tile's size is rounded to whole steps of the field, with a
/// note.
/// @param options  `border` is not read
/// @throw Error as synthesizePatches
/// @par Repeats same bits for any number of threads
PatchSheet makePatchSheet(const PatchSource& source, const PatchOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
