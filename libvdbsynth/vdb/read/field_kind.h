#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <cstddef>

namespace vdbsynth {

/// How well the values of a field are distances to its zero level, measured on the active voxels next to it
/// of which all six neighbours are active too.
struct DistanceFit {
    std::size_t measured = 0;
    double worldShare = 0;    ///< of the measured, with a slope of 1 per world unit to within a tenth
    double voxelShare = 0;    ///< the same with a slope of 1 per voxel
    double slope = 1;         ///< median, per world unit
    double uniformShare = 0;  ///< with that slope to within a tenth

    bool inWorldUnits() const { return worldShare >= 0.6; }
    bool inVoxels() const { return !inWorldUnits() && voxelShare >= 0.6; }
};

/// @par Repeats same bits for any number of threads
DistanceFit distanceFitOf(const openvdb::FloatGrid& grid, const RunContext& ctx = {});

/// Arrays that are copied into a grid with the background 0 leave voxels of the value 0 inactive, which lie
/// on the surface. @return a copy with those active, or null where there are none
FloatGridPtr withSurfaceVoxels(const openvdb::FloatGrid& grid);

enum class FieldKind {
    LevelSet,   ///< by its class
    Distances,  ///< of no class, but its values are distances to a surface, at any scale if they are clamped
    Density     ///< anything else: solid above a value
};

/// @par Cost  reads the values of a grid of unknown class once
FieldKind kindOf(const openvdb::FloatGrid& grid, const RunContext& ctx = {});

}  // namespace vdbsynth
