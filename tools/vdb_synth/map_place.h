#pragma once
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/pipeline/outputs.h"
#include "tools/vdb_synth/command.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// --source-map: where the source map goes.
struct MapPlace {
    std::string path;     ///< empty: nowhere
    bool inside = false;  ///< into the .vdb output
};

/// @throw Error InvalidOption (no output to write it into)
MapPlace mapPlaceOf(const Arguments& arguments, const std::vector<std::string>& outputs);

bool anyVdb(const std::vector<std::string>& paths);

/// writeModel with the run's metadata, the map beside `surface` or in a file of its own, if any is asked for.
void writeWithMap(Run& run, const LevelSet& model, const SourceMap& map, const MapPlace& place,
                  const std::vector<std::string>& paths, ModelOutputOptions outputs);

}  // namespace vdbsynth::cli
