#pragma once
#include "libvdbsynth/base/run_context.h"
#include "tools/vdb_synth/batch/job_plan.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

enum class JobState {
    Waiting,
    Running,
    Done,
    Current,  ///< done by an earlier run, nothing changed since
    Failed,
    Blocked,  ///< a job before it failed
    Stopped   ///< not run, or not to its end: the batch was stopped
};

/// A word for people: "waiting", "up to date".
std::string wordFor(JobState state);

/// What is known of a job at some time.
struct JobStatus {
    JobState state = JobState::Waiting;
    double seconds = 0;
    std::uint64_t peakBytes = 0;
    std::string error;                  ///< one line: why it failed or did not run
    std::vector<std::string> pictures;  ///< PNG files
};

struct RunOptions {
    int jobs = 1;              ///< at once
    int threads = 1;           ///< of all jobs together
    std::uint64_t memory = 0;  ///< of all jobs together [bytes]
    bool failFast = false;     ///< start no job after one failed
    bool pictures = false;     ///< render a picture of each result
    std::string logs;          ///< folder for logs, reports, pictures and the manifest; it exists
    int keptOpen = -1;         ///< see BatchLock
    /// Called when a job's state changes, and every 2 seconds.
    std::function<void(const std::vector<JobStatus>&)> onChange;
};

/// Runs the jobs of a plan, each as a process of this program, at most `jobs` at once, each with an equal
/// share of threads and memory; one whose earlier run took more memory waits until that much is free, and one
/// that needed more than its share runs once more with all memory. LOGS holds NAME.log (all that the job
/// printed) and NAME.report.json. A job that is current (isCurrent) is not run. When ctx is cancelled, jobs
/// get the signal that this process got, and those that have not ended after 10 seconds are killed.
/// @return a status a job; no failure of a job is thrown
/// @throw Error Io (the manifest cannot be written)
std::vector<JobStatus> runJobs(const Plan& plan, const RunOptions& options, const RunContext& ctx);

/// The last line of a log that says "error:", from there; else its last line.
std::string errorIn(const std::string& log);

}  // namespace vdbsynth::cli::batch
