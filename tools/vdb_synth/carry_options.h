#pragma once
#include "libvdbsynth/pipeline/synth.h"
#include "tools/vdb_synth/option_set.h"

#include <vector>

namespace vdbsynth::cli {

/// Leaves behind what --carry does not name. @throw Error InvalidOption (a name that no exemplar carries)
void keepCarried(const Arguments& arguments, std::vector<LevelSet>& exemplars);

/// By --carry-blend.
CarriedValues carriedValues(const Arguments& arguments);

}  // namespace vdbsynth::cli
