#pragma once
#include "libvdbsynth/base/run_context.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli::batch {

/// How a command ended.
struct CommandOutput {
    int code = 0;  ///< exit code; 128 + signal; 127: no such command; -1: it did not answer in time
    std::string text, errors;
};

/// Runs a command to its end, in a process group of its own, so that a terminal's ctrl-C does not reach it.
/// @param input    its standard input, at most 64 KB
/// @param seconds  after which it is killed
CommandOutput runCommand(const std::vector<std::string>& words, const std::string& input, double seconds);

/// What Slurm says of a task, by the array's id and the task's index.
struct SlurmTask {
    std::string state;   ///< PENDING, RUNNING, COMPLETED, ...
    std::string reason;  ///< why it waits or ended: Dependency, Resources, ...
    bool started = false;
    double seconds = 0;
};
using SlurmTasks = std::map<std::pair<std::string, int>, SlurmTask>;

/// True of states after which a task does not run any more, unless it is put back into the queue.
bool isEndState(const std::string& state);
/// True of states in which a task has a node.
bool isRunState(const std::string& state);

/// @throw Error Io "sbatch: ..." if one of the commands that are needed is not there
void requireSlurm();

/// Tasks in the queue, and those that left it in the last minutes (`squeue`). @param answered  false: nothing
/// is known now; `problem` says why
SlurmTasks queuedTasks(const std::vector<std::string>& ids, bool& answered, std::string& problem);
/// Tasks of any age (`sacct`); empty where Slurm keeps no accounts.
SlurmTasks accountedTasks(const std::vector<std::string>& ids);
/// The id of the array of this name, empty if Slurm knows none. @param answered  as above
std::string arrayNamed(const std::string& name, bool& answered);

/// `sbatch` with these arguments and a script. @return the job's id
/// @throw Error Unusable with what sbatch says
std::string submitted(const std::vector<std::string>& arguments, const std::string& script);
/// `scancel` of arrays ("12") and tasks ("12_3").
void cancelTasks(const std::vector<std::string>& tasks);
/// The largest index of a task that the cluster allows.
int largestIndex();

/// Words of a text at spaces, except between quotes (' or "), which are removed.
/// @throw Error InvalidOption (a quote without its second; an argument of sbatch that batch sets itself)
std::vector<std::string> sbatchArguments(const std::string& text);

/// Rows "id|index|state|seconds as D-HH:MM:SS|nodes|reason" of squeue; other rows are passed over.
SlurmTasks readTasks(const std::string& rows);
/// Rows "id_index|state|seconds as D-HH:MM:SS|nodes" of sacct.
SlurmTasks readAccounts(const std::string& rows);

}  // namespace vdbsynth::cli::batch
