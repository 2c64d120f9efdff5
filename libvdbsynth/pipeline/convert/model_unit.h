#pragma once
#include "libvdbsynth/vdb/level_set.h"

#include <string>

namespace vdbsynth {

inline constexpr const char* kUnitKey = "vdbsynth:unit";  ///< metadata of a grid whose file named the unit

/// The unit of the world that a model's file named: "um", "mm", "m", "in"; empty: none. Only letters and at
/// most 12 of them, whatever a file's metadata holds.
std::string unitOf(const openvdb::GridBase& grid);
std::string unitOf(const LevelSet& model);
/// Records it; empty removes it.
void setUnit(openvdb::GridBase& grid, const std::string& unit);

/// The model with that unit if it has none, else unchanged; it shares its voxels.
LevelSet inUnit(const LevelSet& model, const std::string& unit);

}  // namespace vdbsynth
