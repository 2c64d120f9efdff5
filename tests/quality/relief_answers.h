#pragma once
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/quality/relief_measures.h"
#include "tests/support/makers.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>

// What the answers of relief share.
namespace vdbsynth::quality {

// With the voxels outside that the zero level lies beside.
inline IndexBox boxOf(const openvdb::FloatGrid& grid) {
    IndexBox box = solidBox(grid, "a result");
    box.min = box.min - Index3{4, 4, 4};
    box.max = box.max + Index3{4, 4, 4};
    return box;
}

using Distance = std::function<double(const Vec3d&)>;

inline Vec3d at(const Index3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

// A field about the middle of a box, clamped to -reach..reach.
inline BrickField fieldOf(const Index3& size, float reach, const Distance& distance) {
    const Vec3d middle{(size.x - 1) / 2.0, (size.y - 1) / 2.0, (size.z - 1) / 2.0};
    return test::fieldFrom(
        size, [&](const Index3& p) { return std::clamp(float(distance(at(p) - middle)), -reach, reach); });
}

inline LevelSet asModel(const BrickField& field) {
    LevelSet model;
    model.grid = levelSetFrom(field, 3, 1, "a shape");
    model.domain = solidBox(*model.grid, "a shape");
    stampLevelSet(model);
    return model;
}

inline void say(const std::string& name, double value) {
    std::printf("%s %.5g\n", name.c_str(), value);
}

inline ReliefOptions along(const char* text) {
    ReliefOptions options;
    options.direction.emplace();
    parseDirection(text, *options.direction);
    return options;
}

/// Answers about a ball of bumps.
void printBallAnswers();

}  // namespace vdbsynth::quality
