#pragma once
#include "tools/vdb_synth/option.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// Every option of every command, described once. An entry applies to the commands it names; where an option
/// differs between commands in more than numbers, each has its own entry.
const std::vector<Option>& allOptions();

/// The options of a command, with its own differences applied, in the order of --help.
const std::vector<Option>& optionsOf(const std::string& command);

/// Null if the command has no such option.
const Option* findOption(const std::string& command, const std::string& name);

/// Explains why a command does not take an option: it was renamed, other commands take it, or it is unknown,
/// with the nearest name of this command.
/// @return "--NAME: ...", without the dashes where `dashes` is empty
std::string unknownOption(const std::string& command, const std::string& name,
                          const std::string& dashes = "--");

/// The nearest of `names` to `word`, empty if none is close.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

/// Translates a message of the library, which names fields in backquotes: `longestRun` becomes --longest-run
/// if the command has that option, else longestRun.
std::string inFlags(const std::string& text, const std::string& command);

/// The parts of the table, by topic.
std::vector<Option> modelOptionTable();
std::vector<Option> methodOptionTable();
std::vector<Option> textureOptionTable();
std::vector<Option> patchOptionTable();
std::vector<Option> reliefOptionTable();
std::vector<Option> reliefExtractOptionTable();
std::vector<Option> renderOptionTable();
std::vector<Option> batchOptionTable();
std::vector<Option> runningOptionTable();

}  // namespace vdbsynth::cli
