#include "libvdbsynth/pipeline/repeat/repeat.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/pipeline/fill/fill_steps.h"
#include "libvdbsynth/pipeline/synth/synth_steps.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

// Number of a model's voxels per voxel of the map along an axis.
int factorOf(double mapVoxelSize, const LevelSet& model, const std::string& what) {
    const double present = voxelSizeOf(*model.grid), ratio = mapVoxelSize / present;
    const int factor = ratio < 1e3 ? int(std::lround(ratio)) : 0;
    if (factor < 1 || factor > 64 || std::abs(ratio - factor) > 1e-4 * ratio)
        throw Error(ErrorCode::ShapeMismatch,
                    what + "'s voxel size " + roundedText(present, 9) + " is not the map's " +
                        roundedText(mapVoxelSize, 9) +
                        " divided by a whole number from 1 to 64; convert it with `voxelSize` " +
                        exactText(mapVoxelSize));
    return factor;
}

void noteIfOther(const LevelSet& model, const std::string& hash, const std::string& what,
                 const RunContext& ctx) {
    if (levelSetHash(*model.grid) != hash)
        message(ctx, MessageLevel::Note,
                what + " is not the one that the map was made with; the result uses its geometry");
}

std::string nameOf(const SourceMap& map, std::size_t e) {
    const std::string what = map.method == MapMethod::Analogy ? "textured model" : "exemplar";
    return map.exemplars.size() > 1 ? what + " " + std::to_string(e + 1) : "the " + what;
}

LevelSet repeatSynthesis(const SourceMap& map, int factor, const LevelSets& exemplars,
                         const RepeatOptions& options, const RunContext& ctx) {
    SourceMap scaled = finerMap(map, factor);
    if (options.origin)
        scaled.moved = movedTo(*options.origin, scaled.targetDomain, *exemplars.front()->grid);
    requireMemoryFor(ctx, scaled, exemplars);
    const ExemplarFields fields = gatherForVote(scaled, exemplars, ctx);
    float value = 0;
    for (std::size_t e = 0; e < fields.size(); ++e)
        if (fields[e]->constantIn(fields[e]->box(), value))
            throw Error(ErrorCode::ShapeMismatch,
                        nameOf(map, e) + " has no surface in the map's box " +
                            boxText(scaled.exemplars[e].box) +
                            "; it is not the map's exemplar or is in another place");
    const openvdb::FloatGrid& like = *exemplars.front()->grid;
    LevelSet model = finishSynthesis(
        scaled, voteThroughMap(scaled.patches, variantsOf(fields, scaled.variants, scaled.band, ctx), ctx),
        fields, like, ctx);
    model.attributes = transferAttributes(scaled, exemplars, *model.grid, options.carried, ctx);
    return model;
}

LevelSet repeated(const SourceMap& given, const LevelSets& inputs, const RepeatOptions& options,
                  const RunContext& ctx) {
    SourceMap map = given;
    if (options.halfWidth > 0) map.halfWidth = options.halfWidth;
    const LevelSets exemplars(inputs.begin(), inputs.end() - (map.method == MapMethod::Synthesis ? 0 : 1));
    const LevelSet* target = map.method == MapMethod::Synthesis ? nullptr : inputs.back();
    const std::string targetName = map.method == MapMethod::Fill ? "the kept model" : "the plain model";
    int factor = exemplars.empty() ? factorOf(map.target.voxelSize, *target, targetName) : 0;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        const int own = factorOf(map.voxelSize, *exemplars[e], nameOf(map, e));
        if (e > 0 && own != factor)
            throw Error(ErrorCode::ShapeMismatch, "the exemplars' voxel sizes differ; convert them to one");
        factor = own;
        if (factor == 1) noteIfOther(*exemplars[e], map.exemplars[e].hash, nameOf(map, e), ctx);
    }
    if (target) {
        if (factorOf(map.target.voxelSize, *target, targetName) != factor)
            throw Error(ErrorCode::ShapeMismatch, targetName +
                                                      " must be finer than the map by the same factor as the "
                                                      "textured models; convert it with `voxelSize` " +
                                                      exactText(map.target.voxelSize / factor));
        if (factor == 1) noteIfOther(*target, map.target.hash, targetName, ctx);
    }
    if (map.method == MapMethod::Synthesis) return repeatSynthesis(map, factor, exemplars, options, ctx);
    if (map.method == MapMethod::Analogy) return repeatAnalogy(map, factor, exemplars, *target, ctx);
    if (factor != 1)
        throw Error(
            ErrorCode::ShapeMismatch,
            "a filled hole repeats at the map's resolution only; convert the models with `voxelSize` " +
                exactText(map.target.voxelSize));
    return repeatFill(map, exemplars, *target, ctx);
}

}  // namespace

void validate(const RepeatOptions& options, const SourceMap& given, const LevelSets& inputs) {
    requireOption(options.halfWidth == 0 || (options.halfWidth >= 1.5f && options.halfWidth <= 100),
                  "halfWidth", roundedText(double(options.halfWidth), 6), "from 1.5 to 100 voxels");
    if (options.carried == AttributeValues::Blended && given.method != MapMethod::Synthesis)
        throw Error(ErrorCode::InvalidOption,
                    "`carried`: blending needs several sources per voxel, which only maps of a synthesis "
                    "have; this one is of " +
                        std::string(given.method == MapMethod::Fill ? "a filled hole" : "an analogy"));
    if (options.origin && given.method != MapMethod::Synthesis)
        throw Error(ErrorCode::InvalidOption,
                    "`origin`: only results of a synthesis can be moved; this map's lie on its target");
    requireSound(given);
    if (inputs.size() != given.inputs())
        throw Error(ErrorCode::ShapeMismatch,
                    "the source map was made with " + std::to_string(given.inputs()) +
                        (given.method == MapMethod::Synthesis ? " exemplars"
                         : given.method == MapMethod::Fill
                             ? " models: the kept one last"
                             : " models: the textured one of each pair, then the target") +
                        "; give the same number, in the same order");
    requireOption(!inputs.empty(), "inputs", "0", "as many as the map was made with");
    for (std::size_t i = 0; i < inputs.size(); ++i)
        requireModel(inputs[i], inputs.size() > 1 ? "model " + std::to_string(i + 1) : "the model");
}

LevelSet repeatMap(const SourceMap& given, const LevelSets& inputs, const RepeatOptions& options,
                   const RunContext& ctx) {
    validate(options, given, inputs);
    return withThreads(ctx, [&] { return repeated(given, inputs, options, ctx); });
}

}  // namespace vdbsynth
