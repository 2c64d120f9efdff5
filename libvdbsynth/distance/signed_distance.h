#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// A field that is read at an offset: voxel p of the result is voxel p + offset of it.
struct OffsetField {
    const BrickField& field;
    Index3 offset;
};

/// Unsigned distances with the signs of another field, in a field of `size` that begins at 0.
/// @par Repeats same bits for any number of threads
BrickField withSigns(const OffsetField& distance, const OffsetField& sign, const Index3& size,
                     const RunContext& ctx = {});

/// Distances to the mesh of a field's zero level with that field's signs. Where the field is a distance of
/// its own (its gradient within 0.3 of 1) and within 0.2 voxels of the mesh's it stays: a mesh of the zero
/// level lies inside what is round, by a tenth of a voxel where that is three voxels thick, and so do
/// distances to it. Between 0.2 and 0.4 voxels of difference the result passes from one to the other.
/// @param band  [voxels] where the field's own distances end
/// @par Repeats same bits for any number of threads
BrickField keepingDistances(const OffsetField& toMesh, const OffsetField& own, const Index3& size, float band,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
