#include "tools/vdb_synth/texture_region_option.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/texture/texture_regions.h"
#include "tools/vdb_synth/option_value.h"

#include <algorithm>

namespace vdbsynth::cli {
namespace {

// A .vdb without the name of a grid is a model.
bool isGridOf(const std::string& region) {
    return namesGrid(region) && !splitGridPath(region).grid.empty();
}

std::vector<std::int32_t> labelsWhere(Run& run, const TextureShape& shape, std::size_t samples) {
    const std::string region = run.arguments.text("region");
    if (region == "auto") return labelsByShape(shape, samples, run.context);
    if (isGridOf(region)) return labelsIn(shape, *run.loadGrid("region"), samples);
    ModelOptions model;
    if (shape.model.grid) model.voxelSize = voxelSizeOf(*shape.model.grid);
    return labelsInside(shape, run.load(region, model));
}

// Regions by shape say themselves where images are left over.
void warnOfUnused(const Run& run, const std::vector<std::int32_t>& labels, std::size_t samples) {
    for (std::size_t s = 0; s < samples; ++s)
        if (std::find(labels.begin(), labels.end(), std::int32_t(s)) == labels.end())
            message(run.context, MessageLevel::Warning,
                    run.arguments.inputs[1 + s] + ": is not used: no part of the target is in its region");
}

}  // namespace

void checkRegions(const Arguments& arguments, const std::vector<SampleFiles>& files) {
    const bool region = arguments.has("region"), attribute = arguments.has("region-attribute");
    if (region && attribute)
        throw Error(ErrorCode::InvalidOption, "--region and --region-attribute: give one of them");
    if (files.size() > 1 && !region && !attribute)
        throw Error(ErrorCode::InvalidOption,
                    arguments.inputs[2] +
                        ": several images need --region auto, --region MODEL or --region-attribute NAME, "
                        "which say where each goes");
    if (arguments.real("region-blend") > 0 && files.size() == 1)
        throw Error(ErrorCode::InvalidOption, "--region-blend: has no effect on one image");
    if (!region) return;
    const std::string where = arguments.text("region");
    if (files.size() < 2)
        throw Error(ErrorCode::InvalidOption, "--region " + where + ": needs several images");
    if (where != "auto" && !isGridOf(where) && files.size() != 2)
        throw Error(ErrorCode::InvalidOption,
                    "--region " + where + ": needs two images, for its outside and its inside");
}

void noteUnblended(const Run& run, const std::vector<SampleFiles>& files,
                   const std::vector<std::string>& paths) {
    if (!(run.arguments.real("region-blend") > 0)) return;
    for (const std::string& path : paths)
        if (extensionOf(path) == "glb" || extensionOf(path) == "gltf")
            message(run.context, MessageLevel::Note,
                    "--region-blend: the pictures in " + path +
                        " meet without it; colours of its vertices cross-fade");
    for (const auto& [name, path] : files.front().maps)
        if (name == "normal")
            message(run.context, MessageLevel::Note,
                    "--region-blend: values of the map normal are mixed without rotating them");
}

std::vector<std::int32_t> regionLabels(Run& run, const TextureShape& shape, std::size_t samples) {
    std::vector<std::int32_t> labels;
    if (run.arguments.has("region-attribute"))
        labels = labelsOf(shape, run.arguments.text("region-attribute"), samples);
    else if (run.arguments.has("region"))
        labels = labelsWhere(run, shape, samples);
    if (!labels.empty() && run.arguments.text("region") != "auto") warnOfUnused(run, labels, samples);
    return labels;
}

}  // namespace vdbsynth::cli
