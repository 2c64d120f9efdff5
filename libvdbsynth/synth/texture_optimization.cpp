#include "libvdbsynth/synth/texture_optimization.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/synth/open_fill.h"
#include "libvdbsynth/synth/patch_search.h"
#include "libvdbsynth/synth/seam_cut.h"
#include "libvdbsynth/synth/synthesis_passes.h"

#include <algorithm>
#include <string>

namespace vdbsynth {
namespace {

using Fields = std::vector<std::shared_ptr<const BrickField>>;
using Pass = SynthesisPass;

constexpr int kRoundsFirst = 12, kRoundsBetween = 6, kRoundsLast = 2;
constexpr int kOverlap = 4;        // patches over a sample along each axis
constexpr int kRoundsOfCuts = 3;   // after the last, for runs that became too long
constexpr int kCoarsestSide = 32;  // [samples] a smaller exemplar is not halved

// The number of passes that leaves the coarsest exemplar enough positions.
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

PatchMap emptyMap(const Pass& pass, int block, const BlockSynthesisOptions& options) {
    PatchMap map;
    map.target = pass.target;
    map.block = block;
    map.stride = std::max(1, block / kOverlap);
    // Patches that repeat each other are a period apart, so the stride divides it.
    const auto divides = [&] {
        for (int axis = 0; axis < 3; ++axis)
            if (options.border[std::size_t(axis)] == Border::Tile &&
                (pass.target[axis] - 2 * (options.around[axis] / pass.scale)) % map.stride)
                return false;
        return true;
    };
    while (!divides()) --map.stride;
    map.allocate();
    return map;
}

// Blocks in raster order over the coarsest pass: an initial arrangement of large features.
PatchMap firstArrangement(const Pass& pass, const BlockSynthesisOptions& options,
                          const std::vector<const BrickField*>& masks, const RunContext& ctx) {
    BlockSynthesisOptions first = options;
    first.size = pass.target;
    first.around = {0, 0, 0};
    first.levels = 1;
    for (Border& border : first.border)
        if (border == Border::Tile) border = Border::Cut;
    first.block = pass.block;
    first.drift = options.drift / pass.scale;
    first.masks = masks;
    first.guide = nullptr;
    BrickField exemplarMap;
    if (options.exemplarMap) {
        exemplarMap = BrickField::fromVoxels(IndexBox::fromSize(pass.target), ctx, [&](const Index3& p) {
            return float(exemplarAt(options, pass, p));
        });
        first.exemplarMap = &exemplarMap;
    }
    return synthesizeBlocks(pass.exemplars, first, ctx).map;
}

// Each pass's part of a mask and of a partly known target, finest first.
struct Given {
    std::vector<PassMasks> masks;
    GuideScales guides;
    std::vector<BrickField> known, open;
    const BrickField* openAt(std::size_t p) const { return open.empty() ? nullptr : &open[p]; }
};

BrickField exchanged(const BrickField& field, const RunContext& ctx) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = 1 - samples[i];
    });
}

Given givenFor(const BlockSynthesisOptions& options, std::size_t passes, const RunContext& ctx) {
    Given given;
    given.masks = masksOf(options, passes, ctx);
    given.guides = guideScales(options, passes, ctx);
    if (!options.open) return given;
    given.known.push_back(*options.known);
    given.open.push_back(*options.open);
    while (given.open.size() < passes) {
        given.known.push_back(halved(given.known.back(), ctx));
        // A coarse sample is open if any of its fine samples is.
        given.open.push_back(exchanged(halvedMask(exchanged(given.open.back(), ctx), ctx), ctx));
    }
    return given;
}

// The known samples, and the vote elsewhere.
BrickField withKnown(const Given& given, std::size_t p, BrickField voted, const RunContext& ctx) {
    if (given.open.empty()) return voted;
    return BrickField::generate(voted.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float open[BrickField::kSamples], known[BrickField::kSamples];
        voted.readBox(brick.min, brick.size(), samples);
        given.open[p].readBox(brick.min, brick.size(), open);
        given.known[p].readBox(brick.min, brick.size(), known);
        for (int i = 0; i < BrickField::kSamples; ++i)
            if (open[i] == 0.f) samples[i] = known[i];
    });
}

// Smaller blocks, and fewer passes, where the planned ones do not fit into a mask.
void fitToMask(const Given& given, bool blockGiven, std::vector<Pass>& passes, const RunContext& ctx) {
    const auto fits = [&](std::size_t p) {
        const std::vector<const BrickField*>& masks = given.masks[p].each;
        return std::all_of(masks.begin(), masks.end(), [&](const BrickField* mask) {
            return !mask || blockFitsInside(*mask, passes[p].block, ctx);
        });
    };
    for (std::size_t p = passes.size(); p-- > 0;) {
        int& block = passes[p].block;
        const bool fixed = p == 0 && blockGiven;
        while (!fixed && block >= 8 && !fits(p)) block /= 2;
        const bool last = p + 1 == passes.size();
        if (!last || fits(p)) continue;
        if (p > 0)
            passes.pop_back();
        else
            throw Error(ErrorCode::Unusable,
                        given.open.empty()
                            ? "`exemplarMask`: no block of " + std::to_string(block) +
                                  " voxels fits inside the mask; use a smaller `block`"
                            : "the exemplar has nothing left to fill the hole from; give an EXEMPLAR");
    }
}

class Optimization {
public:
    Optimization(const std::vector<Pass>& passes, const BlockSynthesisOptions& options, const Given& given,
                 const RunContext& ctx)
        : mPasses(passes), mOptions(options), mContext(ctx), mGiven(given) {}

    BlockSynthesisResult run() {
        arrange();
        for (std::size_t p = mPasses.size(); p-- > 0;) improve(p);
        BlockSynthesisResult result;
        result.map = std::move(mMap);
        result.field =
            withKnown(mGiven, 0, voteThroughMap(result.map, mPasses.front().exemplars, mContext), mContext);
        result.stats = mStats;
        result.stats.block = mPasses.front().block;
        result.stats.levels = int(mPasses.size());
        return result;
    }

private:
    // The coarsest pass's first map.
    void arrange() {
        const std::size_t last = mPasses.size() - 1;
        if (mGiven.open.empty()) {
            // The search for exact blocks does not use guidance.
            mMap = mOptions.guide
                       ? emptyMap(mPasses[last], mPasses[last].block, mOptions)
                       : firstArrangement(mPasses[last], mOptions, mGiven.masks[last].each, mContext);
            return;
        }
        mField = mGiven.known[last];
        if (mOptions.guessed) {
            // The guess stays; the search finds sources at any eligible position.
            mMap = emptyMap(mPasses[last], mPasses[last].block, mOptions);
            return;
        }
        Stage stage(mContext, "filling open voxels", 1);
        mMap = fillOpen(mPasses[last], mGiven.masks[last].each, mGiven.open[last], mField, mContext);
        stage.advance();
    }

    void improve(std::size_t p) {
        const Pass& pass = mPasses[p];
        const bool first = p + 1 == mPasses.size();
        PatchMap map =
            emptyMap(pass, p == 0 || first ? pass.block : std::max(4, pass.block * 3 / 4), mOptions);
        PatchLevel level = patchLevel(pass, mOptions, map, mGiven.masks[p].each, mGiven.openAt(p), mContext);
        if (mOptions.guide)
            level.guidance = Guidance(mGiven.guides.target[p], mGiven.guides.exemplars[p],
                                      mGiven.guides.weight, map.block, mContext);
        const bool guidedStart = first && mOptions.guide;
        if (mOptions.exemplarMap || guidedStart) drawSources(level, map, mContext);
        if (!guidedStart) liftSources(level, mMap, first ? 1 : 2, map, mContext);
        copyRepeats(level, map);
        // Sources lifted from patches without open samples are meaningless, so open samples
        // begin as the coarse result.
        if (!mGiven.open.empty() && !first) mField = doubled(mField, pass.target, mContext);
        const int rounds = first ? kRoundsFirst : p == 0 ? kRoundsLast : kRoundsBetween;
        Stage stage(
            mContext,
            "synthesis pass " + std::to_string(mPasses.size() - p) + " of " + std::to_string(mPasses.size()),
            std::size_t(rounds));
        for (int round = 0; round < rounds; ++round) {
            if (round > 0 || mGiven.open.empty())
                mField = voteThroughMap(map, pass.exemplars, mContext, &level.exemplars);
            mField = withKnown(mGiven, p, std::move(mField), mContext);
            const RoundCounts counts = improveSources(level, mField, int(p) * 64 + round, map, mContext);
            mStats.matches += counts.patches;
            mStats.exact += counts.compared;
            mStats.meanCost = counts.cost;
            stage.advance();
        }
        for (int round = rounds; p == 0 && round < rounds + kRoundsOfCuts; ++round)
            if (shortenRuns(level, mField, int(p) * 64 + round, map, mContext) == 0) break;
        if (!mGiven.open.empty())
            mField = withKnown(mGiven, p, voteThroughMap(map, pass.exemplars, mContext, &level.exemplars),
                               mContext);
        // Seams that meet themselves a period apart, or known samples, are left to the vote.
        const bool tiles = std::count(mOptions.border.begin(), mOptions.border.end(), Border::Tile) > 0;
        if (p == 0 && mGiven.open.empty() && !tiles) map = cutSeams(level, map, mField, mContext);
        mMap = std::move(map);
    }

    const std::vector<Pass>& mPasses;
    const BlockSynthesisOptions& mOptions;
    const RunContext& mContext;
    const Given& mGiven;
    PatchMap mMap;
    BrickField mField;
    BlockSynthesisStats mStats;
};

}  // namespace

BlockSynthesisResult optimizeTexture(const Fields& exemplars, const BlockSynthesisOptions& options,
                                     const RunContext& ctx) {
    BlockSynthesisOptions own = options;
    validate(options, exemplars);
    std::vector<Index3> sizes;
    for (const auto& exemplar : exemplars) sizes.push_back(exemplar->box().size());
    if (own.block == 0) {
        own.block = 256;
        for (const Index3& size : sizes) own.block = std::min(own.block, deriveBlock(size, options));
    }
    std::vector<Pass> passes = planPasses(exemplars, own, own.block, levelsFor(exemplars, options), ctx);
    if (passes.size() == 1 && std::count(own.border.begin(), own.border.end(), Border::Tile) > 0)
        message(ctx, MessageLevel::Note,
                "`border` tile: an odd size is synthesized in one pass; a multiple of 4 voxels gives better "
                "results");
    const Given given = givenFor(own, passes.size(), ctx);
    fitToMask(given, options.block > 0, passes, ctx);
    return Optimization(passes, own, given, ctx).run();
}

}  // namespace vdbsynth
