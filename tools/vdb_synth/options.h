#pragma once
#include "tools/vdb_synth/option.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// Every option of every command, described once. An entry stands for the commands it names; commands between
/// which an option differs in more than numbers have entries of their own.
const std::vector<Option>& allOptions();

/// The options of a command, with what differs for it, in the order of --help.
const std::vector<Option>& optionsOf(const std::string& command);

/// Null if the command takes no such option.
const Option* findOption(const std::string& command, const std::string& name);

/// Says why a command does not take an option: its name is another now, other commands take it, or it is
/// unknown, with the nearest name of this command.
/// @return "--NAME: ...", without the dashes where `dashes` is empty
std::string unknownOption(const std::string& command, const std::string& name,
                          const std::string& dashes = "--");

/// The nearest of `names` to `word`, empty if none is near.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

/// A message of the library, which speaks of fields in backquotes, in words of the command line: `longestRun`
/// is --longest-run where the command has that, else longestRun.
std::string inFlags(const std::string& text, const std::string& command);

/// The parts of the table, by what they are about.
std::vector<Option> modelOptionTable();
std::vector<Option> methodOptionTable();
std::vector<Option> runningOptionTable();

}  // namespace vdbsynth::cli
