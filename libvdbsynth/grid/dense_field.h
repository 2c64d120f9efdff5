#pragma once
#include "libvdbsynth/grid/brick_field.h"

#include <vector>

namespace vdbsynth {

/// A field with all of its samples in one array, for inner loops that read it a million times: four bytes a
/// voxel of the box, also where nothing happens. Begins at 0; x slowest, z fastest.
struct DenseField {
    Index3 size{0, 0, 0};
    std::vector<float> samples;

    /// Sample (x, y, z) and, after it, the rest of its row along z.
    const float* row(int x, int y, int z) const {
        return samples.data() +
               (std::size_t(x) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.z) + std::size_t(z);
    }
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
