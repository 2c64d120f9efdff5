#include "libvdbsynth/pipeline/convert/domain_faces.h"

namespace vdbsynth {

CutFaces facesTouched(const LevelSet& model) {
    CutFaces cut{};
    if (!model.domainRecorded) return cut;
    const IndexBox solid = solidBox(*model.grid, "the model");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cut[2 * axis] = solid.min[int(axis)] <= model.domain.min[int(axis)];
        cut[2 * axis + 1] = solid.max[int(axis)] >= model.domain.max[int(axis)];
    }
    return cut;
}

IndexBox grownBox(const IndexBox& domain, const CutFaces& cut, int by) {
    IndexBox box = domain;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!cut[2 * axis]) box.min[int(axis)] -= by;
        if (!cut[2 * axis + 1]) box.max[int(axis)] += by;
    }
    return box;
}

}  // namespace vdbsynth
