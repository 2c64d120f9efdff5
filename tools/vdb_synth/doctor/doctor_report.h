#pragma once
#include "libvdbsynth/base/run_context.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace vdbsynth::cli {

/// What a bug report needs: the program as it was built, the libraries it runs with, processor, memory,
/// limits, folders, locale and terminal, and `notes` for what of these may cause trouble. It holds no names
/// of users, hosts or folders, and of the environment only the locale, TERM, whether TMPDIR is set, and the
/// program's own variables.
/// @param context  of whose threads and memory it tells
nlohmann::ordered_json doctorReport(const RunContext& context);

/// The same for people, a line a fact.
std::string doctorText(const nlohmann::ordered_json& report);

/// "vdb_synth 0.1.0 (OpenVDB 10.0.1)", then a line for each library: the answer to --version.
std::string versionText();

}  // namespace vdbsynth::cli
