#include "tools/vdb_synth/batch/slurm/slurm_task.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "tools/vdb_synth/batch/batch_lock.h"
#include "tools/vdb_synth/batch/job_run_steps.h"
#include "tools/vdb_synth/batch/slurm/slurm_submission.h"
#include "tools/vdb_synth/command.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

constexpr int kFormat = 1;

Json jsonOf(const Job& job) {
    return {{"name", job.name},
            {"entry", job.entry},
            {"command", job.command->name},
            {"inputs", job.arguments.inputs},
            {"options", job.arguments.values},
            {"reads", job.reads},
            {"writes", job.writes}};
}

Job jobOf(const Json& json) {
    Job job;
    job.name = json.at("name").get<std::string>();
    job.entry = json.at("entry").get<std::string>();
    const std::string command = json.at("command").get<std::string>();
    job.command = findCommand(command);
    if (!job.command) throw Error(ErrorCode::BadData, command + ": unknown command");
    job.arguments = Arguments(command);
    job.arguments.inputs = json.at("inputs").get<std::vector<std::string>>();
    for (const auto& [name, values] : json.at("options").items())
        job.arguments.values[name] = values.get<std::vector<std::string>>();
    job.reads = json.at("reads").get<std::vector<std::string>>();
    job.writes = json.at("writes").get<std::vector<std::string>>();
    return job;
}

Json jsonOf(const JobRecord& record) {
    return {{"fingerprint", record.fingerprint},
            {"outputs", record.outputs},
            {"seconds", record.seconds},
            {"peak_bytes", record.peakBytes}};
}

JobRecord recordOf(const Json& json) {
    JobRecord record;
    record.fingerprint = json.at("fingerprint").get<std::string>();
    for (const auto& [output, hash] : json.at("outputs").items())
        record.outputs[output] = hash.get<std::string>();
    record.seconds = json.at("seconds").get<double>();
    record.peakBytes = json.at("peak_bytes").get<std::uint64_t>();
    return record;
}

// A number that Slurm sets in a task's environment, 0 if it does not.
long slurmNumber(const char* name) {
    const char* text = std::getenv(name);
    long number = 0;
    return text && parseWhole(text, number) && number > 0 ? number : 0;
}

// What Slurm reserved, less a tenth: programs need some memory besides what they plan with.
std::uint64_t reservedMemory(const RunContext& ctx) {
    long megabytes = slurmNumber("SLURM_MEM_PER_NODE");
    if (megabytes == 0)
        megabytes = slurmNumber("SLURM_MEM_PER_CPU") * std::max(1L, slurmNumber("SLURM_CPUS_ON_NODE"));
    const std::uint64_t reserved = std::uint64_t(megabytes) * (1 << 20) / 10 * 9;
    return reserved > 0 ? std::min(reserved, ctx.maxMemory) : ctx.maxMemory;
}

// The record of the last task that did the job, else that of the batch.
void takeRecord(Manifest& manifest, const Job& job, const std::string& logs, const RunContext& ctx) {
    const std::optional<TaskResult> last = readResult(resultPath(logs, job.name), "");
    if (last && last->record) return manifest.put(job.name, *last->record);
    if (const JobRecord* record = Manifest(logs + "/manifest.json", ctx).find(job.name))
        manifest.put(job.name, *record);
}

TaskResult resultOf(const JobStatus& status, const Manifest& manifest, const Job& job,
                    const RunContext& ctx) {
    TaskResult result{"", status.state, status.seconds, status.peakBytes, status.error, {}};
    const bool done = status.state == JobState::Done || status.state == JobState::Current;
    if (done) result.record = *manifest.find(job.name);
    // Slurm asks all processes at once: the job may have ended before this one heard of it.
    if (status.state == JobState::Failed) {
        for (int tries = 0; tries < 30 && !(ctx.cancel && *ctx.cancel); ++tries) ::usleep(10000);
        if (ctx.cancel && *ctx.cancel) result.state = JobState::Stopped;
    }
    return result;
}

}  // namespace

void writeTaskFile(const std::string& path, const TaskFile& tasks) {
    Json jobs = Json::object();
    for (std::size_t i = 0; i < tasks.plan.jobs.size(); ++i)
        jobs[std::to_string(tasks.indices[i])] = jsonOf(tasks.plan.jobs[i]);
    const Json all{{"format", kFormat},
                   {"token", tasks.token},
                   {"number", tasks.number},
                   {"job_file", tasks.plan.path},
                   {"folder", tasks.plan.folder},
                   {"logs", tasks.logs},
                   {"tasks", jobs}};
    std::string text;
    try {
        text = all.dump(1) + "\n";
    } catch (const nlohmann::json::exception&) {
        throw Error(ErrorCode::InvalidOption,
                    tasks.plan.path + ": a name is not UTF-8, which jobs of --executor slurm must be");
    }
    replaceFile(path, text);
}

TaskFile readTaskFile(const std::string& path) {
    TaskFile tasks;
    const Json json = parseJobText(path, readWholeFile(path), false);
    try {
        if (json.at("format").get<int>() != kFormat) throw Error(ErrorCode::BadData, "is of another format");
        tasks.token = json.at("token").get<std::string>();
        tasks.number = json.at("number").get<int>();
        tasks.logs = json.at("logs").get<std::string>();
        tasks.plan.path = json.at("job_file").get<std::string>();
        tasks.plan.folder = json.at("folder").get<std::string>();
        for (const auto& [index, job] : json.at("tasks").items()) {
            tasks.indices.emplace_back();
            if (!parseWhole(index, tasks.indices.back())) throw Error(ErrorCode::BadData, "has a bad index");
            tasks.plan.jobs.push_back(jobOf(job));
        }
    } catch (const std::exception& error) {
        throw Error(ErrorCode::BadData,
                    path + ": is no file of tasks that --executor slurm wrote: " + std::string(error.what()));
    }
    return tasks;
}

std::string taskName(const std::string& token, int number, int index) {
    return token + "." + std::to_string(number) + "." + std::to_string(index);
}

void writeResult(const std::string& path, const TaskResult& result) {
    Json json{{"format", kFormat},
              {"task", result.task},
              {"state", wordFor(result.state)},
              {"seconds", result.seconds},
              {"peak_bytes", result.peakBytes},
              {"error", result.error}};
    if (result.record) json["record"] = jsonOf(*result.record);
    replaceFile(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<TaskResult> readResult(const std::string& path, const std::string& task) {
    if (::access(path.c_str(), F_OK) != 0) return {};
    try {
        const Json json = parseJobText(path, readWholeFile(path), false);
        TaskResult result;
        result.task = json.at("task").get<std::string>();
        if (json.at("format").get<int>() != kFormat || (!task.empty() && result.task != task)) return {};
        const std::string word = json.at("state").get<std::string>();
        for (const JobState state : {JobState::Done, JobState::Current, JobState::Failed, JobState::Stopped})
            if (wordFor(state) == word) result.state = state;
        result.seconds = json.at("seconds").get<double>();
        result.peakBytes = json.at("peak_bytes").get<std::uint64_t>();
        result.error = json.at("error").get<std::string>();
        if (json.contains("record")) result.record = recordOf(json.at("record"));
        return result;
    } catch (const std::exception&) {
        return {};  // the job runs again
    }
}

void removeAllTemporaries(const Plan& plan, const Job& job, const std::string& logs) {
    for (const std::string& path : filesWrittenBy(plan, job, logs)) {
        std::error_code problem;
        const std::filesystem::path real = std::filesystem::weakly_canonical(path, problem);
        if (problem) continue;
        const std::string begins = "." + real.filename().string() + ".";
        for (const auto& entry : std::filesystem::directory_iterator(real.parent_path(), problem)) {
            const std::string name = entry.path().filename().string();
            if (name.size() <= begins.size() + 4 || name.compare(0, begins.size(), begins) != 0 ||
                name.compare(name.size() - 4, 4, ".tmp") != 0)
                continue;
            const std::string middle = name.substr(begins.size(), name.size() - begins.size() - 4);
            if (middle.find_first_not_of("0123456789-") == std::string::npos) ::unlink(entry.path().c_str());
        }
    }
}

void runTask(const std::string& path, int index, const RunContext& ctx) {
    const TaskFile tasks = readTaskFile(path);
    const auto at = std::find(tasks.indices.begin(), tasks.indices.end(), index);
    if (at == tasks.indices.end())
        throw Error(ErrorCode::InvalidOption,
                    "--task " + std::to_string(index) + ": " + path + " has no task of this number");
    const Plan plan{
        tasks.plan.path, tasks.plan.folder, {tasks.plan.jobs[std::size_t(at - tasks.indices.begin())]}};
    const Job& job = plan.jobs[0];
    const JobsLock lock(tasks.logs, ctx);
    removeAllTemporaries(plan, job, tasks.logs);
    RunOptions options;
    options.threads = int(std::max(1L, slurmNumber("SLURM_CPUS_PER_TASK")));
    options.memory = reservedMemory(ctx);
    options.logs = tasks.logs;
    options.keptOpen = lock.file();
    Manifest manifest("", ctx);
    takeRecord(manifest, job, tasks.logs, ctx);
    RunContext quiet = ctx;
    quiet.onProgress = {};
    quiet.onMessage = {};  // the result says it
    const JobStatus status = runJobs(plan, options, manifest, quiet).front();
    TaskResult result = resultOf(status, manifest, job, ctx);
    result.task = taskName(tasks.token, tasks.number, index);
    writeResult(resultPath(tasks.logs, job.name), result);
    if (result.state == JobState::Stopped)
        throw Error(ErrorCode::Cancelled, "interrupted: " + job.name + " is not done");
    if (result.state == JobState::Failed) throw Error(ErrorCode::Unusable, job.name + ": " + result.error);
}

}  // namespace vdbsynth::cli::batch
