#pragma once
#include "tools/vdb_synth/batch/executor/executor.h"
#include "tools/vdb_synth/batch/slurm/slurm_arrays.h"
#include "tools/vdb_synth/batch/slurm/slurm_commands.h"
#include "tools/vdb_synth/batch/slurm/slurm_submission.h"

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// Hands jobs to a Slurm cluster as job arrays that depend on each other (arraysOf), asks for their states
/// every few seconds, and reads how each ended from the file that its task wrote (runTask). All that is in
/// the queue stands in LOGS/slurm.json: a batch that finds one follows these jobs instead of handing them
/// over again.
class SlurmExecutor : public Executor {
public:
    /// Follows what an earlier batch handed over.
    /// @throw Error Io, BadData; InvalidOption if a job in the queue differs from the job file's
    explicit SlurmExecutor(const Batch& batch);

    bool waitsForOthers() const override { return true; }
    bool begin(std::size_t job, bool again) override;
    void submit() override;
    void withdraw(const std::vector<std::size_t>& jobs) override;
    std::vector<JobNews> poll() override;
    bool busy() const override { return !mHeld.empty() || !mToSubmit.empty(); }
    std::vector<JobNews> stop(int signal, bool failed) override;
    void close() override;

private:
    using Clock = std::chrono::steady_clock;
    // A job in the queue.
    struct Held {
        ArrayPlace place;
        bool again = false;                        // with all memory
        bool found = false;                        // handed over by an earlier batch, and not yet looked at
        bool withdrawn = false;                    // to be cancelled if it still waits
        std::optional<Clock::time_point> ended{};  // seen to have ended, without a result
    };
    void attach();
    std::size_t findIds();
    void refuseOthers(const std::set<std::pair<std::string, int>>& others);
    ArrayRequest requestFor(std::size_t job, bool again) const;
    long megabytesFor(std::size_t job, bool again) const;
    void hand(const ArrayPlan& plan, const std::map<std::size_t, bool>& again);
    std::string submitArray(const ArrayPlan& plan, const std::string& name);
    std::vector<std::string> argumentsOf(const ArrayPlan& plan, const std::string& name) const;
    const std::string& idOf(int array) const;
    std::vector<std::string> heldIds() const;
    std::string heldText(const std::string& sign) const;
    std::optional<JobNews> endOf(std::size_t job, Held& held, const SlurmTask* task);
    JobNews newsOf(std::size_t job, const SlurmTask& task) const;
    const SlurmTask* accounted(const ArrayPlace& place);
    bool neverSatisfied(std::size_t job, const SlurmTask* task) const;
    std::string whyEnded(const Held& held, const SlurmTask* task) const;
    void say(const SlurmTask& task, std::size_t job);
    void cancelWithdrawn(const SlurmTasks& tasks);
    std::vector<JobNews> cancelAll();
    void removeFiles(bool all) const;

    Batch mBatch;
    std::string mLogs;  // absolute
    Submission mSubmission;
    std::map<int, std::size_t> mSizes;  // tasks by the array's number
    std::map<std::size_t, Held> mHeld;
    std::map<std::size_t, bool> mToSubmit;        // with all memory?
    std::map<std::string, SlurmTasks> mAccounts;  // by the array's id, of one look
    std::set<std::size_t> mFailed;
    std::set<std::string> mSaid;
    int mNext = 1, mLargest = 0;
    Clock::time_point mBegan = Clock::now(), mAsked{}, mRetry{};
};

}  // namespace vdbsynth::cli::batch
