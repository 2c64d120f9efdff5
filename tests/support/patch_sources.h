#pragma once
#include "libvdbsynth/pipeline/patch/patch_source.h"
#include "tests/support/patch_shapes.h"

namespace vdbsynth::test {

/// An egg-crate as a texture along a plane, its box away from the origin.
inline PatchSource eggCrateSource(PatchPlane plane = PatchPlane::XY) {
    const EggCrate crate;
    const PointShape shape = eggCratePoints(crate, 48, 12);
    const Vec3d corner{5, -3, 2};
    std::vector<Vec3f> points, normals;
    for (std::size_t p = 0; p < shape.point.size(); ++p) {
        points.push_back(cast<float>(fromPlane(plane, cast<double>(shape.point[p])) + corner));
        normals.push_back(cast<float>(fromPlane(plane, cast<double>(shape.normal[p]))));
    }
    PatchSource source;
    source.exemplar = patchExemplar(
        points, normals, {fromPlane(plane, {0, 0, -4}) + corner, fromPlane(plane, {48, 48, 4}) + corner},
        plane, 1);
    source.recorded = true;
    return source;
}

}  // namespace vdbsynth::test
