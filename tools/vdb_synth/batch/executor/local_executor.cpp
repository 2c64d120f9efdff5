#include "tools/vdb_synth/batch/executor/local_executor.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/batch/job_run_steps.h"

#include <algorithm>

namespace vdbsynth::cli::batch {

// What its last run took and a quarter, else a share; once more than that if it did not suffice.
std::uint64_t LocalExecutor::memoryFor(std::size_t i, bool again) const {
    const std::uint64_t all = mBatch.options.memory;
    if (again) return all;
    const Job& job = mBatch.plan.jobs[i];
    if (job.arguments.has("max-memory")) return std::min(job.arguments.wide("max-memory"), all);
    const JobRecord* record = mBatch.manifest.find(job.name);
    const std::uint64_t known = record ? record->peakBytes / 4 * 5 : 0;
    return std::min(known > 0 ? known : mProcesses.share(), all);
}

bool LocalExecutor::begin(std::size_t i, bool again) {
    const Job& job = mBatch.plan.jobs[i];
    const RunOptions& options = mBatch.options;
    LocalProcess process;
    process.job = i;
    process.reserved = memoryFor(i, again);
    if (!mProcesses.fits(process.reserved)) return false;
    process.fingerprint = fingerprintOf(mBatch.plan, job, mBatch.hashes);
    makeFolders(mBatch.plan, job, mBatch.context);
    process.locks = std::make_shared<OutputLocks>(mBatch.plan, job);
    // The same job, smaller: what it took before is no limit for what it may need now.
    const std::uint64_t limit = std::min(std::max(process.reserved, mProcesses.share()), options.memory);
    const std::vector<std::string> words = processWords(job, options, again ? options.memory : limit);
    beginLog(mBatch.plan, job, options.logs, words);
    mProcesses.launch(process, words, options.logs + "/" + job.name + ".log");
    return true;
}

std::vector<JobNews> LocalExecutor::poll() {
    std::vector<JobNews> news;
    while (const std::optional<LocalProcess> process = mProcesses.endedJob())
        news.push_back(newsOf(*process, false));
    for (const auto& [id, process] : mProcesses.running()) {
        if (!process.picture.empty()) continue;
        JobNews running;
        running.job = process.job;
        running.state = JobState::Running;
        running.seconds = process.seconds();
        news.push_back(running);
    }
    return news;
}

JobNews LocalExecutor::newsOf(const LocalProcess& process, bool stopped) {
    const Job& job = mBatch.plan.jobs[process.job];
    JobNews news;
    news.job = process.job;
    news.seconds = process.seconds();
    news.peakBytes = std::max(process.ended.peakBytes, peakInReports(job, mBatch.options.logs));
    for (const std::string& path : job.writes) mBatch.hashes.forget(inFolder(mBatch.plan, path));
    // It may have been done before the signal came.
    if (process.ended.code == 0) {
        JobRecord record{process.fingerprint, {}, news.seconds, news.peakBytes};
        try {
            for (const std::string& path : job.writes)
                record.outputs[path] = mBatch.hashes.of(inFolder(mBatch.plan, path));
            news.state = JobState::Done;
            news.record = record;
        } catch (const Error& error) {
            news.state = JobState::Failed;
            news.error = std::string("did not write ") + error.what();
        }
        return news;
    }
    if (process.ended.signal) mKilled.push_back(process.job);
    news.state = stopped ? JobState::Stopped : JobState::Failed;
    if (stopped)
        news.error = "interrupted; nothing was written";
    else
        failed(process, news);
    return news;
}

void LocalExecutor::failed(const LocalProcess& process, JobNews& news) {
    const Job& job = mBatch.plan.jobs[process.job];
    news.error = errorIn(mBatch.options.logs + "/" + job.name + ".log");
    if (process.ended.signal) news.error = "killed by signal " + std::to_string(process.ended.signal);
    removeTemporaries(mBatch.plan, job, mBatch.options.logs);
    news.moreMemory = saysMemory(job, news.error) && mBatch.options.jobs > 1;
    if (news.error.empty()) news.error = "ended with exit code " + std::to_string(process.ended.code);
}

std::vector<JobNews> LocalExecutor::stop(int signal, bool) {
    mProcesses.stop(signal);
    std::vector<JobNews> news;
    while (const std::optional<LocalProcess> process = mProcesses.endedJob())
        news.push_back(newsOf(*process, true));
    return news;
}

void LocalExecutor::close() {
    if (!mKilled.empty()) waitForAll(5);
    for (const std::size_t job : mKilled)
        removeTemporaries(mBatch.plan, mBatch.plan.jobs[job], mBatch.options.logs);
}

}  // namespace vdbsynth::cli::batch
