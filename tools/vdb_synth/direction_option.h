#pragma once
#include "libvdbsynth/pipeline/analogy.h"
#include "tools/vdb_synth/command.h"

#include <string>

namespace vdbsynth::cli {

/// What --NAME says: a word, a .vdb grid, or a file of strokes. Automatic if it is not given.
/// Strokes are .csv, .txt or .xyz rows `x y z dx dy dz` (commas or spaces), .json [{"position": [x,y,z],
/// "direction": [dx,dy,dz]}, ...], or .ply points whose normals are the directions; world.
/// @throw Error Io, BadData (with the line)
DirectionSource directionOf(Run& run, const std::string& name);

}  // namespace vdbsynth::cli
