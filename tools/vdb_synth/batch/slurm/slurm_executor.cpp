#include "tools/vdb_synth/batch/slurm/slurm_executor.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <filesystem>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

SlurmExecutor::SlurmExecutor(const Batch& batch) : mBatch(batch), mLogs(fullPath(batch.options.logs)) {
    attach();
}

bool SlurmExecutor::begin(std::size_t job, bool again) {
    mToSubmit[job] = again;
    return true;
}

const std::string& SlurmExecutor::idOf(int array) const {
    static const std::string none;
    for (const SubmittedArray& one : mSubmission.arrays)
        if (one.number == array) return one.id;
    return none;
}

std::vector<std::string> SlurmExecutor::heldIds() const {
    std::set<int> numbers;
    for (const auto& [job, held] : mHeld) numbers.insert(held.place.array);
    std::vector<std::string> ids;
    for (const int number : numbers) ids.push_back(idOf(number));
    return ids;
}

std::string SlurmExecutor::heldText(const std::string& sign) const {
    std::string text;
    for (const std::string& id : heldIds()) text += (text.empty() ? "" : sign) + id;
    return text;
}

void SlurmExecutor::withdraw(const std::vector<std::size_t>& jobs) {
    for (const std::size_t job : jobs) {
        mToSubmit.erase(job);
        const auto held = mHeld.find(job);
        if (held != mHeld.end()) held->second.withdrawn = true;
    }
}

std::vector<JobNews> SlurmExecutor::poll() {
    submit();
    // Every second at first, every ten after five minutes: the controller serves a whole site.
    const Clock::time_point now = Clock::now();
    const double pause = std::clamp(secondsBetween(mBegan, now) / 30, 1.0, 10.0);
    if (mHeld.empty() || secondsBetween(mAsked, now) < pause) return {};
    bool answered = false;
    std::string problem;
    SlurmTasks tasks = queuedTasks(heldIds(), answered, problem);
    mAsked = Clock::now();
    if (!answered) {
        if (mSaid.insert("squeue").second)
            message(mBatch.context, MessageLevel::Warning, problem + "; it is asked again");
        return {};
    }
    mSaid.erase("squeue");
    cancelWithdrawn(tasks);
    mAccounts.clear();
    std::vector<JobNews> news;
    std::vector<std::size_t> gone;
    for (auto& [job, held] : mHeld) {
        const auto found = tasks.find({idOf(held.place.array), held.place.index});
        const SlurmTask* task = found == tasks.end() ? nullptr : &found->second;
        std::optional<JobNews> one;
        if (task && !isEndState(task->state)) {
            held.ended.reset();
            held.found = false;
            one = newsOf(job, *task);
            say(*task, job);
        } else if ((one = endOf(job, held, task))) {
            gone.push_back(job);
        }
        if (one) news.push_back(*one);
    }
    for (const std::size_t job : gone) mHeld.erase(job);
    return news;
}

JobNews SlurmExecutor::newsOf(std::size_t job, const SlurmTask& task) const {
    JobNews news;
    news.job = job;
    news.state = isRunState(task.state) ? JobState::Running : JobState::Waiting;
    if (news.state == JobState::Running) news.seconds = task.seconds;
    return news;
}

// Why a job waits, where it may wait for ever.
void SlurmExecutor::say(const SlurmTask& task, std::size_t job) {
    static const std::set<std::string> usual{"",         "None",     "Dependency",        "Resources",
                                             "Priority", "Cleaning", "JobArrayTaskLimit", "BeginTime",
                                             "Prolog"};
    if (task.state != "PENDING" || usual.count(task.reason) || !mSaid.insert("reason " + task.reason).second)
        return;
    message(mBatch.context, MessageLevel::Warning,
            mBatch.plan.jobs[job].name + ": waits in Slurm's queue: " + task.reason);
}

void SlurmExecutor::cancelWithdrawn(const SlurmTasks& tasks) {
    std::vector<std::string> words;
    for (const auto& [job, held] : mHeld) {
        const auto found = tasks.find({idOf(held.place.array), held.place.index});
        if (held.withdrawn && found != tasks.end() && found->second.state == "PENDING")
            words.push_back(found->first.first + "_" + std::to_string(held.place.index));
    }
    cancelTasks(words);
}

std::vector<JobNews> SlurmExecutor::stop(int, bool failed) {
    std::vector<JobNews> news;
    for (const auto& [job, again] : mToSubmit) {
        JobNews one;
        one.job = job;
        one.returned = true;
        news.push_back(one);
    }
    mToSubmit.clear();
    if (mHeld.empty()) return news;
    if (failed || mBatch.options.slurm->cancel) {
        for (const JobNews& one : cancelAll()) news.push_back(one);
        return news;
    }
    message(mBatch.context, MessageLevel::Note,
            "left in Slurm's queue: " + countText(mHeld.size(), "job") +
                "; the same command follows, scancel " + heldText(" ") + " cancels");
    return news;
}

std::vector<JobNews> SlurmExecutor::cancelAll() {
    cancelTasks(heldIds());
    std::vector<JobNews> news;
    const Clock::time_point began = Clock::now();
    while (!mHeld.empty() && secondsBetween(began, Clock::now()) < 60) {
        bool answered = false;
        std::string problem;
        const SlurmTasks tasks = queuedTasks(heldIds(), answered, problem);
        std::vector<std::size_t> gone;
        for (auto& [job, held] : mHeld) {
            const auto found = tasks.find({idOf(held.place.array), held.place.index});
            if (!answered || (found != tasks.end() && !isEndState(found->second.state))) continue;
            held.withdrawn = true;
            std::optional<JobNews> one = endOf(job, held, found == tasks.end() ? nullptr : &found->second);
            if (!one) continue;
            if (one->returned) {
                one->returned = false;
                one->state = JobState::Stopped;
                one->error = "interrupted; nothing was written";
            }
            news.push_back(*one);
            gone.push_back(job);
        }
        for (const std::size_t job : gone) mHeld.erase(job);
        if (!mHeld.empty()) ::usleep(300000);
    }
    if (!mHeld.empty())
        message(mBatch.context, MessageLevel::Warning,
                "Slurm has not ended all jobs yet (arrays " + heldText(", ") + ")");
    return news;
}

void SlurmExecutor::close() {
    const bool unknown = std::any_of(mSubmission.arrays.begin(), mSubmission.arrays.end(),
                                     [](const SubmittedArray& array) { return array.id.empty(); });
    if (busy() || unknown || ::access(submissionPath(mLogs).c_str(), F_OK) != 0) return;
    ::unlink(submissionPath(mLogs).c_str());
    removeFiles(false);
}

// Of tasks that have ended. What Slurm itself wrote stays with the logs until the next batch, if it is not
// empty.
void SlurmExecutor::removeFiles(bool all) const {
    const std::filesystem::path folder = mLogs + "/slurm";
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem)) {
        std::error_code ignored;
        if (all || entry.path().extension() != ".out" ||
            std::filesystem::file_size(entry.path(), ignored) == 0)
            ::unlink(entry.path().c_str());
    }
    ::rmdir(folder.c_str());
}

}  // namespace vdbsynth::cli::batch
