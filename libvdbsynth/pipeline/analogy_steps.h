#pragma once
#include "libvdbsynth/pipeline/analogy.h"

#include <memory>

// Steps of analogy; for its .cpp files only.
namespace vdbsynth {

/// Where a field's voxels lie: voxel p of the field is at index corner + p * step of a grid.
struct FieldPlace {
    const openvdb::FloatGrid* like = nullptr;
    Vec3d corner;
    double step = 1;

    Vec3d toWorld(const Vec3d& voxel) const;
    /// Of a direction, in voxels.
    Vec3d fromWorldDirection(const Vec3d& direction) const;
};

/// Frames around a field's surface by a source of directions.
/// @param what  "the target" or the like, for messages
/// @throw Error Unusable (no direction anywhere), EmptyInput, BadData (a grid of another kind)
FrameField framesOf(std::shared_ptr<const BrickField> distance, const FieldPlace& place,
                    const DirectionSource& source, const std::string& what, const RunContext& ctx);

}  // namespace vdbsynth
