#pragma once
#include "tools/vdb_synth/batch/executor/executor.h"
#include "tools/vdb_synth/batch/executor/local_processes.h"

#include <vector>

namespace vdbsynth::cli::batch {

/// Runs jobs as processes of this machine, at most `jobs` at once, each with an equal share of threads and
/// memory; one whose earlier run took more memory waits until that much is free.
class LocalExecutor : public Executor {
public:
    LocalExecutor(const Batch& batch, LocalProcesses& processes) : mBatch(batch), mProcesses(processes) {}

    bool waitsForOthers() const override { return false; }
    bool begin(std::size_t job, bool again) override;
    std::vector<JobNews> poll() override;
    bool busy() const override { return !mProcesses.running().empty(); }
    std::vector<JobNews> stop(int signal, bool failed) override;
    void close() override;

private:
    std::uint64_t memoryFor(std::size_t job, bool again) const;
    JobNews newsOf(const LocalProcess& process, bool stopped);
    void failed(const LocalProcess& process, JobNews& news);
    Batch mBatch;
    LocalProcesses& mProcesses;
    std::vector<std::size_t> mKilled;
};

}  // namespace vdbsynth::cli::batch
