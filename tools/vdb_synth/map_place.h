#pragma once
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "tools/vdb_synth/command.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// Where --source-map writes the source map.
struct MapPlace {
    std::string path;     ///< empty: nowhere
    bool inside = false;  ///< into the .vdb output
};

/// @throw Error InvalidOption (no output to write it into)
MapPlace mapPlaceOf(const Arguments& arguments, const std::vector<std::string>& outputs);

bool anyVdb(const std::vector<std::string>& paths);

/// writeModel with the run's metadata; the map, if asked for, goes next to `surface` or into its own file.
void writeWithMap(Run& run, const LevelSet& model, const SourceMap& map, const MapPlace& place,
                  const std::vector<std::string>& paths, ModelOutputOptions outputs);

}  // namespace vdbsynth::cli
