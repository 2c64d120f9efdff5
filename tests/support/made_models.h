#pragma once
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/grid_kinds.h"

// Models of `make`, and what is asked of a synthesis of them.
namespace vdbsynth::test {

inline LevelSet made(const char* kind, int resolution = 40, double feature = 0, double voxel = 1,
                     std::uint64_t seed = 0) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    options.exemplar.feature = feature;
    options.voxelSize = voxel;
    RunContext ctx;
    ctx.seed = seed;
    return makeModel(options, ctx);
}

/// Multiples of the exemplar's size.
inline SynthOptions sized(double x, double y, double z) {
    SynthOptions options;
    options.size = TargetSize::multiples(x, y, z);
    return options;
}

}  // namespace vdbsynth::test
