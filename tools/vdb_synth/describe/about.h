#pragma once
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// What is no command but tells of all: help, completion, --help, --version.
bool isAboutProgram(const std::string& name);

/// The answer, for standard output: `help [--man] [COMMAND]`, `completion bash|zsh|fish`, `--version`.
/// @throw Error InvalidOption (an unknown command, shell or option)
std::string aboutProgram(const std::string& name, const std::vector<std::string>& words);

/// The list of commands that `vdb_synth --help` prints.
std::string overview();

}  // namespace vdbsynth::cli
