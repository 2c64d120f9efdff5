#pragma once
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A name for each grid that tells it from the others: its own, or NAME[0], NAME[1], ... in the order of the
/// file where several have it, as OpenVDB's own tools print them.
std::vector<std::string> uniqueNamesOf(const std::vector<GridPtr>& grids);

/// The grid of a name, or of one that uniqueNamesOf gives; the first where several have it. Null if none has.
/// @param several  set to how many grids the name could mean
GridPtr gridNamed(const std::vector<GridPtr>& grids, const std::string& name, std::size_t* several = nullptr);

/// "density[0] (float), mask (bool)", for messages.
std::string listOf(const std::vector<GridPtr>& grids);

}  // namespace vdbsynth
