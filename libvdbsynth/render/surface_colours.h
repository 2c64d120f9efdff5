#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// The grid that holds a model's colours: three floats or doubles named Cd, color, colour or rgb in any case,
/// the first of these names that there is. Null: none.
GridPtr colourGridOf(const std::vector<GridPtr>& attributes);

/// Colours of places, read from a grid: the mean of the active voxels around, weighted trilinearly. A copy
/// reads on its own; copies are used by different threads at once.
class SurfaceColours {
public:
    /// @param grid  three floats or doubles, from 0 to 1 as pictures hold them (sRGB); larger values are
    /// drawn as 1 @throw Error BadData (anything else), InvalidOption (null)
    explicit SurfaceColours(const GridConstPtr& grid);
    ~SurfaceColours();
    SurfaceColours(const SurfaceColours& other);
    SurfaceColours& operator=(const SurfaceColours&) = delete;

    /// False where no voxel around is active. @param place  [world] @param colour  set to values of the grid
    bool at(const Vec3d& place, Vec3f& colour);

private:
    struct Reader;
    template <typename GridType>
    struct ReaderOf;
    std::unique_ptr<Reader> mReader;
};

}  // namespace vdbsynth
