#include "tools/vdb_synth/batch/job_run.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/output_set.h"
#include "tools/vdb_synth/batch/job_manifest.h"
#include "tools/vdb_synth/batch/job_process.h"
#include "tools/vdb_synth/batch/job_run_steps.h"
#include "tools/vdb_synth/command.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <tuple>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point time) {
    return std::chrono::duration<double>(Clock::now() - time).count();
}

// A process in flight: a job, or the picture of a result.
struct Task {
    std::size_t job = 0;
    std::string picture;  // empty: the job itself
    std::string fingerprint;
    std::uint64_t reserved = 0;
    Clock::time_point began = Clock::now();
};

class Runner {
public:
    Runner(const Plan& plan, const RunOptions& options, const RunContext& ctx)
        : mPlan(plan),
          mOptions(options),
          mContext(ctx),
          mManifest(options.logs + "/manifest.json", ctx),
          mStatus(plan.jobs.size()),
          mRetried(plan.jobs.size(), false) {}

    std::vector<JobStatus> run() {
        adoptOrphans();
        changed();
        try {
            while (step()) ::usleep(10000);
        } catch (...) {
            stop(SIGTERM);
            throw;
        }
        if (mContext.cancel && *mContext.cancel) stop(stopSignal() ? stopSignal() : SIGTERM);
        if (!mKilled.empty()) waitForAll(5);
        for (const std::size_t job : mKilled) removeTemporaries(mPlan, mPlan.jobs[job], mOptions.logs);
        for (JobStatus& status : mStatus)
            if (status.state == JobState::Waiting) {
                status.state = JobState::Stopped;
                status.error = mFailed ? "not run: another job failed (--fail-fast)" : "not run: interrupted";
            }
        mManifest.save();
        changed();
        return mStatus;
    }

private:
    // False when all is done.
    bool step() {
        if (mContext.cancel && *mContext.cancel) return false;
        bool news = false;
        while (const std::optional<Ended> ended = endedProcess()) news = finish(*ended) || news;
        // Of results that were there before, pictures are known only after the first look.
        if (news || !mLooked || (mTasks.empty() && !mPictures.empty())) start();
        mLooked = true;
        if (news || secondsSince(mShown) > 2) changed();
        if (mUnsaved && secondsSince(mSaved) > 0.5) save();
        return !mTasks.empty() || !mPictures.empty();
    }

    // What cannot be recorded now is tried again, and fails the run at its end.
    void save() {
        try {
            mManifest.save();
            mUnsaved = false;
        } catch (const Error& error) {
            if (!mWarned) message(mContext, MessageLevel::Warning, error.what());
            mWarned = true;
        }
        mSaved = Clock::now();
    }

    void changed() {
        for (const auto& [process, task] : mTasks)
            if (task.picture.empty()) mStatus[task.job].seconds = secondsSince(task.began);
        if (mOptions.onChange) mOptions.onChange(mStatus);
        if (mContext.onProgress) {
            const auto open = std::count_if(mStatus.begin(), mStatus.end(), [](const JobStatus& status) {
                return status.state == JobState::Waiting || status.state == JobState::Running;
            });
            mContext.onProgress({"jobs", mStatus.size() - std::size_t(open), mStatus.size(), false});
        }
        mShown = Clock::now();
    }

    // Starts what can start, in the order of the file. One that waits for memory keeps later ones from taking
    // it.
    void start() {
        while (!mPictures.empty() && fits(share())) startPicture();
        for (bool again = true; again;) {
            again = false;
            for (std::size_t i = 0; i < mStatus.size(); ++i) {
                if (mStatus[i].state != JobState::Waiting || (mFailed && mOptions.failFast)) continue;
                const Before before = beforeOf(mPlan.jobs[i], mStatus);
                if (before.open) continue;
                if (mContext.cancel && *mContext.cancel) return;
                if (before.failed >= 0) {
                    mStatus[i].state = JobState::Blocked;
                    mStatus[i].error = "not run: it needs " + mPlan.jobs[std::size_t(before.failed)].name +
                                       ", which was not done";
                    again = true;
                } else if (!mRetried[i] && isCurrent(mPlan, mPlan.jobs[i], mManifest, mHashes)) {
                    endAs(i, JobState::Current);
                    again = true;
                } else if (!fits(memoryFor(i))) {
                    return;
                } else {
                    startJob(i);
                    again = again || mStatus[i].state == JobState::Failed;
                }
            }
        }
    }

    bool fits(std::uint64_t bytes) const {
        std::uint64_t taken = 0;
        for (const auto& [process, task] : mTasks) taken += task.reserved;
        return int(mTasks.size()) < mOptions.jobs &&
               (mTasks.empty() || taken + bytes <= std::max<std::uint64_t>(mOptions.memory, 1));
    }

    std::uint64_t share() const {
        return std::max<std::uint64_t>(mOptions.memory / std::uint64_t(mOptions.jobs), 1000000);
    }

    // What its last run took and a quarter, else a share; once more than that if it did not suffice.
    std::uint64_t memoryFor(std::size_t i) const {
        if (mRetried[i]) return mOptions.memory;
        const Arguments& arguments = mPlan.jobs[i].arguments;
        if (arguments.has("max-memory")) return std::min(arguments.wide("max-memory"), mOptions.memory);
        const JobRecord* record = mManifest.find(mPlan.jobs[i].name);
        const std::uint64_t known = record ? record->peakBytes / 4 * 5 : 0;
        return std::min(known > 0 ? known : share(), mOptions.memory);
    }

    void startJob(std::size_t i) {
        const Job& job = mPlan.jobs[i];
        Task task;
        task.job = i;
        task.reserved = memoryFor(i);
        try {
            task.fingerprint = fingerprintOf(mPlan, job, mHashes);
            makeFolders(mPlan, job, mContext);
            // The same job, smaller: what it took before is no limit for what it may need now.
            const std::uint64_t limit = std::min(std::max(task.reserved, share()), mOptions.memory);
            const std::vector<std::string> words =
                processWords(job, mOptions, mRetried[i] ? mOptions.memory : limit);
            beginLog(mPlan, job, mOptions.logs, words);
            launch(task, words, mOptions.logs + "/" + job.name + ".log");
            mStatus[i].state = JobState::Running;
            message(mContext, MessageLevel::Detail, job.name + ": started");
        } catch (const Error& error) {
            fail(i, error.what());
        }
    }

    void launch(const Task& task, const std::vector<std::string>& words, const std::string& log) {
        const std::string full = std::filesystem::absolute(log).string();
        const pid_t process = startProcess(words, mPlan.folder, full, mOptions.keptOpen);
        if (process < 0)
            throw Error(ErrorCode::Io, full + ": cannot be written, or no process can be started");
        mTasks[process] = task;
    }

    void startPicture() {
        Task task;
        std::string result;
        std::tie(task.job, result, task.picture) = mPictures.front();
        mPictures.erase(mPictures.begin());
        task.reserved = share();
        try {
            launch(task, pictureWords(result, task.picture, mOptions, share()), pictureLog(task.job));
        } catch (const Error&) {
            // A page without a picture says enough.
        }
    }

    std::string pictureLog(std::size_t job) const {
        return mOptions.logs + "/" + mPlan.jobs[job].name + ".picture.log";
    }

    bool finish(const Ended& ended) {
        const auto found = mTasks.find(ended.process);
        if (found == mTasks.end()) return false;
        const Task task = found->second;
        mTasks.erase(found);
        if (!task.picture.empty()) {
            if (ended.code != 0) return true;
            mStatus[task.job].pictures.push_back(task.picture);
            ::unlink(pictureLog(task.job).c_str());
            return true;
        }
        const Job& job = mPlan.jobs[task.job];
        JobStatus& status = mStatus[task.job];
        status.seconds = secondsSince(task.began);
        status.peakBytes = std::max(ended.peakBytes, peakInReports(job, mOptions.logs));
        for (const std::string& path : job.writes) mHashes.forget(inFolder(mPlan, path));
        if (ended.code == 0)
            succeed(task);
        else
            failed(task, ended);
        return true;
    }

    void succeed(const Task& task) {
        const Job& job = mPlan.jobs[task.job];
        JobStatus& status = mStatus[task.job];
        JobRecord record{task.fingerprint, {}, status.seconds, status.peakBytes};
        try {
            for (const std::string& path : job.writes)
                record.outputs[path] = mHashes.of(inFolder(mPlan, path));
        } catch (const Error& error) {
            return fail(task.job, std::string("did not write ") + error.what());
        }
        mManifest.put(job.name, record);
        mUnsaved = true;
        endAs(task.job, JobState::Done);
        message(mContext, MessageLevel::Note,
                job.name + ": done in " + fixedText(status.seconds, 1) + " s with " +
                    fixedText(double(status.peakBytes) / 1e6, 0) + " MB");
    }

    void failed(const Task& task, const Ended& ended) {
        const Job& job = mPlan.jobs[task.job];
        std::string reason = errorIn(mOptions.logs + "/" + job.name + ".log");
        if (ended.signal) reason = "killed by signal " + std::to_string(ended.signal);
        if (ended.signal) mKilled.push_back(task.job);
        removeTemporaries(mPlan, job, mOptions.logs);
        const bool memory =
            reason.find("--max-memory") != std::string::npos && !job.arguments.has("max-memory");
        if (memory && !mRetried[task.job] && mOptions.jobs > 1) {
            mRetried[task.job] = true;
            mStatus[task.job].state = JobState::Waiting;
            message(mContext, MessageLevel::Note,
                    job.name + ": its share of memory did not suffice; it runs again with all");
            return;
        }
        fail(task.job, reason.empty() ? "ended with exit code " + std::to_string(ended.code) : reason);
    }

    void fail(std::size_t i, const std::string& reason) {
        mStatus[i].state = JobState::Failed;
        mStatus[i].error = reason;
        mFailed = true;
        message(mContext, MessageLevel::Warning, mPlan.jobs[i].name + ": failed: " + reason);
    }

    void endAs(std::size_t i, JobState state) {
        JobStatus& status = mStatus[i];
        status.state = state;
        const JobRecord* record = mManifest.find(mPlan.jobs[i].name);
        if (state == JobState::Current && record) {
            status.seconds = record->seconds;
            status.peakBytes = record->peakBytes;
            message(mContext, MessageLevel::Detail, mPlan.jobs[i].name + ": up to date");
        }
        if (!mOptions.pictures) return;
        for (const auto& [result, picture] : picturesOf(mPlan, mPlan.jobs[i], mOptions.logs))
            if (result == picture || (state == JobState::Current && ::access(picture.c_str(), R_OK) == 0))
                status.pictures.push_back(picture);
            else
                mPictures.emplace_back(i, result, picture);
    }

    void stop(int signal) {
        for (const auto& [process, task] : mTasks) ::kill(process, signal);
        const Clock::time_point began = Clock::now();
        bool killed = false;
        while (!mTasks.empty()) {
            if (const std::optional<Ended> ended = endedProcess()) {
                const auto found = mTasks.find(ended->process);
                if (found == mTasks.end()) continue;
                const std::size_t job = found->second.job;
                const bool picture = !found->second.picture.empty();
                // It may have been done before the signal came.
                if (ended->code == 0 || picture) {
                    finish(*ended);
                    continue;
                }
                mTasks.erase(found);
                mStatus[job].state = JobState::Stopped;
                mStatus[job].error = "interrupted; nothing was written";
                if (ended->signal) mKilled.push_back(job);
                continue;
            }
            if (!killed && secondsSince(began) > 10) {
                killed = true;
                for (const auto& [process, task] : mTasks) ::kill(process, SIGKILL);
            }
            ::usleep(10000);
        }
    }

    const Plan& mPlan;
    const RunOptions& mOptions;
    const RunContext& mContext;
    Manifest mManifest;
    FileHashes mHashes;
    std::vector<JobStatus> mStatus;
    std::vector<bool> mRetried;
    std::map<pid_t, Task> mTasks;
    std::vector<std::tuple<std::size_t, std::string, std::string>> mPictures;  // job, result, picture
    std::vector<std::size_t> mKilled;
    bool mFailed = false, mLooked = false, mUnsaved = false, mWarned = false;
    Clock::time_point mShown = Clock::now(), mSaved{};
};

}  // namespace

std::vector<JobStatus> runJobs(const Plan& plan, const RunOptions& options, const RunContext& ctx) {
    return Runner(plan, options, ctx).run();
}

}  // namespace vdbsynth::cli::batch
