#include "tools/vdb_synth/wall_report.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/model_wall.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdbsynth::cli {
namespace {

bool printed(const std::vector<std::string>& paths) {
    return std::any_of(paths.begin(), paths.end(), [](const std::string& path) {
        return extensionOf(path) == "stl" || extensionOf(path) == "3mf";
    });
}

}  // namespace

void reportWall(Run& run, const LevelSet& result) {
    const bool said = run.arguments.has("verbose") && printed(run.outputPaths());
    if (!said && !run.arguments.has("report")) return;
    const std::optional<MinimalWall> wall = modelWall(result, {}, run.context);
    run.count("minimal_wall", wall ? nlohmann::json(wall->thickness) : nlohmann::json());
    if (!wall) return;
    run.count("minimal_wall_at", {wall->place.x, wall->place.y, wall->place.z});
    if (said)
        message(run.context, MessageLevel::Detail,
                "minimal wall " + roundedText(wall->thickness, 3) + " (world), near " +
                    roundedText(wall->place.x, 4) + "," + roundedText(wall->place.y, 4) + "," +
                    roundedText(wall->place.z, 4) + ": a thousandth of the surface is thinner");
}

}  // namespace vdbsynth::cli
