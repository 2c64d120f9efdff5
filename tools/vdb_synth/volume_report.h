#pragma once
#include "tools/vdb_synth/command.h"

namespace vdbsynth::cli {

/// What the volumes of a run hold, as --values says.
VolumeValues volumeValues(const Run& run);
/// True if an output of the run is a volume.
bool writesVolume(const Run& run);
/// Where a written volume lies, with --report as "volume" in "counts": its values, size (columns, rows,
/// slices), the first voxel's place, the voxels' side [world] and axes, and the unit
/// of the world if a file named it. Nothing if no output is a volume.
void reportVolume(Run& run, const LevelSet& result);

}  // namespace vdbsynth::cli
