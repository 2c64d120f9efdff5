// How jobs in Slurm's queue ended, and what an earlier batch left there.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "tools/vdb_synth/batch/executor/output_locks.h"
#include "tools/vdb_synth/batch/job_run_steps.h"
#include "tools/vdb_synth/batch/slurm/slurm_executor.h"
#include "tools/vdb_synth/batch/slurm/slurm_task.h"

#include <algorithm>

namespace vdbsynth::cli::batch {
namespace {

// Shared folders show what another machine wrote only after a while.
constexpr std::chrono::seconds kGrace{10};

// What a killed task left.
void removeRemains(const Plan& plan, const Job& job, const std::string& logs) {
    removeAllTemporaries(plan, job, logs);
    try {
        const OutputLocks locks(plan, job);
    } catch (const Error&) {
        // Another batch holds them by now, or the folder is gone.
    }
}

}  // namespace

// None while its result may still come.
std::optional<JobNews> SlurmExecutor::endOf(std::size_t i, Held& held, const SlurmTask* task) {
    const Job& job = mBatch.plan.jobs[i];
    const std::string name = taskName(mSubmission.token, held.place.array, held.place.index);
    const std::optional<TaskResult> result = readResult(resultPath(mLogs, job.name), name);
    JobNews news;
    news.job = i;
    if (result && result->state != JobState::Stopped) {
        news.state = result->state;
        news.seconds = result->seconds;
        news.peakBytes = result->peakBytes;
        news.error = result->error;
        news.record = result->record;
        // Done while nobody looked: whether it still holds is seen by its files.
        if (held.found && news.record) {
            news.state = JobState::Waiting;
            news.returned = true;
        }
    } else {
        if (!task) task = accounted(held.place);
        const bool cancelled = !task || task->state == "CANCELLED";
        if (held.found && cancelled && mSaid.insert("cancelled").second)
            message(mBatch.context, MessageLevel::Note,
                    "jobs that left Slurm's queue without a result meanwhile are handed over again");
        if (held.withdrawn || (held.found && cancelled) || neverSatisfied(i, task)) {
            news.returned = true;
            if (!task || task->started) removeRemains(mBatch.plan, job, mLogs);
            return news;
        }
        const bool ran = !task || task->started;
        if (ran && !held.ended) held.ended = Clock::now();
        if (ran && Clock::now() - *held.ended < kGrace) return {};
        news.state = JobState::Failed;
        news.error = whyEnded(held, task);
        removeRemains(mBatch.plan, job, mLogs);
    }
    mFailed.erase(i);
    if (news.state == JobState::Failed) {
        mFailed.insert(i);
        news.moreMemory = saysMemory(job, news.error) && !held.again;
    }
    return news;
}

// What Slurm's accounts say of a task that left the queue long ago; null: nothing.
const SlurmTask* SlurmExecutor::accounted(const ArrayPlace& place) {
    const std::string& id = idOf(place.array);
    auto known = mAccounts.find(id);
    if (known == mAccounts.end()) known = mAccounts.insert({id, accountedTasks({id})}).first;
    const auto found = known->second.find({id, place.index});
    // Accounts may be behind.
    return found == known->second.end() || !isEndState(found->second.state) ? nullptr : &found->second;
}

// Cancelled by Slurm as a job before it was not done, or is to be done anew.
bool SlurmExecutor::neverSatisfied(std::size_t i, const SlurmTask* task) const {
    if (task && (task->started || task->state != "CANCELLED")) return false;
    const std::vector<std::size_t>& after = mBatch.plan.jobs[i].after;
    return (task && task->reason == "DependencyNeverSatisfied") ||
           std::any_of(after.begin(), after.end(), [&](std::size_t job) { return mFailed.count(job) > 0; });
}

std::string SlurmExecutor::whyEnded(const Held& held, const SlurmTask* task) const {
    const std::string state = task ? task->state : "";
    if (state == "CANCELLED") return "cancelled in Slurm";
    if (state == "TIMEOUT") return "its time in Slurm ran out; give more with --slurm-time";
    if (state == "DEADLINE") return "its deadline in Slurm passed";
    if (state == "NODE_FAIL" || state == "BOOT_FAIL") return "its node failed";
    if (state == "PREEMPTED") return "Slurm took its node for another job (preempted)";
    if (state == "OUT_OF_MEMORY") return "its memory in Slurm did not suffice; give more with --max-memory";
    const std::string log = slurmLogPath(mLogs, idOf(held.place.array), std::to_string(held.place.index));
    const std::string line = errorIn(log);
    return "ended without a result" +
           (state.empty() ? ", and Slurm does not know it any more" : "; Slurm says " + state) +
           (line.empty() ? "" : "; " + log + ": " + line);
}

// Ids of arrays that were about to be handed over; those that Slurm does not know are taken out.
std::size_t SlurmExecutor::findIds() {
    std::vector<SubmittedArray> arrays;
    std::size_t lost = 0;
    for (SubmittedArray array : mSubmission.arrays) {
        bool answered = true;
        if (array.id.empty()) array.id = arrayNamed(array.name, answered);
        if (!answered)
            throw Error(ErrorCode::Io, "squeue: does not answer, so what is in Slurm's queue is unknown");
        if (array.id.empty())
            ++lost;
        else
            arrays.push_back(array);
    }
    mSubmission.arrays = arrays;
    return lost;
}

void SlurmExecutor::attach() {
    const std::optional<Submission> earlier = readSubmission(mLogs);
    if (!earlier) return;
    mSubmission = *earlier;
    if (findIds() > 0) writeSubmission(mLogs, mSubmission);
    std::map<std::string, std::size_t> jobs;
    for (std::size_t i = 0; i < mBatch.plan.jobs.size(); ++i) jobs[mBatch.plan.jobs[i].name] = i;
    std::set<std::pair<std::string, int>> others;
    for (const SubmittedArray& array : mSubmission.arrays) {
        const TaskFile tasks = readTaskFile(taskFilePath(mLogs, mSubmission.token, array.number));
        mSizes[array.number] = tasks.indices.size();
        mNext = std::max(mNext, array.number + 1);
        for (std::size_t t = 0; t < tasks.indices.size(); ++t) {
            const auto job = jobs.find(tasks.plan.jobs[t].name);
            if (job == jobs.end() || wordsOf(mBatch.plan.jobs[job->second]) != wordsOf(tasks.plan.jobs[t]))
                others.insert({array.id, tasks.indices[t]});
            else
                mHeld[job->second] = {{array.number, tasks.indices[t]}, false, true};
        }
    }
    refuseOthers(others);
    if (!mHeld.empty())
        message(mBatch.context, MessageLevel::Note,
                "follows " + countText(mHeld.size(), "job") + " handed to Slurm before (arrays " +
                    heldText(", ") + ")");
}

void SlurmExecutor::refuseOthers(const std::set<std::pair<std::string, int>>& others) {
    if (others.empty()) return;
    std::set<std::string> ids;
    for (const auto& [id, index] : others) ids.insert(id);
    bool answered = false;
    std::string problem;
    const SlurmTasks tasks = queuedTasks({ids.begin(), ids.end()}, answered, problem);
    if (!answered) throw Error(ErrorCode::Io, problem);
    std::string open;
    for (const auto& other : others) {
        const auto found = tasks.find(other);
        if (found != tasks.end() && !isEndState(found->second.state))
            open += " " + other.first + "_" + std::to_string(other.second);
    }
    if (!open.empty())
        throw Error(ErrorCode::InvalidOption,
                    mBatch.plan.path +
                        ": was changed after jobs of it were handed to Slurm; end those first: "
                        "scancel" +
                        open);
}

}  // namespace vdbsynth::cli::batch
