#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/relief_base_option.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/pipeline/relief/relief_outputs.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

nlohmann::json countsJson(const SurfaceCounts& counts) {
    return {{"solid_parts", counts.solids}, {"enclosed_voids", counts.voids}, {"tunnels", counts.tunnels}};
}

// Lengths in world units.
nlohmann::json statisticsJson(const ReliefExtraction& result) {
    const ReliefStatistics& s = result.statistics;
    const double voxel = result.voxelSize;
    nlohmann::json octaves = nlohmann::json::array();
    for (const ReliefOctave& octave : s.octaves)
        octaves.push_back({{"shortest_wave", octave.shortest * voxel},
                           {"longest_wave", octave.longest * voxel},
                           {"deviation", octave.deviation * voxel}});
    return {{"Sa", s.sa * voxel},
            {"Sq", s.sq * voxel},
            {"Ssk", s.ssk},
            {"Sku", s.sku},
            {"mean", s.mean * voxel},
            {"lowest", s.lowest * voxel},
            {"highest", s.highest * voxel},
            {"area", s.area * voxel * voxel},
            {"folded_share", s.folded},
            {"lost_share", s.lost},
            {"octaves", octaves}};
}

void report(Run& run, const ReliefExtraction& result) {
    run.count("base_radius", result.radius);
    run.count("cut_off_wavelength", result.radius * kCutOff);
    run.count("relief", statisticsJson(result));
    run.count("topology", {{"scan", countsJson(result.scanCounts)}, {"base", countsJson(result.baseCounts)}});
    run.count("scan_beyond_share", result.fields.beyond);
    nlohmann::json tried = nlohmann::json::array();
    for (std::size_t i = 0; i < result.scale.radii.size(); ++i)
        tried.push_back({{"radius", result.scale.radii[i] * result.voxelSize},
                         {"deviation", result.scale.deviation[i] * result.voxelSize}});
    if (!tried.empty()) run.count("radii_tried", tried);
    const ReliefStatistics& s = result.statistics;
    message(run.context, MessageLevel::Note,
            "base radius " + roundedText(result.radius, 4) + ", relief Sa " +
                roundedText(s.sa * result.voxelSize, 4) + ", Sq " + roundedText(s.sq * result.voxelSize, 4) +
                " (world), Ssk " + roundedText(s.ssk, 3) + ", Sku " + roundedText(s.sku, 3));
}

void reliefExtract(Run& run) {
    run.requireInputs(1, 1);
    const Arguments& arguments = run.arguments;
    const std::vector<std::string> paths = run.outputPaths();
    const ModelOptions model = run.modelOptions();
    ReliefExtractOptions options;
    options.base = baseKindOf(arguments.text("base"));
    options.baseRadius = arguments.real("base-radius");
    if (arguments.has("strength")) options.strength = arguments.real("strength");
    options.halfWidth = model.halfWidth;
    validate(options);
    requireReliefPaths(paths, options);
    requireModelPath(arguments.inputs[0]);
    const ReliefExtraction result = extractRelief(run.load(arguments.inputs[0], model), options, run.context);
    writeRelief(result, paths, options, run.metadata(), run.outputs(), run.context);
    report(run, result);
    run.describe(result.surface.grid ? result.surface : result.base);
    run.finish();
}

}  // namespace

const Command kReliefExtract{"relief-extract", "relief-extract SAMPLE -o RELIEF.vdb [options]",
                             "Split a scan into a smooth base and its relief",
                             "vdb_synth relief-extract dragon.off -o relief.vdb --resolution 200",
                             reliefExtract};

}  // namespace vdbsynth::cli
