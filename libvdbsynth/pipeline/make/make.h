#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/procedural/exemplar.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

struct MakeOptions {
    ExemplarOptions exemplar;
    double voxelSize = 1;  ///< [world], above 0
};

/// @throw Error InvalidOption (unknown kind, a field out of its range)
void validate(const MakeOptions& options);

/// A procedural exemplar as a level set with a recorded domain, clipped and capped half a voxel outside it.
/// @throw Error InvalidOption, Memory, EmptyInput (nothing in the domain), Cancelled
/// @par Repeats same bits for (options, ctx.seed), any number of threads
LevelSet makeModel(const MakeOptions& options, const RunContext& ctx = {});

/// A procedural pair, plain and textured, for analogies; the texture's direction is in the plain one's
/// metadata (kDirectionKey).
struct ModelPair {
    LevelSet plain, textured;
};

/// @throw Error as makeModel    @par Repeats as makeModel
ModelPair makePair(const MakeOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
