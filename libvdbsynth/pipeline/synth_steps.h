#pragma once
#include "libvdbsynth/pipeline/carry.h"
#include "libvdbsynth/pipeline/synth.h"
#include "libvdbsynth/synth/block_synthesis.h"

#include <memory>
#include <vector>

// Steps that synth and repeat share; for the .cpp files of synth only.
namespace vdbsynth {

using ExemplarFields = std::vector<std::shared_ptr<const BrickField>>;
using LevelSets = std::vector<const LevelSet*>;

struct SynthPlan {
    BlockSynthesisOptions block;
    SourceMap map;
};

/// All boxes and options of a run; checks what needs no field. @throw Error as synthesize
SynthPlan planSynthesis(const LevelSets& exemplars, const SynthOptions& options);

/// The plan at half the resolution, if the exemplars are large enough for it.
void planDraft(SynthPlan& plan, const RunContext& ctx);

/// @throw Error Memory
void requireRoom(const RunContext& ctx, const SourceMap& map, const LevelSets& exemplars);

/// The exemplars' fields as blocks are looked for in them (at half the resolution for a draft), or as the
/// result is read from them; without variants.
ExemplarFields gatherForSearch(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx);
ExemplarFields gatherForVote(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx);

/// What `patches.exemplar` counts: the exemplars, or their variants.
ExemplarFields variantsOf(const SourceMap& map, const ExemplarFields& exemplars, const RunContext& ctx);

/// The voted field as a level set. Crumbs go first: parts of the solid, and of the void, that are smaller
/// than the smallest (of those that touch no face: the smallest hundredth) that an exemplar has, and than
/// half a block a side. Votes of blocks that disagree leave them; no exemplar has any.
/// @param exemplars  as the result was read from, without variants
LevelSet finishSynthesis(const SourceMap& map, BrickField voted, const ExemplarFields& exemplars,
                         const openvdb::FloatGrid& like, const RunContext& ctx);

}  // namespace vdbsynth
