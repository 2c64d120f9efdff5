#pragma once
#include "tools/vdb_synth/option_set.h"

#include <string>

namespace vdbsynth::cli {

/// The folder of --index-cache, empty if none is given. @throw Error Io (no such folder)
std::string indexFolder(const Arguments& arguments);

}  // namespace vdbsynth::cli
