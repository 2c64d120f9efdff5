#pragma once
#include "tools/vdb_synth/batch/job_text.h"

#include <map>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// One entry of "jobs" as written: variables, matrix and frames are still to be filled in.
struct JobEntry {
    std::string name, command;
    std::vector<std::string> inputs, outputs, after;
    Json options = Json::object();  ///< defaults included
    Json matrix = Json::object();
    std::string frames;  ///< empty: none
};

/// A job file, keys checked.
struct JobFile {
    std::string path;                       ///< as given
    std::map<std::string, Json> variables;  ///< strings, or lists of strings
    std::vector<JobEntry> entries;
};

/// Reads the keys of a job file:
/// {"variables": {NAME: value or list},
///  "defaults": {"options": {...}, COMMAND: {...}},
///  "jobs": [{"name", "command", "inputs", "output", "options", "after", "matrix", "frames"}, ...]}.
/// Defaults under "options" apply to the jobs whose command takes the option, those under a command's name to
/// the jobs of that command; a job's own options win, and null takes a default away.
/// @param set  values of variables from the command line, which win
/// @throw Error InvalidOption for every key that is unknown (with the nearest known one), missing or of
/// another kind, unknown commands and options, and what a job may not set (report, config, output among the
/// options, progress, no-supervisor, help, version); it names the file, the job and the key
/// @par Cost    O(values)   @par Repeats yes
JobFile readJobFile(const std::string& path, const Json& json, const std::map<std::string, std::string>& set);

/// "NAME" replaced in ${NAME} by its value; $${ stands for ${. Of a path also ${NAME.stem}, ${NAME.file} and
/// ${NAME.folder}. @throw Error InvalidOption (unknown, with the nearest; a list where one value must stand)
std::string filledIn(const std::string& text, const std::map<std::string, Json>& values);

/// The commands that a job can run.
std::vector<std::string> jobCommands();
/// Why a job cannot set an option: batch itself does; empty if it can.
std::string whyNoJobOption(const std::string& option);

/// A string, number or true as the text that a command line would have.
std::string textOf(const Json& value);

}  // namespace vdbsynth::cli::batch
