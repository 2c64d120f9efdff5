// Makes a small exemplar and more of it, through the installed headers.
#include <cstdio>

#include <openvdb/openvdb.h>

#include "libvdbsynth/pipeline/make.h"
#include "libvdbsynth/pipeline/synth.h"

int main() {
    openvdb::initialize();
    vdbsynth::MakeOptions make;
    make.exemplar.kind = "grid";
    make.exemplar.resolution = 32;
    const vdbsynth::LevelSet exemplar = vdbsynth::makeModel(make);
    vdbsynth::SynthOptions synth;
    synth.size = vdbsynth::TargetSize::multiples(2, 1, 1);
    const vdbsynth::SynthResult result = vdbsynth::synthesize(exemplar, synth);
    std::printf("%zu active voxels\n", std::size_t(result.model.grid->activeVoxelCount()));
    return result.model.grid->activeVoxelCount() > exemplar.grid->activeVoxelCount() ? 0 : 1;
}
