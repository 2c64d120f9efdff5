#include "libvdbsynth/pipeline/synth.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/pipeline/carry.h"
#include "libvdbsynth/pipeline/control.h"
#include "libvdbsynth/pipeline/synth_steps.h"
#include "libvdbsynth/synth/texture_optimization.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/mask.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

// Everything that a synthesis reads, kept as long as it runs.
struct Held {
    ExemplarFields exemplars, variants;  // fields of distances
    std::vector<BrickField> masks, guides;
    BrickField which, guide;
};

ControlFrame frameOf(const SynthPlan& plan, const openvdb::FloatGrid& like) {
    ControlFrame frame;
    frame.box = plan.map.targetBox;
    frame.period = plan.map.targetDomain;
    for (std::size_t axis = 0; axis < 3; ++axis) frame.tiles[axis] = plan.block.border[axis] == Border::Tile;
    frame.like = &like;
    return frame;
}

// The variants that rotation and scale maps ask for, and which of them, or of the exemplars, goes where.
void choose(const SynthOptions& options, const openvdb::FloatGrid& like, SynthPlan& plan, Held& held,
            const RunContext& ctx) {
    if (!options.exemplarMap && !options.rotationMap && !options.scaleMap) return;
    const int exemplars = int(plan.map.exemplars.size());
    const std::vector<WantedVariant> wanted =
        wantedVariants(options.exemplarMap.get(), options.rotationMap.get(), options.scaleMap.get(),
                       exemplars, frameOf(plan, like), ctx);
    std::vector<std::int32_t> numbers;
    if (options.rotationMap || options.scaleMap) {
        ChosenVariants chosen = chooseVariants(wanted, ctx);
        for (ExemplarVariant& variant : chosen.variants)
            variant.size = variantSize(plan.map.exemplars[std::size_t(variant.exemplar)].box.size(),
                                       variant.rotation, variant.scale, *plan.block.grows);
        plan.map.variants = chosen.variants;
        numbers = chosen.number;
        message(ctx, MessageLevel::Detail,
                std::to_string(chosen.variants.size()) + " turned and scaled exemplars, within " +
                    std::to_string(int(chosen.tolerance)) + " degrees of what is asked for");
    } else {
        for (const WantedVariant& want : wanted) numbers.push_back(want.exemplar);
    }
    held.which = fieldOfNumbers(numbers, plan.map.targetBox, ctx);
    plan.block.which = &held.which;
}

// Faces, across axes that do not grow, that the surface does not cross: what lies beyond is known.
std::array<bool, 6> facesOfOneSide(const BrickField& field, const std::array<bool, 3>& grows) {
    std::array<bool, 6> faces{};
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        if (grows[std::size_t(axis)]) continue;
        IndexBox layer = field.box();
        if (face % 2)
            layer.min[axis] = layer.max[axis];
        else
            layer.max[axis] = layer.min[axis];
        std::vector<float> samples(std::size_t(layer.volume()));
        field.readBox(layer.min, layer.size(), samples.data());
        const auto inside = std::count_if(samples.begin(), samples.end(), [](float v) { return v < 0; });
        faces[std::size_t(face)] = inside == 0 || inside == std::ptrdiff_t(samples.size());
    }
    return faces;
}

void gatherMasks(const SynthOptions& options, const openvdb::FloatGrid& like, SynthPlan& plan, Held& held,
                 const RunContext& ctx) {
    const SourceMap& map = plan.map;
    std::optional<BrickField> first;
    if (options.exemplarMask) {
        first = gatherMask(*options.exemplarMask, map.exemplars.front().box, like, ctx);
        if (map.draft) first = halvedMask(*first, ctx);
    }
    if (map.variants.empty()) {
        if (first) held.masks.push_back(std::move(*first));
    } else {
        for (const ExemplarVariant& variant : map.variants)
            held.masks.push_back(variantMask(
                map.exemplars[std::size_t(variant.exemplar)].box.size(), variant,
                variant.exemplar == 0 && first ? &*first : nullptr,
                facesOfOneSide(*held.exemplars[std::size_t(variant.exemplar)], *plan.block.grows), ctx));
    }
    for (const BrickField& mask : held.masks) plan.block.masks.push_back(&mask);
}

// Along an axis at 1x a scaled or tilted exemplar is not where the target is; unless its surface stays off
// the faces, sources must then be free to move.
void driftWhereTurned(SynthPlan& plan, const Held& held, const RunContext& ctx) {
    if (plan.block.drift > 0) return;
    for (const ExemplarVariant& variant : plan.map.variants) {
        const auto goesOn = facesOfOneSide(*held.exemplars[std::size_t(variant.exemplar)], *plan.block.grows);
        const Affine turn = turnBy(variant.rotation);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if ((*plan.block.grows)[axis] || (goesOn[2 * axis] && goesOn[2 * axis + 1]) ||
                std::abs(turn[axis * 5] * variant.scale - 1) < 1e-9)
                continue;
            plan.block.drift = plan.block.size[int(axis)];
            message(ctx, MessageLevel::Note,
                    std::string("sources drift along ") + "xyz"[axis] +
                        ", where a turned or scaled exemplar is not as long as the result");
            return;
        }
    }
}

void gatherGuides(const SynthOptions& options, const LevelSets& exemplars, SynthPlan& plan, Held& held,
                  const RunContext& ctx) {
    if (!options.guide) return;
    held.guide = sampledScalar(*options.guide, frameOf(plan, *exemplars.front()->grid), "`guide`", ctx);
    std::vector<BrickField> guides;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        ControlFrame frame;
        frame.box = plan.map.exemplars[e].box;
        frame.like = exemplars[e]->grid.get();
        guides.push_back(sampledScalar(*options.exemplarGuides[e], frame, "`exemplarGuides`", ctx));
    }
    for (const ExemplarVariant& variant : plan.map.variants)
        held.guides.push_back(variantOfScalar(guides[std::size_t(variant.exemplar)], variant, ctx));
    if (plan.map.variants.empty()) held.guides = std::move(guides);
    plan.block.guide = &held.guide;
    for (const BrickField& guide : held.guides) plan.block.exemplarGuides.push_back(&guide);
    plan.block.guideWeight = float(options.guideWeight);
}

SynthResult synthesized(const LevelSets& exemplars, const SynthOptions& options, const RunContext& ctx) {
    SynthPlan plan = planSynthesis(exemplars, options);
    const int block = plan.block.block;
    const openvdb::FloatGrid& like = *exemplars.front()->grid;
    if (options.draft) planDraft(plan, ctx);
    Held held;
    choose(options, like, plan, held, ctx);
    requireRoom(ctx, plan.map, exemplars);
    message(ctx, MessageLevel::Detail,
            "domain " + boxText(plan.map.exemplars.front().box) + ", target " +
                boxText(plan.map.targetDomain) + ", block " + std::to_string(block) + ", band widened to " +
                std::to_string(int(plan.map.band)) + " voxels");
    held.exemplars = gatherForSearch(plan.map, exemplars, ctx);
    held.variants = variantsOf(plan.map, held.exemplars, ctx);
    gatherMasks(options, like, plan, held, ctx);
    driftWhereTurned(plan, held, ctx);
    gatherGuides(options, exemplars, plan, held, ctx);
    BlockSynthesisResult synthesis = options.method == SynthesisMethod::Default
                                         ? optimizeTexture(held.variants, plan.block, ctx)
                                         : synthesizeBlocks(held.variants, plan.block, ctx);
    SynthResult result;
    plan.map.patches = std::move(synthesis.map);
    plan.map.matched = synthesis.stats.block * (plan.map.draft ? 2 : 1);
    if (plan.map.draft) {
        plan.map.patches = plan.map.patches.scaled(2, plan.map.targetBox.size());
        held.exemplars = gatherForVote(plan.map, exemplars, ctx);
        synthesis.field = voteThroughMap(plan.map.patches, held.exemplars, ctx);
    }
    result.model = finishSynthesis(plan.map, std::move(synthesis.field), held.exemplars, like, ctx);
    result.model.carried = carryThroughMap(plan.map, exemplars, *result.model.grid, options.carried, ctx);
    result.map = std::move(plan.map);
    result.stats = synthesis.stats;
    result.stats.block = result.map.matched;
    return result;
}

}  // namespace

void validate(const SynthOptions& options, const LevelSets& exemplars) {
    if (exemplars.empty()) throw Error(ErrorCode::InvalidOption, "synthesis needs at least one exemplar");
    requireOption(!options.exemplarMap || exemplars.size() > 1, "exemplarMap", "for one exemplar",
                  "several exemplars, of which it says which goes where");
    requireOption(bool(options.guide) == !options.exemplarGuides.empty(), "guide", "alone",
                  "both `guide` and `exemplarGuides`");
    requireOption(options.longestRun >= 0.01 && options.longestRun <= 1, "longestRun",
                  roundedText(options.longestRun, 6), "from 0.01 to 1");
    requireOption(options.guideWeight >= 0.001 && options.guideWeight <= 1000, "guideWeight",
                  roundedText(options.guideWeight, 6), "from 0.001 to 1000");
    requireOption(options.block == 0 || (options.block >= 4 && options.block <= 256), "block",
                  std::to_string(options.block), "a whole number from 4 to 256");
    requireOption(options.levels >= 0 && options.levels <= 8, "levels", std::to_string(options.levels),
                  "a whole number from 1 to 8");
    requireOption(options.drift >= 0 && options.drift <= 1 << 20, "drift", std::to_string(options.drift),
                  "from 0 to 1048576 voxels");
    requireHalfWidth(double(options.halfWidth));
    requireOption(options.exemplarGuides.empty() || options.exemplarGuides.size() == exemplars.size(),
                  "exemplarGuides", std::to_string(options.exemplarGuides.size()), "one for each exemplar");
    for (const GridConstPtr& guide : options.exemplarGuides)
        requireOption(guide != nullptr, "exemplarGuides", "null", "a grid for each exemplar");
    if (exemplars.size() > 1 && !options.exemplarMap && (options.rotationMap || options.scaleMap))
        throw Error(
            ErrorCode::InvalidOption,
            "`rotationMap`, `scaleMap`: with several exemplars `exemplarMap` must say which one goes where");
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        requireModel(exemplars[e],
                     exemplars.size() > 1 ? "exemplar " + std::to_string(e + 1) : "the exemplar");
    if (options.exemplarBox) requireBox(*options.exemplarBox, "exemplarBox");
    if (!options.exemplarMask) return;
    requireMaskFor(*options.exemplarMask, *exemplars.front()->grid);
    activeBox(*options.exemplarMask);
}

SynthResult synthesize(const LevelSets& exemplars, const SynthOptions& options, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        validate(options, exemplars);
        return synthesized(exemplars, options, ctx);
    });
}

SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options, const RunContext& ctx) {
    return synthesize(LevelSets{&exemplar}, options, ctx);
}

}  // namespace vdbsynth
