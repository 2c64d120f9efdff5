#pragma once
#include "libvdbsynth/pipeline/render/shown_model.h"
#include "tools/vdb_synth/command.h"

#include <string>

namespace vdbsynth::cli {

/// What `render` was asked for.
struct RenderRequest {
    RenderOptions options;  ///< without `directions`, which are read later
    bool page = false;      ///< writes a page in place of a picture
};

/// Reads and checks the options of `render`, without opening a file. @throw Error InvalidOption
RenderRequest readRenderRequest(const Run& run);

/// Reads an input: a VDB's fog volume as fog unless --iso is given, all else as a level set. What is chosen
/// for the user is said. @throw Error as Run::load
ShownModel loadShown(Run& run, const std::string& path, const RenderRequest& request);

}  // namespace vdbsynth::cli
