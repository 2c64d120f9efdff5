#pragma once
#include "libvdbsynth/base/run_context.h"

#include <string>

namespace vdbsynth::cli::batch {

/// Keeps a second batch out of a folder of logs, by flock: a batch that is killed gives it back. Jobs hold a
/// second lock, so that a batch waits for the last jobs of one that was killed.
class BatchLock {
public:
    /// @param jobsHere  false: the jobs run on other machines and hold their lock themselves, see JobsLock
    /// @throw Error Io (another batch runs there; its jobs still run after 15 seconds; not writable),
    /// Cancelled
    BatchLock(const std::string& folder, bool jobsHere, const RunContext& ctx);
    ~BatchLock();
    BatchLock(const BatchLock&) = delete;
    BatchLock& operator=(const BatchLock&) = delete;

    /// The file that every job must keep open.
    int jobsFile() const { return mJobs; }

private:
    int mBatch = -1, mJobs = -1;
};

/// The lock that a job of another machine holds, together with others of its batch.
class JobsLock {
public:
    /// @throw Error Io (jobs of a batch on its own machine still run after 15 seconds; not writable),
    /// Cancelled
    JobsLock(const std::string& folder, const RunContext& ctx);
    ~JobsLock();
    JobsLock(const JobsLock&) = delete;
    JobsLock& operator=(const JobsLock&) = delete;

    /// That the job's processes must keep open.
    int file() const { return mFile; }

private:
    int mFile;
};

}  // namespace vdbsynth::cli::batch
