#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <array>
#include <string>
#include <vector>

namespace vdbsynth {

/// Where the samples of a control are: an index box of a model; positions along axes that tile
/// are wrapped into `period`.
struct ControlFrame {
    IndexBox box, period;
    std::array<bool, 3> tiles{};
    const openvdb::FloatGrid* like = nullptr;  ///< the grid whose voxels the boxes are in
};

/// A scalar grid of any type, sampled at every voxel of a frame: trilinear between voxels (integers and
/// booleans: nearest); booleans are 0 and 1. Positions are in world space.
/// @param what  the option, for messages   @throw Error BadData (not a scalar grid)
BrickField sampledScalar(const openvdb::GridBase& grid, const ControlFrame& frame, const std::string& what,
                         const RunContext& ctx = {});

/// A mask of any kind as a weight at every voxel of a frame, 0 to `strength`; how analogy and relief read
/// masks. Numbers and truths count as they are, clamped to 0..1. A solid (a level set, or distances of no
/// class), whatever its voxels and band, is 0 outside and rises to 1 over the first three voxels of the frame
/// inside it.
/// @throw Error as sampledScalar; of a solid as modelFromGrids (vdb_file.h) and resampleLevelSet
/// (redistance.h): EmptyInput (thinner than the frame's voxels)
/// @par Cost    O(voxels of the frame), and of a solid's surface   @par Repeats same bits for any threads
BrickField sampledWeight(const openvdb::GridBase& grid, const ControlFrame& frame, float strength,
                         const std::string& what, const RunContext& ctx = {});

/// A level set's grid as a control, for callers without OpenVDB's headers.
GridConstPtr asControl(const FloatGridConstPtr& grid);

/// The positions at which controls of variants are read (variantCells of the frame's box), x slowest. [world]
std::vector<Vec3d> variantPlaces(const ControlFrame& frame);

/// What control grids ask for at every place of a frame (variantPlaces). A level set among the
/// numbers of exemplars means the second inside and the first outside.
/// @param exemplarMap  numbers of exemplars, 0 to exemplars - 1, or null: 0 everywhere
/// @param rotation  rotation vectors, or angles about z [radians], or null
/// @param scale     0.25 to 4, or null; inactive zeros mean 1
/// @throw Error BadData (a grid of another kind; rotations that are velocities by name, class or vector
/// type), Unusable (a value out of range, with its position). Angles over a full turn are a warning.
std::vector<WantedVariant> wantedVariants(const openvdb::GridBase* exemplarMap,
                                          const openvdb::GridBase* rotation, const openvdb::GridBase* scale,
                                          int exemplars, const ControlFrame& frame,
                                          const RunContext& ctx = {});

}  // namespace vdbsynth
