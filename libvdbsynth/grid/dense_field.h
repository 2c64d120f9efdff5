#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/lattice.h"

#include <vector>

namespace vdbsynth {

/// A field with all samples in one array, for inner loops that read it millions of times: four bytes for
/// every voxel of the box, constant regions included. Begins at 0; x slowest, z fastest.
struct DenseField {
    Index3 size{0, 0, 0};
    std::vector<float> samples;

    /// Sample (x, y, z) and, after it, the rest of its row along z.
    const float* row(int x, int y, int z) const { return samples.data() + latticeIndex({x, y, z}, size); }
    float at(const Index3& p) const { return *row(p.x, p.y, p.z); }
};

inline DenseField denseField(const BrickField& field) {
    DenseField dense;
    dense.size = field.box().size();
    dense.samples.resize(std::size_t(field.box().volume()));
    field.readBox(field.box().min, dense.size, dense.samples.data());
    return dense;
}

}  // namespace vdbsynth
