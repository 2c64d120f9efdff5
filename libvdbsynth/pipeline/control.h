#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <array>
#include <string>
#include <vector>

namespace vdbsynth {

/// Where the samples of a control lie: an index box of a model; positions along axes that tile are those
/// within `period`.
struct ControlFrame {
    IndexBox box, period;
    std::array<bool, 3> tiles{};
    const openvdb::FloatGrid* like = nullptr;  ///< whose voxels the boxes count
};

/// A scalar grid of any type read at every voxel of a frame, between voxels trilinearly (whole numbers and
/// truths: the nearest); truths are 0 and 1. Positions are those of the world.
/// @param what  the option, for messages   @throw Error BadData (not a grid of scalars)
BrickField sampledScalar(const openvdb::GridBase& grid, const ControlFrame& frame, const std::string& what,
                         const RunContext& ctx = {});

/// A level set's grid as a control, for callers without OpenVDB's headers.
GridConstPtr asControl(const FloatGridConstPtr& grid);

/// What control grids ask for at every fourth voxel of a frame, x slowest. A level set among the numbers of
/// exemplars means the second inside and the first outside.
/// @param which     numbers of exemplars, 0 to exemplars - 1, or null: 0 everywhere
/// @param rotation  rotation vectors, or angles about z [radians], or null
/// @param scale     0.25 to 4, or null; 0 where inactive is 1
/// @throw Error BadData (a grid of another kind), Unusable (a value out of range, with its place)
std::vector<WantedVariant> wantedVariants(const openvdb::GridBase* which, const openvdb::GridBase* rotation,
                                          const openvdb::GridBase* scale, int exemplars,
                                          const ControlFrame& frame, const RunContext& ctx = {});

/// The number of every fourth voxel as a field over the frame's box, beginning at 0.
BrickField fieldOfNumbers(const std::vector<std::int32_t>& numbers, const IndexBox& box,
                          const RunContext& ctx = {});

}  // namespace vdbsynth
