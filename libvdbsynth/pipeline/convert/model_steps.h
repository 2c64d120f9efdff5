#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/convert/model.h"

#include <string>

namespace vdbsynth {

/// A note for each option that is for another kind of file than this one: with several inputs it may be for
/// another of them.
void noteUnusedOptions(const std::string& path, const ModelOptions& options, const RunContext& ctx);

}  // namespace vdbsynth
