#include "tools/vdb_synth/batch/job_run.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "tools/vdb_synth/batch/executor/local_executor.h"
#include "tools/vdb_synth/batch/job_run_steps.h"
#include "tools/vdb_synth/batch/slurm/slurm_executor.h"
#include "tools/vdb_synth/supervisor.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <tuple>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point time) {
    return std::chrono::duration<double>(Clock::now() - time).count();
}

class Runner {
public:
    Runner(const Plan& plan, const RunOptions& options, Manifest& manifest, const RunContext& ctx)
        : mPlan(plan),
          mOptions(options),
          mContext(ctx),
          mManifest(manifest),
          mStatus(plan.jobs.size()),
          mHeld(plan.jobs.size(), false),
          mRetried(plan.jobs.size(), false),
          mProcesses(plan, options) {
        const Batch batch{plan, options, ctx, manifest, mHashes};
        if (options.slurm)
            mExecutor = std::make_unique<SlurmExecutor>(batch);
        else
            mExecutor = std::make_unique<LocalExecutor>(batch, mProcesses);
    }

    std::vector<JobStatus> run() {
        adoptOrphans();
        changed();
        try {
            while (step()) ::usleep(10000);
        } catch (...) {
            stop(SIGTERM, true);
            save();
            if (!mUnsaved) mExecutor->close();
            throw;
        }
        if (cancelled()) stop(stopSignal() ? stopSignal() : SIGTERM, false);
        for (std::size_t i = 0; i < mStatus.size(); ++i)
            if (mStatus[i].state == JobState::Waiting && !mHeld[i]) {
                mStatus[i].state = JobState::Stopped;
                mStatus[i].error =
                    mFailed ? "not run: another job failed (--fail-fast)" : "not run: interrupted";
            }
        mManifest.save();
        mExecutor->close();
        changed();
        return mStatus;
    }

private:
    bool cancelled() const { return mContext.cancel && *mContext.cancel; }

    // False when all is done.
    bool step() {
        if (cancelled()) return false;
        bool news = false;
        for (const JobNews& one : mExecutor->poll()) news = note(one) || news;
        while (const std::optional<LocalProcess> drawn = mProcesses.endedPicture())
            news = endPicture(*drawn) || news;
        // Of results that were there before, pictures are known only after the first look.
        if (news || !mLooked || (mProcesses.running().empty() && !mPictures.empty())) start();
        mLooked = true;
        if (news || secondsSince(mShown) > 2) changed();
        if (mUnsaved && secondsSince(mSaved) > 0.5) save();
        return mExecutor->busy() || !mProcesses.running().empty() || !mPictures.empty();
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
        while (!mPictures.empty() && mProcesses.fits(mProcesses.share())) startPicture();
        if (mFailed && mOptions.failFast) mExecutor->withdraw(allHeld());
        while (startOnce()) {
        }
        if (!cancelled()) mExecutor->submit();
    }

    // True if what it did may let other jobs start.
    bool startOnce() {
        bool again = false;
        for (std::size_t i = 0; i < mStatus.size(); ++i) {
            if (mStatus[i].state != JobState::Waiting) continue;
            const Before before = beforeOf(mPlan.jobs[i], mStatus);
            if (before.failed >= 0 && !(mFailed && mOptions.failFast)) {
                block(i, std::size_t(before.failed));
                again = true;
            }
            if (mStatus[i].state != JobState::Waiting || mHeld[i] || (mFailed && mOptions.failFast)) continue;
            if (before.open && !mExecutor->waitsForOthers()) continue;
            if (cancelled()) return false;
            if (!before.open && !mRetried[i] && isCurrent(mPlan, mPlan.jobs[i], mManifest, mHashes)) {
                endAs(i, JobState::Current);
                again = true;
            } else if (!begin(i)) {
                return false;
            } else {
                again = again || mStatus[i].state == JobState::Failed;
            }
        }
        return again;
    }

    void block(std::size_t i, std::size_t failed) {
        mStatus[i].state = JobState::Blocked;
        mStatus[i].error = "not run: it needs " + mPlan.jobs[failed].name + ", which was not done";
        if (mHeld[i]) mExecutor->withdraw({i});
    }

    std::vector<std::size_t> allHeld() const {
        std::vector<std::size_t> held;
        for (std::size_t i = 0; i < mHeld.size(); ++i)
            if (mHeld[i] && mStatus[i].state == JobState::Waiting) held.push_back(i);
        return held;
    }

    // False if there is no room.
    bool begin(std::size_t i) {
        try {
            if (!mExecutor->begin(i, mRetried[i])) return false;
            mHeld[i] = true;
        } catch (const Error& error) {
            fail(i, error.what());
        }
        return true;
    }

    void startPicture() {
        LocalProcess process;
        std::string result;
        std::tie(process.job, result, process.picture) = mPictures.front();
        mPictures.erase(mPictures.begin());
        process.reserved = mProcesses.share();
        try {
            mProcesses.launch(process, pictureWords(result, process.picture, mOptions, process.reserved),
                              pictureLog(process.job));
        } catch (const Error&) {
            // A page without a picture says enough.
        }
    }

    std::string pictureLog(std::size_t job) const {
        return mOptions.logs + "/" + mPlan.jobs[job].name + ".picture.log";
    }

    bool endPicture(const LocalProcess& process) {
        if (process.ended.code != 0) return true;
        mStatus[process.job].pictures.push_back(process.picture);
        ::unlink(pictureLog(process.job).c_str());
        return true;
    }

    // False if there is nothing new to show.
    bool note(const JobNews& news) {
        JobStatus& status = mStatus[news.job];
        const std::string& name = mPlan.jobs[news.job].name;
        if (news.state != JobState::Running && news.state != JobState::Waiting) mHeld[news.job] = false;
        if (news.returned) mHeld[news.job] = false;
        if (news.record) {
            mManifest.put(name, *news.record);
            mUnsaved = true;
            for (const std::string& path : mPlan.jobs[news.job].writes) mHashes.forget(inFolder(mPlan, path));
        }
        // What was given up may still end.
        if (status.state != JobState::Waiting && status.state != JobState::Running) return news.returned;
        const bool differs = status.state != news.state || news.returned;
        status.seconds = news.seconds;
        status.peakBytes = news.peakBytes;
        if (!differs) return false;
        if (news.moreMemory && !mRetried[news.job]) {
            mRetried[news.job] = true;
            status.state = JobState::Waiting;
            message(mContext, MessageLevel::Note,
                    name + ": its share of memory did not suffice; it runs again with all");
            return true;
        }
        status.error = news.error;
        if (news.state == JobState::Failed) {
            fail(news.job, news.error);
        } else if (news.state == JobState::Done || news.state == JobState::Current) {
            endAs(news.job, news.state);
        } else {
            status.state = news.state;
            if (news.state == JobState::Running) message(mContext, MessageLevel::Detail, name + ": started");
        }
        return true;
    }

    void fail(std::size_t i, const std::string& reason) {
        mStatus[i].state = JobState::Failed;
        mStatus[i].error = reason;
        mFailed = true;
        message(mContext, MessageLevel::Warning, mPlan.jobs[i].name + ": failed: " + reason);
    }

    void endAs(std::size_t i, JobState state) {
        const std::string& name = mPlan.jobs[i].name;
        JobStatus& status = mStatus[i];
        status.state = state;
        const JobRecord* record = mManifest.find(name);
        if (state == JobState::Current && record) {
            status.seconds = record->seconds;
            status.peakBytes = record->peakBytes;
            message(mContext, MessageLevel::Detail, name + ": up to date");
        }
        if (state == JobState::Done)
            message(mContext, MessageLevel::Note,
                    name + ": done in " + fixedText(status.seconds, 1) + " s with " +
                        fixedText(double(status.peakBytes) / 1e6, 0) + " MB");
        if (!mOptions.pictures) return;
        for (const auto& [result, picture] : picturesOf(mPlan, mPlan.jobs[i], mOptions.logs))
            if (result == picture || (state == JobState::Current && ::access(picture.c_str(), R_OK) == 0))
                status.pictures.push_back(picture);
            else
                mPictures.emplace_back(i, result, picture);
    }

    void stop(int signal, bool failed) {
        for (const JobNews& news : mExecutor->stop(signal, failed)) note(news);
        mProcesses.stop(signal);
        while (const std::optional<LocalProcess> drawn = mProcesses.endedPicture()) endPicture(*drawn);
    }

    const Plan& mPlan;
    const RunOptions& mOptions;
    const RunContext& mContext;
    Manifest& mManifest;
    FileHashes mHashes;
    std::vector<JobStatus> mStatus;
    std::vector<bool> mHeld, mRetried;  // held by the executor; with all memory
    LocalProcesses mProcesses;
    std::unique_ptr<Executor> mExecutor;
    std::vector<std::tuple<std::size_t, std::string, std::string>> mPictures;  // job, result, picture
    bool mFailed = false, mLooked = false, mUnsaved = false, mWarned = false;
    Clock::time_point mShown = Clock::now(), mSaved{};
};

}  // namespace

std::vector<JobStatus> runJobs(const Plan& plan, const RunOptions& options, Manifest& manifest,
                               const RunContext& ctx) {
    return Runner(plan, options, manifest, ctx).run();
}

}  // namespace vdbsynth::cli::batch
