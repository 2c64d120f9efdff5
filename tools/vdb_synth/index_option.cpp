#include "tools/vdb_synth/index_option.h"

#include "libvdbsynth/base/error.h"

#include <filesystem>

namespace vdbsynth::cli {

std::string indexFolder(const Arguments& arguments) {
    if (!arguments.has("index-cache")) return "";
    const std::string folder = arguments.text("index-cache");
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        throw Error(ErrorCode::Io, "--index-cache " + folder + ": no such folder; create it first");
    return folder;
}

}  // namespace vdbsynth::cli
