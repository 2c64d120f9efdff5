#include "tools/vdb_synth/map_place.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <filesystem>

namespace vdbsynth::cli {

bool anyVdb(const std::vector<std::string>& paths) {
    return std::any_of(paths.begin(), paths.end(),
                       [](const std::string& path) { return extensionOf(path) == "vdb"; });
}

namespace {

// The word after --source-map may be meant as an input: a model is replaced by a map only with --force.
void requireNoModel(const Arguments& arguments, const std::string& path) {
    std::error_code ignored;
    if (arguments.has("force") || !std::filesystem::is_regular_file(path, ignored)) return;
    std::vector<GridPtr> grids;
    try {
        grids = readVdbGrids(path);
    } catch (const Error&) {
        return;  // not a model: nothing to lose
    }
    if (grids.empty() || std::any_of(grids.begin(), grids.end(),
                                     [](const GridPtr& grid) { return isOfSourceMap(nameOf(*grid)); }))
        return;
    throw Error(ErrorCode::InvalidOption, "--source-map " + path +
                                              ": would replace a file that is not a source map; give another "
                                              "name, put a --source-map without FILE last, or give --force");
}

}  // namespace

MapPlace mapPlaceOf(const Arguments& arguments, const std::vector<std::string>& outputs) {
    MapPlace place{arguments.text("source-map"), false};
    if (place.path.empty() && arguments.has("map-types"))
        throw Error(ErrorCode::InvalidOption, "--map-types: needs --source-map, which writes the map");
    place.inside = place.path == kNoValue;
    if (place.path.empty()) return place;
    if (place.inside && !anyVdb(outputs))
        throw Error(ErrorCode::InvalidOption,
                    "--source-map: without a file it needs a .vdb output; give --source-map FILE.vdb");
    if (!place.inside) requireNoModel(arguments, place.path);
    return place;
}

void writeWithMap(Run& run, const LevelSet& model, const SourceMap& map, const MapPlace& place,
                  const std::vector<std::string>& paths, ModelOutputOptions outputs) {
    run.describeOutputs(outputs);
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
