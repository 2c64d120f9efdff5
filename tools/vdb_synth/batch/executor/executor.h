#pragma once
#include "tools/vdb_synth/batch/job_manifest.h"
#include "tools/vdb_synth/batch/job_run.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// What became of a job that an executor holds.
struct JobNews {
    std::size_t job = 0;
    JobState state = JobState::Waiting;  ///< any but Blocked
    bool returned = false;               ///< Waiting: the executor holds it no more, and it may begin again
    double seconds = 0;
    std::uint64_t peakBytes = 0;
    std::string error;                ///< of Failed and Stopped
    std::optional<JobRecord> record;  ///< of what is done, for the manifest
    bool moreMemory = false;          ///< Failed: its memory did not suffice, and it can have more
};

/// What the executors of a batch share. All of it outlives them.
struct Batch {
    const Plan& plan;
    const RunOptions& options;
    const RunContext& context;
    Manifest& manifest;
    FileHashes& hashes;
};

/// Where the jobs of a batch run. Which job is begun when, what is skipped and what is blocked is decided by
/// runJobs, which calls these functions from one thread.
class Executor {
public:
    virtual ~Executor() = default;

    /// True if a job may begin while those before it have not ended: the executor waits for them itself.
    virtual bool waitsForOthers() const = 0;
    /// Takes a job. @param again  its memory did not suffice: it gets all that there is
    /// @return false if there is no room now
    /// @throw Error if the job cannot begin, which fails it
    virtual bool begin(std::size_t job, bool again) = 0;
    /// All jobs that can begin now were taken. @throw Error that ends the batch
    virtual void submit() {}
    /// Gives up jobs that wait in the executor.
    virtual void withdraw(const std::vector<std::size_t>&) {}
    /// What happened since the last call; returns at once. @throw Error that ends the batch
    virtual std::vector<JobNews> poll() = 0;
    /// True while it holds a job.
    virtual bool busy() const = 0;
    /// The batch ends before its jobs do. @param failed  by an error, not by a person's signal
    virtual std::vector<JobNews> stop(int signal, bool failed) = 0;
    /// The last call: removes what is not needed any more.
    virtual void close() = 0;
};

}  // namespace vdbsynth::cli::batch
