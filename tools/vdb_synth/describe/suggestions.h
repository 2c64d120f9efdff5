#pragma once
#include "tools/vdb_synth/option.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

struct Command;

/// What a shell may offer at one place of a command line: words, files, or both.
struct Suggestions {
    std::vector<std::string> words;
    std::vector<std::string> extensions;  ///< of files, lower case, without dots
    bool anyFile = false;                 ///< files of all names
    bool folders = false;                 ///< folders only

    bool empty() const { return words.empty() && extensions.empty() && !anyFile && !folders; }
    bool operator==(const Suggestions& other) const {
        return words == other.words && extensions == other.extensions && anyFile == other.anyFile &&
               folders == other.folders;
    }
};

/// For the value of an option; empty where anything may stand, such as numbers.
Suggestions valuesOf(const Option& option);

/// For the inputs of a command, by position. Further inputs are as the last.
std::vector<Suggestions> inputsOf(const Command& command);

/// Extensions of models that can be read, without .gz.
const std::vector<std::string>& modelExtensions();

}  // namespace vdbsynth::cli
