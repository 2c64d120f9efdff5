#pragma once
#include "tools/vdb_synth/batch/executor/job_process.h"
#include "tools/vdb_synth/batch/executor/output_locks.h"
#include "tools/vdb_synth/batch/job_run.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// A process of this machine: a job, or the picture of a result.
struct LocalProcess {
    std::size_t job = 0;
    std::string picture;                   ///< empty: the job itself
    std::string fingerprint;               ///< of the job
    std::shared_ptr<OutputLocks> locks{};  ///< of the job
    std::uint64_t reserved = 0;
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
    Ended ended;  ///< once it has

    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    }
};

/// Processes of this program on this machine, which share its memory and a number of places.
class LocalProcesses {
public:
    LocalProcesses(const Plan& plan, const RunOptions& options) : mPlan(plan), mOptions(options) {}

    /// The memory of one of `jobs` at once. [bytes]
    std::uint64_t share() const;
    /// True if there is a place, and memory for one that takes so much.
    bool fits(std::uint64_t bytes) const;
    /// @throw Error Io (its log cannot be written, no process can be started)
    void launch(const LocalProcess& process, const std::vector<std::string>& words, const std::string& log);
    /// One that has ended, if there is one: a job, or a picture.
    std::optional<LocalProcess> endedJob() { return next(mEndedJobs); }
    std::optional<LocalProcess> endedPicture() { return next(mEndedPictures); }
    const std::map<pid_t, LocalProcess>& running() const { return mRunning; }
    /// Sends a signal to all, kills those that have not ended after 10 seconds, and waits for the last.
    void stop(int signal);

private:
    std::optional<LocalProcess> next(std::vector<LocalProcess>& ended);
    bool collect();
    const Plan& mPlan;
    const RunOptions& mOptions;
    std::map<pid_t, LocalProcess> mRunning;
    std::vector<LocalProcess> mEndedJobs, mEndedPictures;
};

}  // namespace vdbsynth::cli::batch
