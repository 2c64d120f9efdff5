// Hands jobs to Slurm as arrays.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "tools/vdb_synth/batch/slurm/slurm_executor.h"
#include "tools/vdb_synth/batch/slurm/slurm_task.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

// Slurm's patterns in names of files begin with %.
std::string withoutPatterns(const std::string& path) {
    std::string text;
    for (const char c : path) text += c == '%' ? std::string("%%") : std::string(1, c);
    return text;
}

// The beginning of a job's name, for people who look at the queue.
std::string plainName(const std::string& entry) {
    std::string name;
    for (const char c : entry)
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_') name += c;
    return name.empty() ? "job" : name;
}

}  // namespace

long SlurmExecutor::megabytesFor(std::size_t i, bool again) const {
    if (again) return kAllMemory;
    const Job& job = mBatch.plan.jobs[i];
    const std::uint64_t most = mBatch.options.slurm->memory;
    // A tenth more than it plans with, see runTask.
    if (job.arguments.has("max-memory"))
        return long(job.arguments.wide("max-memory") / 9 * 10 / (1 << 20)) + 64;
    const JobRecord* record = mBatch.manifest.find(job.name);
    const long limit = long(most / (1 << 20));
    if (!record || record->peakBytes == 0) return limit;
    return limit > 0 ? std::min(roomFor(record->peakBytes), limit) : roomFor(record->peakBytes);
}

ArrayRequest SlurmExecutor::requestFor(std::size_t i, bool again) const {
    const Job& job = mBatch.plan.jobs[i];
    ArrayRequest request;
    request.job = i;
    request.entry = job.entry;
    for (const std::size_t before : job.after)
        if (mHeld.count(before) || mToSubmit.count(before)) request.needs.push_back(before);
    const int own = job.arguments.has("threads") ? job.arguments.whole("threads") : 0;
    request.cores = own > 0 ? own : mBatch.options.slurm->threads;
    request.megabytes = megabytesFor(i, again);
    return request;
}

// What cannot be handed over now, as a queue that is full, is tried again while other jobs run.
void SlurmExecutor::submit() {
    if (mToSubmit.empty() || Clock::now() < mRetry) return;
    if (mLargest == 0) mLargest = largestIndex();
    std::vector<ArrayRequest> requests;
    for (const auto& [job, again] : mToSubmit) requests.push_back(requestFor(job, again));
    std::map<std::size_t, ArrayPlace> placed;
    for (const auto& [job, held] : mHeld) placed[job] = held.place;
    const std::map<std::size_t, bool> again = mToSubmit;
    for (const ArrayPlan& plan : arraysOf(requests, placed, mLargest, mNext)) try {
            hand(plan, again);
        } catch (const Error& error) {
            if (mHeld.empty()) throw;
            if (mSaid.insert(error.what()).second)
                message(mBatch.context, MessageLevel::Warning,
                        std::string(error.what()) + "; jobs that wait for this are handed over later");
            mRetry = Clock::now() + std::chrono::seconds(5);
            return;
        }
}

void SlurmExecutor::hand(const ArrayPlan& plan, const std::map<std::size_t, bool>& again) {
    if (mSubmission.arrays.empty()) {
        mSubmission = newSubmission();
        removeFiles(true);
    }
    std::error_code problem;
    std::filesystem::create_directories(mLogs + "/slurm", problem);
    TaskFile tasks{mSubmission.token, plan.number, mLogs, {}, {}};
    tasks.plan.path = mBatch.plan.path;
    tasks.plan.folder = fullPath(mBatch.plan.folder);
    for (const auto& [index, job] : plan.tasks) {
        tasks.indices.push_back(index);
        tasks.plan.jobs.push_back(mBatch.plan.jobs[job]);
    }
    writeTaskFile(taskFilePath(mLogs, mSubmission.token, plan.number), tasks);
    const std::string name =
        plainName(plan.entry) + "-" + mSubmission.token + "-" + std::to_string(plan.number);
    mSubmission.arrays.push_back({plan.number, name, ""});
    writeSubmission(mLogs, mSubmission);
    mSubmission.arrays.back().id = submitArray(plan, name);
    mSizes[plan.number] = plan.tasks.size();
    for (const auto& [index, job] : plan.tasks) {
        mHeld[job] = {{plan.number, index}, again.at(job)};
        mToSubmit.erase(job);
    }
    writeSubmission(mLogs, mSubmission);
    message(mBatch.context, MessageLevel::Detail,
            plan.entry + ": " + countText(plan.tasks.size(), "job") + " in array " +
                mSubmission.arrays.back().id);
}

// The id; where sbatch fails, the array is unknown to Slurm, or its id is found by its name.
std::string SlurmExecutor::submitArray(const ArrayPlan& plan, const std::string& name) {
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    const std::string script =
        "#!/bin/sh\nexec " +
        shellText({program, "batch", taskFilePath(mLogs, mSubmission.token, plan.number)}) +
        " --progress=off --task \"$SLURM_ARRAY_TASK_ID\"\n";
    try {
        return submitted(argumentsOf(plan, name), script);
    } catch (const Error&) {
        bool answered = false;
        const std::string id = arrayNamed(name, answered);
        if (answered && !id.empty()) return id;
        // Unknown whether it is there: its name stays for the next batch, which asks again.
        if (!answered) throw;
        mSubmission.arrays.pop_back();
        if (mSubmission.arrays.empty())
            ::unlink(submissionPath(mLogs).c_str());
        else
            writeSubmission(mLogs, mSubmission);
        throw;
    }
}

std::vector<std::string> SlurmExecutor::argumentsOf(const ArrayPlan& plan, const std::string& name) const {
    const SlurmOptions& options = *mBatch.options.slurm;
    std::vector<std::string> words;
    const auto add = [&](const std::string& option, const std::string& value) {
        if (!value.empty()) words.push_back("--" + option + "=" + value);
    };
    std::map<int, std::string> ids;
    for (const SubmittedArray& array : mSubmission.arrays) ids[array.number] = array.id;
    add("partition", options.partition);
    add("time", options.time);
    add("job-name", name);
    add("array", indexText(plan.tasks) + (options.atOnce > 0 ? "%" + std::to_string(options.atOnce) : ""));
    add("dependency", dependencyText(plan, ids, mSizes));
    add("kill-on-invalid-dep", "yes");
    words.push_back("--requeue");
    add("output", withoutPatterns(mLogs) + "/slurm/%A_%a.out");
    add("open-mode", "append");
    add("chdir", fullPath(mBatch.plan.folder));
    add("ntasks", "1");
    add("cpus-per-task", std::to_string(plan.cores));
    // Those of the user's that say the same win.
    const bool own = std::any_of(options.arguments.begin(), options.arguments.end(),
                                 [](const std::string& word) { return word.compare(0, 5, "--mem") == 0; });
    if (plan.megabytes != 0 && !own)
        add("mem", plan.megabytes == kAllMemory ? "0" : std::to_string(plan.megabytes) + "M");
    words.insert(words.end(), options.arguments.begin(), options.arguments.end());
    return words;
}

}  // namespace vdbsynth::cli::batch
