#pragma once
#include "tools/vdb_synth/batch/job_file.h"

#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// One job made of an entry: the values of its variables, and its frame.
struct Variant {
    std::string name;
    std::map<std::string, Json> values;
    int frame = -1;  ///< below 0: the entry has no frames
};

/// The combinations of an entry's matrix and frames. Where the entry's name has no ${...} of these, values
/// are added to it: "more-ball-3", frames as ".0012".
/// @param patterns  patterns of the matrix are added here, as they must not match what jobs write
/// @throw Error InvalidOption (a list that is empty, more than 100 000 jobs, a pattern that matches no file)
std::vector<Variant> variantsOf(const JobEntry& entry, const std::map<std::string, Json>& variables,
                                const std::string& folder, std::vector<std::string>& patterns);

/// The files that a pattern matches, in order of their names, relative to the folder.
std::vector<std::string> filesOf(const std::string& pattern, const std::string& folder);

}  // namespace vdbsynth::cli::batch
