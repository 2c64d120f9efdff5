#pragma once
#include <string>

namespace vdbsynth::cli {

// Scripts that complete vdb_synth's commands, options, the words an option accepts, and files by extension.
// They are made from the option descriptions and hold all they need: completing runs no program.

/// For `source <(vdb_synth completion bash)`, or a file of bash-completion's folder; needs bash 4.
std::string bashCompletion();

/// A file _vdb_synth in a folder of zsh's fpath.
std::string zshCompletion();

/// A file vdb_synth.fish in fish's folder of completions.
std::string fishCompletion();

}  // namespace vdbsynth::cli
