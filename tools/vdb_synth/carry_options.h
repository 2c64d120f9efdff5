#pragma once
#include "libvdbsynth/pipeline/synth/synth.h"
#include "tools/vdb_synth/option_set.h"

#include <vector>

namespace vdbsynth::cli {

/// Drops the attributes that --carry does not name. @throw Error InvalidOption (a name that no exemplar has)
void keepNamedAttributes(const Arguments& arguments, std::vector<LevelSet>& exemplars);

/// From --carry-blend.
AttributeValues attributeValues(const Arguments& arguments);

}  // namespace vdbsynth::cli
