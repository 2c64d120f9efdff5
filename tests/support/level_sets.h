#pragma once
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

namespace vdbsynth::test {

// A ball of radius 10 about the origin, in voxels of a half.
inline FloatGridPtr ball() {
    openvdb::initialize();
    const BrickField field = fieldFrom({49, 49, 49}, [](const Index3& p) {
        return float(std::clamp(std::hypot(p.x - 24, p.y - 24, p.z - 24) - 20, -3.0, 3.0));
    });
    const FloatGridPtr grid = scatterBricks(field, {-24, -24, -24}, 0.5f, 3.f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

}  // namespace vdbsynth::test
