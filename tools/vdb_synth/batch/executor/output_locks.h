#pragma once
#include "tools/vdb_synth/batch/job_plan.h"

#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli::batch {

/// Keeps other batches from a job's outputs from before it starts until its record is made: two that write
/// one file would each take the other's for its own. By flock on a file ".NAME.batch.tmp" beside each output,
/// which is removed with the object; a batch that is killed gives the lock back, and leaves the empty file to
/// the next.
class OutputLocks {
public:
    /// @throw Error Io (another batch writes an output; its folder cannot be written)
    OutputLocks(const Plan& plan, const Job& job);
    ~OutputLocks();
    OutputLocks(const OutputLocks&) = delete;
    OutputLocks& operator=(const OutputLocks&) = delete;

private:
    void release();
    std::vector<std::pair<std::string, int>> mFiles;  // path, descriptor
};

}  // namespace vdbsynth::cli::batch
