#pragma once
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/describe/suggestions.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// "a b c".
std::string joined(const std::vector<std::string>& words, const std::string& between = " ");

/// Text as one word of a shell, in single quotes: bash's and zsh's way to write a quote in it.
std::string shellQuoted(const std::string& text);

/// The first sentence part of a help text, for lists beside a command line.
std::string briefly(const std::string& help);

/// What stands beside the commands: help and completion.
struct Extra {
    const char *name, *summary;
};
const std::vector<Extra>& extraCommands();

/// The words after `completion`.
const std::vector<std::string>& shellNames();

}  // namespace vdbsynth::cli
