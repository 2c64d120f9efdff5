#include "tools/vdb_synth/map_place.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>

namespace vdbsynth::cli {

bool anyVdb(const std::vector<std::string>& paths) {
    return std::any_of(paths.begin(), paths.end(),
                       [](const std::string& path) { return extensionOf(path) == "vdb"; });
}

MapPlace mapPlaceOf(const Arguments& arguments, const std::vector<std::string>& outputs) {
    MapPlace place{arguments.text("source-map"), false};
    place.inside = place.path == kNoValue;
    if (place.path.empty()) return place;
    if (place.inside && !anyVdb(outputs))
        throw Error(ErrorCode::InvalidOption,
                    "--source-map: without a file it goes into a .vdb output, and there is none; give "
                    "--source-map FILE.vdb");
    return place;
}

void writeWithMap(Run& run, const LevelSet& model, const SourceMap& map, const MapPlace& place,
                  const std::vector<std::string>& paths, ModelOutputOptions outputs) {
    outputs.metadata = run.metadata();
    std::vector<GridPtr> grids;
    if (!place.path.empty()) {
        const MapTypes types =
            run.arguments.text("map-types") == "float" ? MapTypes::Float : MapTypes::Integer;
        grids = sourceMapGrids(map, *model.grid, run.context, types);
    }
    if (place.inside) outputs.extraGrids.insert(outputs.extraGrids.end(), grids.begin(), grids.end());
    writeModel(model, paths, outputs, run.outputs(), run.context);
    if (!place.path.empty() && !place.inside)
        writeVdb(run.outputs().add(place.path), grids, outputs.metadata);
}

}  // namespace vdbsynth::cli
