#pragma once
#include "libvdbsynth/base/run_context.h"
#include "tools/vdb_synth/batch/job_plan.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

class Manifest;

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

/// How jobs are handed to Slurm.
struct SlurmOptions {
    std::string partition, time;         ///< of sbatch; empty: the cluster's own
    std::vector<std::string> arguments;  ///< more arguments of sbatch
    int atOnce = 0;                      ///< tasks of one array that run at once, 0: any number
    int threads = 1;                     ///< cores of a job
    std::uint64_t memory = 0;  ///< of a job of which nothing is known, and the most [bytes]; 0: not said
    bool cancel = false;       ///< a signal cancels the jobs instead of leaving them in the queue
};

struct RunOptions {
    int jobs = 1;                       ///< at once, on this machine
    int threads = 1;                    ///< of all jobs of this machine together
    std::uint64_t memory = 0;           ///< of all jobs of this machine together [bytes]
    std::optional<SlurmOptions> slurm;  ///< none: jobs run on this machine
    bool failFast = false;              ///< start no job after one failed
    bool pictures = false;              ///< render a picture of each result
    std::string logs;                   ///< folder for logs, reports and pictures; it exists
    int keptOpen = -1;                  ///< see BatchLock
    /// Called when a job's state changes, and every 2 seconds.
    std::function<void(const std::vector<JobStatus>&)> onChange;
};

/// Runs the jobs of a plan, each as a process of this program, here (LocalExecutor) or as tasks of Slurm's
/// (SlurmExecutor). One that needed more than its share of memory runs once more with all. LOGS holds
/// NAME.log (all that the job printed) and NAME.report.json. A job that is current (isCurrent) is not run,
/// and what is done is put into the manifest. When ctx is cancelled, jobs here get the signal that this
/// process got, and those that have not ended after 10 seconds are killed; Slurm's stay in its queue or are
/// cancelled.
/// @return a status a job; no failure of a job is thrown
/// @throw Error Io (the manifest cannot be written), Unusable (Slurm refuses the jobs)
std::vector<JobStatus> runJobs(const Plan& plan, const RunOptions& options, Manifest& manifest,
                               const RunContext& ctx);

/// The last line of a log that says "error:", from there; else its last line.
std::string errorIn(const std::string& log);

}  // namespace vdbsynth::cli::batch
