#include "tools/vdb_synth/batch/job_paths.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/batch/job_expansion.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <filesystem>

#include <fnmatch.h>
#include <sys/stat.h>

namespace vdbsynth::cli::batch {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

// The first input of these names a kind, not a file.
bool isKind(const Job& job, std::size_t input) {
    return input == 0 && (job.command->name == "make" || job.command->name == "mask");
}

void add(std::vector<std::string>& paths, const Job& job, const std::string& path) {
    if (path == "-" || path.compare(0, 2, "-.") == 0)
        refuse(path + ": a job has no standard streams; name a file");
    std::vector<int> frames;
    if (!job.arguments.has("frames") || !readFrames(job.arguments.text("frames"), frames))
        return paths.push_back(path);
    for (const int frame : frames) {
        paths.push_back(atFrame(path, frame));
        if (!namesFrames(path)) return;
    }
}

std::vector<std::string> pathsOf(const Job& job, bool written) {
    std::vector<std::string> paths;
    for (std::size_t i = 0; i < job.arguments.inputs.size(); ++i)
        if (!isKind(job, i) && job.command->inputsAreOutputs == written)
            add(paths, job, job.arguments.inputs[i]);
    for (const Option& option : optionsOf(job.command->name))
        for (const std::string& value : job.arguments.all(option.name)) {
            const std::string path = pathIn(option, value);
            if (!path.empty() && path != kNoValue && readsPath(option) != written) add(paths, job, path);
        }
    return paths;
}

bool exists(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0;
}

}  // namespace

std::vector<std::string> readBy(const Job& job) {
    return pathsOf(job, false);
}

std::vector<std::string> writtenBy(const Job& job) {
    return pathsOf(job, true);
}

std::string inFolder(const Plan& plan, const std::string& path) {
    return path.empty() || path[0] == '/' ? path : plan.folder + "/" + path;
}

PathTable::PathTable(const Plan& plan) : mPlan(plan) {}

std::string PathTable::full(const std::string& path) const {
    return std::filesystem::absolute(inFolder(mPlan, path)).lexically_normal().string();
}

void PathTable::addOutput(std::size_t job, const std::string& name, const std::string& path) {
    const std::string key = full(path);
    if (key == std::filesystem::absolute(mPlan.path).lexically_normal().string())
        refuse(path + ": is the job file itself; give another output");
    const auto [entry, added] = mOutputs.insert({key, {job, name, path}});
    if (added) return;
    if (entry->second.job == job) refuse(path + ": named as an output twice");
    refuse(path + ": job " + entry->second.name +
           " writes it too; write ${...} of what tells them apart into it");
}

void PathTable::refuseMatches(const std::string& pattern) const {
    const std::string key = full(pattern);
    for (const auto& [path, output] : mOutputs)
        if (::fnmatch(key.c_str(), path.c_str(), FNM_PATHNAME | FNM_PERIOD) == 0)
            refuse(mPlan.path + ": \"matrix\": " + pattern + ": would match " + output.path + ", which job " +
                   output.name +
                   " writes, and so make other jobs the next time; write outputs to another folder");
}

std::vector<std::string> PathTable::expanded(std::size_t job, const Job& of) const {
    std::vector<std::string> inputs;
    for (std::size_t i = 0; i < of.arguments.inputs.size(); ++i) {
        const std::string& input = of.arguments.inputs[i];
        // A file may be called so.
        if (isKind(of, i) || of.command->inputsAreOutputs || !isPattern(input) ||
            exists(inFolder(mPlan, input))) {
            inputs.push_back(input);
            continue;
        }
        std::map<std::string, std::string> found;  // by full path: one file once
        for (const std::string& path : filesOf(input, mPlan.folder)) found[full(path)] = path;
        const std::string key = full(input);
        for (const auto& [path, output] : mOutputs) {
            if (::fnmatch(key.c_str(), path.c_str(), FNM_PATHNAME | FNM_PERIOD) != 0) continue;
            if (output.job == job) refuse(input + ": matches the job's own output " + output.path);
            found.insert({path, output.path});
        }
        if (found.empty()) refuse(input + ": matches no file, and nothing that a job writes");
        for (const auto& [ignored, path] : found) inputs.push_back(path);
    }
    return inputs;
}

long PathTable::makerOf(std::size_t job, const std::string& path) const {
    const auto made = mOutputs.find(full(path));
    if (made != mOutputs.end()) {
        if (made->second.job == job)
            refuse(path +
                   ": the job would replace its own input, and could not be repeated; give another output");
        return long(made->second.job);
    }
    if (exists(inFolder(mPlan, path))) return -1;
    std::vector<std::string> names;
    for (const auto& [ignored, output] : mOutputs) names.push_back(output.path);
    const std::string near = nearestName(path, names);
    throw Error(ErrorCode::Io, path + ": does not exist, and no job writes it" +
                                   (near.empty() ? "" : "; did you mean " + near + "?"));
}

}  // namespace vdbsynth::cli::batch
