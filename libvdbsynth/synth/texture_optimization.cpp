#include "libvdbsynth/synth/texture_optimization.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/synth/patch_search.h"
#include "libvdbsynth/synth/synthesis_passes.h"

#include <algorithm>
#include <string>

namespace vdbsynth {
namespace {

using Fields = std::vector<std::shared_ptr<const BrickField>>;
using Pass = SynthesisPass;

constexpr int kRoundsFirst = 12, kRoundsBetween = 6, kRoundsLast = 4;
constexpr int kOverlap = 4;        // patches over a sample along each axis
constexpr int kCoarsestSide = 32;  // [samples] an exemplar of less is not halved

// As many passes as leave the coarsest exemplar a side to choose from.
int levelsFor(const Fields& exemplars, const BlockSynthesisOptions& options) {
    if (options.levels > 0) return options.levels;
    int shortest = 1 << 20;
    for (const auto& exemplar : exemplars)
        for (int axis = 0; axis < 3; ++axis)
            if (exemplar->box().size()[axis] != options.size[axis])
                shortest = std::min(shortest, exemplar->box().size()[axis]);
    int levels = 1;
    while (levels < 8 && shortest >= kCoarsestSide && shortest < 1 << 20) {
        shortest /= 2;
        ++levels;
    }
    return std::max(levels, 3);
}

PatchMap emptyMap(const Pass& pass, int block) {
    PatchMap map;
    map.target = pass.target;
    map.block = block;
    map.stride = std::max(1, block / kOverlap);
    map.allocate();
    return map;
}

// Blocks in raster order over the coarsest pass: a first arrangement of what is large.
PatchMap firstArrangement(const Pass& pass, const BlockSynthesisOptions& options, const BrickField* mask,
                          const RunContext& ctx) {
    BlockSynthesisOptions first = options;
    first.size = pass.target;
    first.levels = 1;
    first.block = pass.block;
    first.drift = options.drift / pass.scale;
    first.mask = mask;
    return synthesizeBlocks(pass.exemplars, first, ctx).map;
}

}  // namespace

BlockSynthesisResult optimizeTexture(const Fields& exemplars, const BlockSynthesisOptions& options,
                                     const RunContext& ctx) {
    BlockSynthesisOptions own = options;
    std::vector<Index3> sizes;
    for (const auto& exemplar : exemplars) sizes.push_back(exemplar->box().size());
    validateSynthesis(sizes, options);
    if (own.block == 0) {
        own.block = 256;
        for (const Index3& size : sizes) own.block = std::min(own.block, deriveBlock(size, options));
    }
    own.levels = levelsFor(exemplars, options);
    std::vector<Pass> passes = planPasses(exemplars, own, own.block, ctx);
    std::vector<BrickField> masks;
    if (options.mask) masks.push_back(*options.mask);
    while (options.mask && masks.size() < passes.size()) masks.push_back(halvedMask(masks.back(), ctx));
    BlockSynthesisResult result;
    PatchMap coarse;
    for (std::size_t p = passes.size(); p-- > 0;) {
        const Pass& pass = passes[p];
        const BrickField* mask = masks.empty() ? nullptr : &masks[p];
        const bool first = p + 1 == passes.size();
        if (first) coarse = firstArrangement(pass, own, mask, ctx);
        const int side = p == 0 || first ? pass.block : std::max(4, pass.block * 3 / 4);
        PatchMap map = emptyMap(pass, side);
        const PatchLevel level = patchLevel(pass, own, map, mask, ctx);
        liftSources(level, coarse, first ? 1 : 2, map);
        const int rounds = p == 0 ? kRoundsLast : first ? kRoundsFirst : kRoundsBetween;
        Stage stage(
            ctx,
            "synthesis pass " + std::to_string(passes.size() - p) + " of " + std::to_string(passes.size()),
            std::size_t(rounds));
        for (int round = 0; round < rounds; ++round) {
            const BrickField field = voteThroughMap(map, pass.exemplars, ctx, &level.exemplars);
            const RoundCounts counts = improveSources(level, field, int(p) * 64 + round, map, ctx);
            result.stats.matches += counts.patches;
            result.stats.exact += counts.compared;
            result.stats.meanCost = counts.cost;
            stage.advance();
        }
        coarse = std::move(map);
    }
    result.map = std::move(coarse);
    result.field = voteThroughMap(result.map, exemplars, ctx);
    result.stats.block = result.map.block;
    result.stats.levels = int(passes.size());
    return result;
}

}  // namespace vdbsynth
