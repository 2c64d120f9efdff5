#pragma once
#include "libvdbsynth/base/run_context.h"
#include "tools/vdb_synth/batch/job_manifest.h"
#include "tools/vdb_synth/batch/job_run.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// The jobs of an array as they were when it was handed over: what is edited later does not reach them.
struct TaskFile {
    std::string token;
    int number = 0;
    std::string logs;          ///< absolute
    Plan plan;                 ///< the jobs of the array alone, without what comes before them
    std::vector<int> indices;  ///< a job each
};

/// @throw Error Io; InvalidOption (a name is not UTF-8)
void writeTaskFile(const std::string& path, const TaskFile& tasks);
/// @throw Error Io, BadData
TaskFile readTaskFile(const std::string& path);

/// How a task ended.
struct TaskResult {
    std::string task;                   ///< taskName of the one that wrote it
    JobState state = JobState::Failed;  ///< Done, Current, Failed or Stopped
    double seconds = 0;
    std::uint64_t peakBytes = 0;
    std::string error;
    std::optional<JobRecord> record;  ///< of Done and Current
};

/// "TOKEN.3.12": array 3, task 12.
std::string taskName(const std::string& token, int number, int index);

/// @throw Error Io
void writeResult(const std::string& path, const TaskResult& result);
/// None if it is not there, damaged, or of another task. @param task  empty: of any
std::optional<TaskResult> readResult(const std::string& path, const std::string& task);

/// Removes all temporary files of a job's outputs, whatever process of whatever machine wrote them: no
/// process of the job may run any more.
void removeAllTemporaries(const Plan& plan, const Job& job, const std::string& logs);

/// What a task of an array does: runs its job with the cores and memory that Slurm reserved, unless it is
/// current, and writes its result. Repeats the same files after it was killed and put back into the queue.
/// @throw Error Unusable (the job failed), Cancelled (asked to stop), Io, BadData, InvalidOption (no such
/// task)
void runTask(const std::string& path, int index, const RunContext& ctx);

}  // namespace vdbsynth::cli::batch
