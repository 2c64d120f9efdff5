#pragma once
#include <string>

namespace vdbsynth::cli {

struct Command;

/// Text as roff prints it: backslashes, quotes, dashes and leading dots lose their meaning.
std::string roffText(const std::string& text);

/// The manual page vdb_synth-COMMAND.1 (man macros), from the option descriptions.
std::string manualPage(const Command& command);

/// The manual page vdb_synth.1: what all commands share, and their list.
std::string programManual();

}  // namespace vdbsynth::cli
