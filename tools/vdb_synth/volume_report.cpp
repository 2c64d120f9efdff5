#include "tools/vdb_synth/volume_report.h"

#include "libvdbsynth/io/volume_file.h"
#include "libvdbsynth/pipeline/convert/model_unit.h"
#include "libvdbsynth/pipeline/convert/volume_output.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdbsynth::cli {

VolumeValues volumeValues(const Run& run) {
    const std::string values = run.arguments.text("values");
    return values == "distance"  ? VolumeValues::Distance
           : values == "density" ? VolumeValues::Density
                                 : VolumeValues::Inside;
}

bool writesVolume(const Run& run) {
    const std::vector<std::string> paths = run.arguments.all("output");
    return std::any_of(paths.begin(), paths.end(), [](const std::string& path) {
        VolumeFormat format{};
        return volumeFormatOf(path, format);
    });
}

void reportVolume(Run& run, const LevelSet& result) {
    if (!writesVolume(run) || !run.arguments.has("report")) return;
    const VolumeHead head = volumeHeadOf(inUnit(result, run.unit()), volumeValues(run));
    const double side = cellOf(head);
    nlohmann::json axes = nlohmann::json::array();
    for (std::size_t axis = 0; axis < 3; ++axis)
        axes.push_back({head.toWorld[4 * axis] / side, head.toWorld[4 * axis + 1] / side,
                        head.toWorld[4 * axis + 2] / side});
    run.count("volume", {{"values", head.name},
                         {"size", {head.size.x, head.size.y, head.size.z}},
                         {"first_voxel", {head.toWorld[12], head.toWorld[13], head.toWorld[14]}},
                         {"voxel_size", side},
                         {"axes", axes},
                         {"unit", head.unit.empty() ? nlohmann::json() : nlohmann::json(head.unit)}});
}

}  // namespace vdbsynth::cli
