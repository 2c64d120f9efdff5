#pragma once
#include "libvdbsynth/pipeline/patch/patch_map.h"
#include "libvdbsynth/pipeline/patch/patch_outputs.h"
#include "tools/vdb_synth/command.h"

namespace vdbsynth::cli {

/// Writes a sheet to every -o: .ply its points, all others the level set or what writeModel makes of it.
/// @throw Error as sheetLevelSet, writeModel
void writeSheet(Run& run, const PatchSource& source, const PatchSheet& sheet);

/// repeat MAP EXEMPLAR for a map of patches.
/// @throw Error ShapeMismatch, and as loadPatchSource
void repeatPatchMap(Run& run, const PatchMapFile& map);

}  // namespace vdbsynth::cli
