#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <memory>

namespace vdbsynth {

/// Brightness along the lines of a vector field, by line integral convolution [cabral1993]: noise, one number
/// per voxel, averaged along twelve voxels of the field. A copy reads on its own; copies are used by
/// different threads at once.
class Streaks {
public:
    /// @param field  float vectors near the surface @throw Error BadData (anything else), InvalidOption
    /// (null)
    explicit Streaks(const GridConstPtr& field);
    ~Streaks();
    Streaks(const Streaks& other);
    Streaks& operator=(const Streaks&) = delete;

    /// 0..1, or negative where the field has no direction. @param place  [world]
    double at(const Vec3d& place);

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

}  // namespace vdbsynth
