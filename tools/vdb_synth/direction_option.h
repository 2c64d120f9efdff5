#pragma once
#include "libvdbsynth/pipeline/direction/direction.h"
#include "tools/vdb_synth/command.h"

#include <string>

namespace vdbsynth::cli {

/// The value of --NAME: a word, a .vdb grid, or a file of strokes; Automatic if it is not given. Strokes
/// (world) are rows `x y z dx dy dz` in .csv, .txt or .xyz (commas or spaces), with or without a first row of
/// these names, which then may stand in any order among others; .json [{"position": [x,y,z],
/// "direction": [dx,dy,dz]}, ...], or .ply points whose normals are the directions.
/// @throw Error Io, BadData (with the line)
DirectionSource directionOf(Run& run, const std::string& name);

}  // namespace vdbsynth::cli
