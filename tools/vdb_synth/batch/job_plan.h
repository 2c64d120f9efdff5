#pragma once
#include "tools/vdb_synth/batch/job_file.h"
#include "tools/vdb_synth/option_set.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {
struct Command;
}

namespace vdbsynth::cli::batch {

/// One run of a command, with everything filled in.
struct Job {
    std::string name;   ///< of letters, digits and . _ - + = , @; no two jobs share one
    std::string entry;  ///< the name in the file: "after" may name that and mean all jobs made of it
    const Command* command = nullptr;
    Arguments arguments;  ///< paths relative to the folder of the job file
    std::vector<std::string> reads, writes;
    std::vector<std::size_t> after;  ///< jobs that must be done before, in ascending order
};

/// Every job of a batch, in the order of the file.
struct Plan {
    std::string path;    ///< of the job file
    std::string folder;  ///< of the job file: jobs run in it
    std::vector<Job> jobs;
};

/// Fills in variables, matrices (the last key varies fastest) and frames (a job each), expands patterns of
/// file names (* ? [ ]) of inputs, against files and outputs of other jobs, and of a matrix, against files;
/// finds what depends on what: a job that reads what another writes, or names it under "after". Checks all:
/// values by the description of the command line's options, files that neither exist nor are made by a job,
/// an output that two jobs write, circles, names that occur twice. Opens no file.
/// @throw Error InvalidOption that names the file and the job; of inputs that are missing Error Io
/// @par Cost    O(jobs x paths)   @par Repeats yes, with the same files in place
Plan makePlan(const JobFile& file);

/// The words of a job's command line after the program's name, without what batch adds.
std::vector<std::string> wordsOf(const Job& job);

/// Words as a shell takes them, quoted where it must be.
std::string shellText(const std::vector<std::string>& words);

/// The plan as command lines for a shell, one a job: "NAME: vdb_synth ...  # after A, B".
std::string planText(const Plan& plan);
/// {"folder", "jobs": [{"name", "words", "reads", "writes", "after"}]}
Json planJson(const Plan& plan);

/// A path of the plan as this process can open it.
std::string inFolder(const Plan& plan, const std::string& path);

/// True for a name with * ? or [.
bool isPattern(const std::string& path);

}  // namespace vdbsynth::cli::batch
