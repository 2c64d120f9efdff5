#pragma once
#include "libvdbsynth/base/run_context.h"

#include <string>

namespace vdbsynth::cli::batch {

/// Keeps a second batch out of a folder of logs, by flock: a batch that is killed gives it back. Jobs hold a
/// second lock, so that a batch waits for the last jobs of one that was killed.
class BatchLock {
public:
    /// @throw Error Io (another batch runs there; its jobs still run after 15 seconds; not writable),
    /// Cancelled
    BatchLock(const std::string& folder, const RunContext& ctx);
    ~BatchLock();
    BatchLock(const BatchLock&) = delete;
    BatchLock& operator=(const BatchLock&) = delete;

    /// The file that every job must keep open.
    int jobsFile() const { return mJobs; }

private:
    int mBatch = -1, mJobs = -1;
};

}  // namespace vdbsynth::cli::batch
