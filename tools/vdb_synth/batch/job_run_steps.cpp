#include "tools/vdb_synth/batch/job_run_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "tools/vdb_synth/command.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

std::string reportOf(const Job& job, const std::string& logs) {
    return logs + "/" + job.name + (job.arguments.has("frames") ? ".####" : "") + ".report.json";
}

std::vector<std::string> reportsOf(const Job& job, const std::string& logs) {
    std::vector<int> frames;
    const std::string report = reportOf(job, logs);
    if (!job.arguments.has("frames") || !readFrames(job.arguments.text("frames"), frames)) return {report};
    std::vector<std::string> reports;
    for (const int frame : frames) reports.push_back(atFrame(report, frame));
    return reports;
}

}  // namespace

std::string wordFor(JobState state) {
    switch (state) {
        case JobState::Waiting:
            return "waiting";
        case JobState::Running:
            return "running";
        case JobState::Done:
            return "done";
        case JobState::Current:
            return "up to date";
        case JobState::Failed:
            return "failed";
        case JobState::Blocked:
            return "blocked";
        case JobState::Stopped:
            return "stopped";
    }
    return "";
}

std::string errorIn(const std::string& log) {
    std::ifstream file(log);
    std::string last, error;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '$') continue;
        last = line;
        const std::size_t at = line.find("error: ");
        if (at != std::string::npos) error = line.substr(at + 7);
    }
    return error.empty() ? last : error;
}

Before beforeOf(const Job& job, const std::vector<JobStatus>& status) {
    Before before;
    for (const std::size_t other : job.after) {
        const JobState state = status[other].state;
        if (state == JobState::Waiting || state == JobState::Running) before.open = true;
        if (state == JobState::Failed || state == JobState::Blocked || state == JobState::Stopped)
            before.failed = long(other);
    }
    return before;
}

bool saysMemory(const Job& job, const std::string& error) {
    return error.find("--max-memory") != std::string::npos && !job.arguments.has("max-memory");
}

std::vector<std::string> processWords(const Job& job, const RunOptions& options, std::uint64_t memory) {
    std::vector<std::string> words = wordsOf(job);
    const std::string logs = std::filesystem::absolute(options.logs).string();
    words.push_back("--progress=off");
    words.push_back("--report=" + reportOf(job, logs));
    if (!job.arguments.has("threads"))
        words.push_back("--threads=" + std::to_string(std::max(1, options.threads / options.jobs)));
    if (!job.arguments.has("max-memory")) words.push_back("--max-memory=" + std::to_string(memory));
    return words;
}

std::vector<std::string> pictureWords(const std::string& result, const std::string& picture,
                                      const RunOptions& options, std::uint64_t memory) {
    const auto full = [](const std::string& path) { return std::filesystem::absolute(path).string(); };
    return {"render",
            full(result),
            "--output=" + full(picture),
            "--size=200x150",
            "--progress=off",
            "--quiet",
            "--threads=" + std::to_string(std::max(1, options.threads / options.jobs)),
            "--max-memory=" + std::to_string(memory)};
}

std::vector<std::pair<std::string, std::string>> picturesOf(const Plan& plan, const Job& job,
                                                            const std::string& logs) {
    constexpr int kMost = 4;
    std::vector<std::pair<std::string, std::string>> pictures;
    for (const std::string& path : job.writes) {
        const std::string result = inFolder(plan, path);
        struct stat status {};
        if (int(pictures.size()) == kMost || ::stat(result.c_str(), &status) != 0) continue;
        const std::string extension = extensionOf(path);
        if (extension == "png" && status.st_size < 1000000)
            pictures.push_back({result, result});
        else if (extension == "vdb" || isMeshPath(path))
            pictures.push_back(
                {result, logs + "/" + job.name + "." + std::to_string(pictures.size()) + ".png"});
    }
    return pictures;
}

void makeFolders(const Plan& plan, const Job& job, const RunContext& ctx) {
    for (const std::string& path : job.writes) {
        const std::string folder = folderOf(inFolder(plan, path));
        std::error_code problem;
        if (std::filesystem::create_directories(folder, problem))
            message(ctx, MessageLevel::Note, folder + ": made this folder");
        if (problem) throw Error(ErrorCode::Io, folder + ": cannot be made: " + problem.message());
    }
}

void beginLog(const Plan& plan, const Job& job, const std::string& logs,
              const std::vector<std::string>& words) {
    for (const std::string& report : reportsOf(job, logs)) ::unlink(report.c_str());
    const std::string path = logs + "/" + job.name + ".log";
    std::ofstream log(path, std::ios::trunc);
    log << "$ cd " << std::filesystem::absolute(plan.folder).string() << "\n$ vdb_synth " << shellText(words)
        << "\n";
    log.close();
    if (!log) throw Error(ErrorCode::Io, path + ": cannot be written");
}

std::uint64_t peakInReports(const Job& job, const std::string& logs) {
    std::uint64_t peak = 0;
    for (const std::string& report : reportsOf(job, logs)) {
        struct stat status {};
        if (::stat(report.c_str(), &status) != 0) continue;
        const Json json = Json::parse(readWholeFile(report), nullptr, false);
        if (json.is_object() && json.contains("peak_bytes") && json["peak_bytes"].is_number_unsigned())
            peak = std::max(peak, json["peak_bytes"].get<std::uint64_t>());
    }
    return peak;
}

std::vector<std::string> filesWrittenBy(const Plan& plan, const Job& job, const std::string& logs) {
    std::vector<std::string> paths = reportsOf(job, logs);
    for (const std::string& path : job.writes) paths.push_back(inFolder(plan, path));
    return paths;
}

void removeTemporaries(const Plan& plan, const Job& job, const std::string& logs) {
    for (const std::string& path : filesWrittenBy(plan, job, logs)) try {
            OutputSet().reserve(path);  // removes those of dead processes, and its own
        } catch (const Error&) {
            // A folder that cannot be written holds none.
        }
}

}  // namespace vdbsynth::cli::batch
