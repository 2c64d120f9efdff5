#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "tools/vdb_synth/batch/batch_lock.h"
#include "tools/vdb_synth/batch/job_manifest.h"
#include "tools/vdb_synth/batch/job_run.h"
#include "tools/vdb_synth/batch/job_schema.h"
#include "tools/vdb_synth/batch/slurm/slurm_commands.h"
#include "tools/vdb_synth/batch/slurm/slurm_submission.h"
#include "tools/vdb_synth/batch/slurm/slurm_task.h"
#include "tools/vdb_synth/batch/status_page.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <thread>

namespace vdbsynth::cli {
namespace {

using namespace batch;

std::map<std::string, std::string> setVariables(const Arguments& arguments) {
    std::map<std::string, std::string> set;
    for (const std::string& text : arguments.all("set")) {
        const std::size_t sign = text.find('=');
        if (sign == std::string::npos || sign == 0)
            throw Error(ErrorCode::InvalidOption, "--set " + text + ": must be NAME=VALUE");
        if (!set.insert({text.substr(0, sign), text.substr(sign + 1)}).second)
            throw Error(ErrorCode::InvalidOption, "--set " + text.substr(0, sign) + ": given twice");
    }
    return set;
}

std::string logsOf(const Arguments& arguments, const std::string& path) {
    if (arguments.has("logs")) return arguments.text("logs");
    std::string name = fileNameOf(path);
    name = name.substr(0, std::max<std::size_t>(1, std::min(name.rfind('.'), name.size())));
    return folderOf(path) + "/" + name + ".logs";
}

void makeLogs(const std::string& logs) {
    std::error_code problem;
    std::filesystem::create_directories(logs, problem);
    if (problem || !std::filesystem::is_directory(logs, problem))
        throw Error(ErrorCode::Io, logs + ": no folder can be made here; give another --logs FOLDER");
}

bool usesSlurm(const Arguments& arguments) {
    return arguments.text("executor") == "slurm";
}

void refuseCombinations(const Arguments& arguments) {
    const auto refuse = [](const std::string& text) { throw Error(ErrorCode::InvalidOption, text); };
    if (arguments.has("keep-going") && arguments.has("fail-fast"))
        refuse("--keep-going and --fail-fast: give one of them");
    if (arguments.has("json") && !arguments.has("dry-run")) refuse("--json: needs --dry-run");
    if (arguments.has("pictures") && !arguments.has("page")) refuse("--pictures: needs --page FILE.html");
    if (arguments.has("output") && !arguments.has("dry-run") && !arguments.has("schema"))
        refuse("--output: needs --dry-run or --schema; jobs name their outputs themselves");
    for (const char* name : {"slurm-partition", "slurm-time", "slurm-arguments", "on-interrupt"})
        if (arguments.has(name) && !usesSlurm(arguments))
            refuse(std::string("--") + name + ": needs --executor slurm");
}

nlohmann::json asReport(const Plan& plan, const std::vector<JobStatus>& status) {
    nlohmann::json jobs = nlohmann::json::array();
    for (std::size_t i = 0; i < status.size(); ++i)
        jobs.push_back({{"name", plan.jobs[i].name},
                        {"state", wordFor(status[i].state)},
                        {"seconds", status[i].seconds},
                        {"peak_bytes", status[i].peakBytes},
                        {"error", status[i].error}});
    return jobs;
}

std::size_t countOf(const std::vector<JobStatus>& status, JobState state) {
    return std::size_t(std::count_if(status.begin(), status.end(),
                                     [&](const JobStatus& one) { return one.state == state; }));
}

// What did not work, a line a job; then the sum as the error of the run.
void judge(const Plan& plan, const std::vector<JobStatus>& status, const std::string& logs,
           const RunContext& ctx) {
    if (ctx.cancel && *ctx.cancel)
        throw Error(ErrorCode::Cancelled,
                    "interrupted: " + countsText(status) + "; the same command continues");
    std::string first;
    for (std::size_t i = 0; i < status.size(); ++i) {
        if (status[i].state == JobState::Failed && first.empty())
            first = plan.jobs[i].name + ": " + status[i].error;
        if (status[i].state == JobState::Blocked)
            message(ctx, MessageLevel::Warning, plan.jobs[i].name + ": " + status[i].error);
    }
    if (first.empty()) return message(ctx, MessageLevel::Note, countsText(status));
    throw Error(ErrorCode::Unusable, countsText(status) + "; first " + first + "; logs in " + logs);
}

// Its processes inherit the limit of this one.
void refuseTooMuchMemory(const Plan& plan, const RunContext& ctx) {
    for (const Job& job : plan.jobs)
        if (job.arguments.has("max-memory") && job.arguments.wide("max-memory") > ctx.maxMemory)
            throw Error(ErrorCode::InvalidOption,
                        plan.path + ": job " + job.name + ": --max-memory " +
                            job.arguments.text("max-memory") + ": is more than the batch may use, " +
                            std::to_string(ctx.maxMemory / 1000000) + "M; give batch a larger --max-memory");
}

SlurmOptions slurmFrom(const Arguments& arguments) {
    SlurmOptions options;
    options.partition = arguments.text("slurm-partition");
    options.time = arguments.text("slurm-time");
    options.arguments = sbatchArguments(arguments.text("slurm-arguments"));
    options.atOnce = arguments.has("jobs") ? arguments.whole("jobs") : 0;
    options.threads = std::max(1, arguments.whole("threads"));
    if (arguments.has("max-memory")) options.memory = arguments.wide("max-memory");
    options.cancel = arguments.text("on-interrupt") == "cancel";
    return options;
}

RunOptions optionsFrom(const Run& run, const std::string& logs) {
    RunOptions options;
    if (usesSlurm(run.arguments))
        options.slurm = slurmFrom(run.arguments);
    else
        options.jobs = run.arguments.whole("jobs");
    options.threads =
        run.context.threads > 0 ? run.context.threads : int(std::thread::hardware_concurrency());
    options.memory = run.context.maxMemory;
    options.failFast = run.arguments.has("fail-fast");
    options.pictures = run.arguments.has("pictures");
    options.logs = logs;
    return options;
}

// A page that cannot be written at first is an error; later on, it is no reason to stop the night's jobs.
std::function<void(const std::vector<JobStatus>&)> pageWriter(const Run& run, const Plan& plan) {
    const std::string path = run.arguments.text("page");
    const auto pictures = std::make_shared<std::map<std::string, std::string>>();
    replaceFile(path, statusPage(plan, std::vector<JobStatus>(plan.jobs.size()), *pictures));
    const auto warned = std::make_shared<bool>(false);
    return [=, &run, &plan](const std::vector<JobStatus>& status) {
        try {
            replaceFile(path, statusPage(plan, status, *pictures));
        } catch (const Error& error) {
            if (!*warned) message(run.context, MessageLevel::Warning, error.what());
            *warned = true;
        }
    };
}

void execute(Run& run, const Plan& plan) {
    const bool slurm = usesSlurm(run.arguments);
    if (slurm) requireSlurm();
    const std::string logs = logsOf(run.arguments, plan.path);
    RunOptions options = optionsFrom(run, logs);
    makeLogs(logs);
    const BatchLock lock(logs, !slurm, run.context);
    if (!slurm) refuseSubmitted(logs);
    options.keptOpen = lock.jobsFile();
    if (run.arguments.has("page")) options.onChange = pageWriter(run, plan);
    Manifest manifest(logs + "/manifest.json", run.context);
    const std::vector<JobStatus> status = runJobs(plan, options, manifest, run.context);
    run.count("jobs", asReport(plan, status));
    run.count("done", countOf(status, JobState::Done));
    run.count("up_to_date", countOf(status, JobState::Current));
    run.count("failed", countOf(status, JobState::Failed));
    if (!run.context.cancel || !*run.context.cancel) run.finish();
    judge(plan, status, logs, run.context);
}

void runBatch(Run& run) {
    const Arguments& arguments = run.arguments;
    refuseCombinations(arguments);
    if (arguments.has("schema")) {
        run.answer(jobSchema().dump(2));
        return run.finish();
    }
    run.requireInputs(1, 1);
    const std::string path = arguments.inputs[0];
    if (run.withoutTemporaries(path) != path)
        throw Error(ErrorCode::InvalidOption, "a batch is read from a file, as its logs lie beside it");
    if (arguments.has("task")) return runTask(path, arguments.whole("task"), run.context);
    const Plan plan = makePlan(readJobFile(path, readJobText(path), setVariables(arguments)));
    if (!usesSlurm(arguments)) refuseTooMuchMemory(plan, run.context);
    if (!arguments.has("dry-run")) return execute(run, plan);
    if (arguments.has("json") || arguments.has("output"))
        run.answer(planJson(plan).dump(2, ' ', false, Json::error_handler_t::replace));
    else
        printLine(planText(plan));
    run.finish();
}

}  // namespace

const Command kBatch{"batch",
                     "batch JOBS.json|JOBS.yaml [--jobs N] [options]",
                     "Run many commands from one file; continue where a run before was stopped",
                     "vdb_synth batch shots.json --jobs 4 --page status.html",
                     runBatch,
                     false,
                     true};

}  // namespace vdbsynth::cli
