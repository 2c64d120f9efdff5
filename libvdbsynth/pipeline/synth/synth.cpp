#include "libvdbsynth/pipeline/synth/synth.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/pipeline/synth/synth_steps.h"
#include "libvdbsynth/synth/texture_optimization.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/control_grids.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

// Everything that a synthesis reads, as bricks, kept as long as it runs.
struct Held {
    SearchedFields exemplars;
    ExemplarFields variants;
    std::vector<BrickField> masks, guides;
    BrickField exemplarNumbers, guide;
};

// Control grids of the caller, read once.
struct Controls {
    std::vector<WantedVariant> wanted;  // empty: no maps
    std::optional<BrickField> mask;     // of the first exemplar
    BrickField guide;
    std::vector<BrickField> exemplarGuides;
};

Controls readControls(const SynthOptions& options, const LevelSets& exemplars, const SynthPlan& plan,
                      const RunContext& ctx) {
    Controls controls;
    const openvdb::FloatGrid& like = *exemplars.front()->grid;
    // Controls lie where the result does.
    const FloatGridConstPtr there = movedGrid(like, plan.map.moved);
    ControlFrame frame{plan.map.targetBox, plan.map.targetDomain, {}, there.get()};
    for (std::size_t axis = 0; axis < 3; ++axis) frame.tiles[axis] = plan.block.border[axis] == Border::Tile;
    if (options.exemplarMap || rotatesOrScales(options))
        controls.wanted = wantedVariants(options.exemplarMap.get(), options.rotationMap.get(),
                                         options.scaleMap.get(), int(exemplars.size()), frame, ctx);
    if (options.direction)
        rotateAlong(options, exemplars, frame, plan.map.targetDomain, controls.wanted, ctx);
    if (options.exemplarMask)
        controls.mask = gatherMask(*options.exemplarMask, plan.map.exemplars.front().box, like, ctx);
    if (!options.guide) return controls;
    controls.guide = sampledScalar(*options.guide, frame, "`guide`", ctx);
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        controls.exemplarGuides.push_back(sampledScalar(
            *options.exemplarGuides[e], {plan.map.exemplars[e].box, {}, {}, exemplars[e]->grid.get()},
            "`exemplarGuides`", ctx));
    return controls;
}

// The variants that the rotation and scale maps request, and which of them, or of the exemplars, is used
// where.
void choose(const SynthOptions& options, const Controls& controls, SynthPlan& plan, Held& held,
            const RunContext& ctx) {
    if (controls.wanted.empty()) return;
    std::vector<std::int32_t> numbers;
    if (rotatesOrScales(options)) {
        ChosenVariants chosen = chooseVariants(controls.wanted, ctx);
        for (ExemplarVariant& variant : chosen.variants) {
            variant.size = variantSize(plan.map.exemplars[std::size_t(variant.exemplar)].box.size(),
                                       variant.rotation, variant.scale, *plan.block.grows);
            plan.bytes += 16 * double(variant.size.x) * double(variant.size.y) * double(variant.size.z);
        }
        plan.map.variants = chosen.variants;
        numbers = chosen.number;
        message(ctx, MessageLevel::Detail,
                std::to_string(chosen.variants.size()) + " rotated and scaled exemplars, within " +
                    std::to_string(int(chosen.tolerance)) + " degrees of what is wanted");
    } else {
        for (const WantedVariant& want : controls.wanted) numbers.push_back(want.exemplar);
    }
    held.exemplarNumbers = fieldOfNumbers(numbers, plan.map.targetBox, ctx);
    plan.block.exemplarMap = &held.exemplarNumbers;
    requireMemory(ctx, plan.bytes, "a result with so many rotated and scaled exemplars",
                  "use a smaller `size` or larger voxels");
}

// The exemplars as they are searched, with masks and guides, or their variants; lent to the plan.
void gatherFields(const SynthOptions& options, const LevelSets& exemplars, Controls controls, SynthPlan& plan,
                  Held& held, const RunContext& ctx) {
    held.exemplars = gatherExemplars(plan.map, exemplars, ctx);
    if (controls.mask && plan.map.draft) controls.mask = halvedMask(*controls.mask, ctx);
    for (const ExemplarVariant& variant : plan.map.variants) {
        const std::size_t e = std::size_t(variant.exemplar);
        const auto faces = facesOfOneSide(*held.exemplars.searched[e], *plan.block.grows);
        held.masks.push_back(variantMask(plan.map.exemplars[e].box.size(), variant,
                                         e == 0 && controls.mask ? &*controls.mask : nullptr, faces, ctx));
        if (options.guide) held.guides.push_back(variantOfScalar(controls.exemplarGuides[e], variant, ctx));
        const int axis = axisOfDrift(variant, faces, *plan.block.grows);
        if (axis < 0 || plan.block.drift > 0) continue;
        plan.block.drift = plan.block.size[axis];
        message(ctx, MessageLevel::Note,
                std::string("sources drift along ") + "xyz"[axis] +
                    ", where the length of a rotated or scaled exemplar differs from the result's");
    }
    if (plan.map.variants.empty()) {
        if (controls.mask) held.masks.push_back(std::move(*controls.mask));
        held.guides = std::move(controls.exemplarGuides);
    }
    held.variants = variantsOf(held.exemplars.searched, plan.map.variants, plan.map.band, ctx);
    for (const BrickField& mask : held.masks) plan.block.masks.push_back(&mask);
    if (!options.guide) return;
    held.guide = std::move(controls.guide);
    plan.block.guide = &held.guide;
    for (const BrickField& guide : held.guides) plan.block.exemplarGuides.push_back(&guide);
    plan.block.guideWeight = float(options.guideWeight);
}

SynthResult synthesized(const LevelSets& exemplars, SynthOptions options, const RunContext& ctx) {
    if (options.exemplarMask)
        options.exemplarMask = maskOn(options.exemplarMask, *exemplars.front()->grid, "`exemplarMask`", ctx);
    SynthPlan plan = planSynthesis(exemplars, options, ctx);
    Held held;
    Controls controls = readControls(options, exemplars, plan, ctx);
    choose(options, controls, plan, held, ctx);
    gatherFields(options, exemplars, std::move(controls), plan, held, ctx);
    BlockSynthesisResult synthesis = options.method == SynthesisMethod::Default
                                         ? optimizeTexture(held.variants, plan.block, ctx)
                                         : synthesizeBlocks(held.variants, plan.block, ctx);
    SynthResult result;
    plan.map.patches = std::move(synthesis.map);
    plan.map.matched = synthesis.stats.block * (plan.map.draft ? 2 : 1);
    if (plan.map.draft) {
        plan.map.patches = plan.map.patches.scaled(2, plan.map.targetBox.size());
        synthesis.field = voteThroughMap(plan.map.patches, held.exemplars.read, ctx);
    }
    result.model = finishSynthesis(plan.map, std::move(synthesis.field), held.exemplars.read,
                                   *exemplars.front()->grid, ctx);
    result.model.attributes =
        transferAttributes(plan.map, exemplars, *result.model.grid, options.carried, ctx);
    result.map = std::move(plan.map);
    result.stats = synthesis.stats;
    result.stats.block = result.map.matched;
    return result;
}

}  // namespace

namespace {

void requireOrigin(const Vec3d& origin) {
    for (int axis = 0; axis < 3; ++axis)
        requireOption(std::abs(origin[axis]) <= 1e30, "origin", roundedText(origin[axis], 6),
                      "three numbers of at most 1e30 (world)");
}

void validateDirections(const SynthOptions& options) {
    if (options.direction && options.rotationMap)
        throw Error(ErrorCode::InvalidOption,
                    "`direction`, `rotationMap`: give one of them; both say how the exemplar is rotated");
    if (options.direction) requireDirection(*options.direction, "direction");
    if (!options.exemplarDirection) return;
    requireOption(options.direction.has_value(), "exemplarDirection", "alone",
                  "given together with `direction`");
    requireDirection(*options.exemplarDirection, "exemplarDirection");
    requireOption(options.exemplarDirection->kind == DirectionSource::Kind::Axis, "exemplarDirection",
                  "not an axis", "an axis, such as axis:x: one rotation takes it to the direction");
}

}  // namespace

void validate(const SynthOptions& options, const LevelSets& exemplars) {
    if (exemplars.empty()) throw Error(ErrorCode::InvalidOption, "synthesis needs at least one exemplar");
    requireOption(!options.exemplarMap || exemplars.size() > 1, "exemplarMap", "for one exemplar",
                  "used with several exemplars");
    requireOption(bool(options.guide) == !options.exemplarGuides.empty(), "guide", "alone",
                  "given together with `exemplarGuides`");
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
    if (exemplars.size() > 1 && !options.exemplarMap && rotatesOrScales(options))
        throw Error(ErrorCode::InvalidOption,
                    "`rotationMap`, `scaleMap`, `direction`: several exemplars also need an `exemplarMap`");
    validateDirections(options);
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        requireModel(exemplars[e],
                     exemplars.size() > 1 ? "exemplar " + std::to_string(e + 1) : "the exemplar");
    if (options.exemplarBox) requireBox(*options.exemplarBox, "exemplarBox");
    if (options.origin) requireOrigin(*options.origin);
    if (options.exemplarMask) activeBox(*options.exemplarMask);
}

SynthResult synthesize(const LevelSets& exemplars, const SynthOptions& options, const RunContext& ctx) {
    validate(options, exemplars);
    return withThreads(ctx, [&] { return synthesized(exemplars, options, ctx); });
}

SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options, const RunContext& ctx) {
    return synthesize(LevelSets{&exemplar}, options, ctx);
}

}  // namespace vdbsynth
