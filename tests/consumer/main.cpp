// More of a program's own grid: the library as a host uses it.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <thread>

#include <openvdb/openvdb.h>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/vdb_file.h"

namespace {

constexpr int kSide = 40;

// A level set of balls ten voxels apart, and a grid of how far from the left each part of them is.
openvdb::GridPtrVec ownGrids() {
    auto balls = openvdb::FloatGrid::create(/* background= */ 3.f);
    balls->setName("balls");
    balls->setGridClass(openvdb::GRID_LEVEL_SET);
    auto warmth = openvdb::FloatGrid::create();
    warmth->setName("warmth");
    for (int x = 0; x < kSide; ++x)
        for (int y = 0; y < kSide; ++y)
            for (int z = 0; z < kSide; ++z) {
                const openvdb::Coord voxel(x, y, z);
                const openvdb::Vec3d fromMiddle(x % 10 - 4.5, y % 10 - 4.5, z % 10 - 4.5);
                const float distance = float(fromMiddle.length()) - 3.5f;
                balls->tree().setValue(voxel, std::clamp(distance, -3.f, 3.f));
                balls->tree().setActiveState(voxel, std::abs(distance) < 3);
                if (distance < 1) warmth->tree().setValue(voxel, float(x) / kSide);
            }
    return {balls, warmth};
}

// Twice as long along x, from this program's own grids, which stay as they are.
bool makesMore(const vdbsynth::LevelSet& exemplar) {
    vdbsynth::SynthOptions options;
    options.size = vdbsynth::TargetSize::multiples(2, 1, 1);
    vdbsynth::RunContext context;
    context.seed = 7;
    context.threads = 2;  // of this call; others keep theirs
    context.onMessage = [](vdbsynth::MessageLevel, const std::string& text) { std::puts(text.c_str()); };
    const vdbsynth::LevelSet more = vdbsynth::synthesize(exemplar, options, context).model;
    std::printf("%zu active voxels, %zu attribute grid\n", vdbsynth::activeVoxels(*more.grid),
                more.attributes.size());
    return more.domain.size() == vdbsynth::Index3{2 * kSide, kSide, kSide} && more.attributes.size() == 1 &&
           more.attributes.front()->activeVoxelCount() > 1000;
}

// Stopped from another thread once the work has begun.
bool stopsWhenTold(const vdbsynth::LevelSet& exemplar) {
    std::atomic<bool> begun{false}, stop{false};
    vdbsynth::RunContext context;
    context.cancel = &stop;
    context.onProgress = [&](const vdbsynth::Progress&) { begun = true; };
    std::thread user([&] {
        while (!begun) std::this_thread::yield();
        stop = true;
    });
    bool stopped = false;
    try {
        vdbsynth::synthesize(exemplar, {}, context);
    } catch (const vdbsynth::Error& error) {
        stopped = error.code() == vdbsynth::ErrorCode::Cancelled;
    }
    user.join();
    return stopped;
}

// What is wrong is an Error with a code and one line that names the field.
bool saysWhatIsWrong(const vdbsynth::LevelSet& exemplar) {
    vdbsynth::SynthOptions options;
    options.longestRun = 3;
    try {
        vdbsynth::synthesize(exemplar, options);
    } catch (const vdbsynth::Error& error) {
        std::puts(error.what());  // `longestRun` 3: must be from 0.01 to 1
        return error.code() == vdbsynth::ErrorCode::InvalidOption;
    }
    return false;
}

}  // namespace

int main() {
    openvdb::initialize();
    const openvdb::GridPtrVec grids = ownGrids();
    vdbsynth::LevelSet exemplar = vdbsynth::modelFromGrids("balls", {grids[0]});
    exemplar.domain = vdbsynth::IndexBox::fromSize({kSide, kSide, kSide});  // a texture that fills its box
    exemplar.domainRecorded = true;
    exemplar.attributes = {grids[1]};
    return makesMore(exemplar) && stopsWhenTold(exemplar) && saysWhatIsWrong(exemplar) ? 0 : 1;
}
