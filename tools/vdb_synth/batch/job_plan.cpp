#include "tools/vdb_synth/batch/job_plan.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "tools/vdb_synth/batch/job_expansion.h"
#include "tools/vdb_synth/batch/job_paths.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <cctype>

namespace vdbsynth::cli::batch {
namespace {

// One job with the texts that only the whole plan can resolve.
struct Draft {
    Job job;
    std::vector<std::string> after;
};

void setOption(Arguments& arguments, const Option& option, const Json& given,
               const std::map<std::string, Json>& values) {
    std::vector<std::string> texts;
    for (const Json& item : given.is_array() ? given : Json::array({given}))
        texts.push_back(filledIn(textOf(item), values));
    if (given.is_null() || texts.empty()) return;
    const bool truth = texts[0] == "true" || texts[0] == "false";
    if (option.kind == Kind::Flag && !truth)
        throw Error(ErrorCode::InvalidOption,
                    "\"" + option.name + "\": " + texts[0] + ": must be true or false");
    if ((option.kind == Kind::Flag || option.valueOptional) && truth) {
        if (texts[0] == "true")
            arguments.values[option.name] = {option.kind == Kind::Flag ? std::string("true") : kNoValue};
        return;
    }
    arguments.values[option.name] = texts;
}

// Inputs that are patterns stay so until all outputs are known.
Draft draftOf(const JobEntry& entry, const Variant& variant) {
    Draft draft;
    Job& job = draft.job;
    job.name = variant.name;
    job.entry = entry.name;
    job.command = findCommand(entry.command);
    job.arguments = Arguments(entry.command);
    for (const std::string& input : entry.inputs)
        job.arguments.inputs.push_back(filledIn(input, variant.values));
    std::vector<std::string> outputs;
    for (const std::string& output : entry.outputs) outputs.push_back(filledIn(output, variant.values));
    if (job.command->inputsAreOutputs)
        job.arguments.inputs.insert(job.arguments.inputs.end(), outputs.begin(), outputs.end());
    else if (!outputs.empty() && !findOption(entry.command, "output"))
        throw Error(ErrorCode::InvalidOption, "\"output\": " + entry.command + " writes none");
    else if (!outputs.empty())
        job.arguments.values["output"] = outputs;
    for (const auto& [name, value] : entry.options.items())
        setOption(job.arguments, *findOption(entry.command, name), value, variant.values);
    for (const std::string& name : entry.after) {
        const std::string filled = filledIn(name, variant.values);
        draft.after.push_back(variant.frame < 0 ? filled : atFrame(filled, variant.frame));
    }
    if (variant.frame >= 0) {
        if (job.arguments.has("frames"))
            throw Error(
                ErrorCode::InvalidOption,
                "\"frames\": stands in the job, which runs a command for each frame, and in its options, "
                "which runs one for all; write one of them");
        job.arguments = atFrame(job.arguments, variant.frame);
    }
    return draft;
}

void requireName(const std::string& name) {
    const bool good = std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) ||
               std::string("._-+=,@").find(c) != std::string::npos;
    });
    if (name.size() > 200 || !good || name[0] == '.' || name[0] == '-')
        throw Error(ErrorCode::InvalidOption,
                    "\"name\": must be at most 200 letters, digits and . _ - + = , @, and begin with none of "
                    ". and -");
}

Error inJob(const Plan& plan, const std::string& name, const Error& error) {
    return Error(error.code(), plan.path + ": job " + name + ": " + error.what());
}

// Those that an "after" names: jobs of that name, else all of that entry.
std::vector<std::size_t> named(const std::vector<Draft>& drafts, const std::string& name) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < drafts.size(); ++i)
        if (drafts[i].job.name == name) return {i};
    for (std::size_t i = 0; i < drafts.size(); ++i)
        if (drafts[i].job.entry == name) found.push_back(i);
    return found;
}

std::vector<Draft> draftsOf(const JobFile& file, const Plan& plan, std::vector<std::string>& patterns) {
    std::vector<Draft> drafts;
    for (const JobEntry& entry : file.entries) {
        std::string name = entry.name;
        try {
            for (const Variant& variant : variantsOf(entry, file.variables, plan.folder, patterns)) {
                name = variant.name;
                requireName(name);
                drafts.push_back(draftOf(entry, variant));
            }
        } catch (const Error& error) {
            throw inJob(plan, name, error);
        }
    }
    std::map<std::string, int> names;
    for (const Draft& draft : drafts)
        if (names[draft.job.name]++ > 0)
            throw Error(ErrorCode::InvalidOption, plan.path + ": job " + draft.job.name +
                                                      ": two jobs have this name; write ${...} of what "
                                                      "tells them apart into it");
    return drafts;
}

void addAfter(std::vector<Draft>& drafts, Draft& draft) {
    for (const std::string& name : draft.after) {
        const std::vector<std::size_t> found = named(drafts, name);
        if (found.empty()) {
            std::vector<std::string> names;
            for (const Draft& other : drafts) names.push_back(other.job.entry);
            const std::string near = nearestName(name, names);
            throw Error(ErrorCode::InvalidOption, "\"after\": " + name + ": no job has this name" +
                                                      (near.empty() ? "" : "; did you mean " + near + "?"));
        }
        draft.job.after.insert(draft.job.after.end(), found.begin(), found.end());
    }
}

// Walks back along what must be done before: a job that is reached again stands in a circle.
void refuseCircles(const Plan& plan) {
    std::vector<int> waits(plan.jobs.size(), 0);
    std::vector<std::vector<std::size_t>> next(plan.jobs.size());
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        for (const std::size_t before : plan.jobs[i].after) next[before].push_back(i);
        waits[i] = int(plan.jobs[i].after.size());
        if (waits[i] == 0) ready.push_back(i);
    }
    for (std::size_t done = 0; done < ready.size(); ++done)
        for (const std::size_t after : next[ready[done]])
            if (--waits[after] == 0) ready.push_back(after);
    if (ready.size() == plan.jobs.size()) return;
    std::size_t at = 0;
    while (waits[at] == 0) ++at;
    std::vector<std::size_t> walked;
    while (std::find(walked.begin(), walked.end(), at) == walked.end()) {
        walked.push_back(at);
        for (const std::size_t before : plan.jobs[at].after)
            if (waits[before] > 0) {
                at = before;
                break;
            }
    }
    std::string circle = plan.jobs[at].name;
    for (auto it = std::find(walked.begin(), walked.end(), at); it != walked.end(); ++it)
        if (*it != at) circle += " after " + plan.jobs[*it].name;
    throw Error(ErrorCode::InvalidOption, plan.path + ": jobs wait for each other in a circle: " + circle +
                                              " after " + plan.jobs[at].name);
}

}  // namespace

Plan makePlan(const JobFile& file) {
    Plan plan;
    plan.path = file.path;
    plan.folder = folderOf(file.path);
    std::vector<std::string> patterns;
    std::vector<Draft> drafts = draftsOf(file, plan, patterns);
    PathTable table(plan);
    const auto inEach = [&](const auto& work) {
        for (std::size_t i = 0; i < drafts.size(); ++i) try {
                work(i, drafts[i]);
            } catch (const Error& error) {
                throw inJob(plan, drafts[i].job.name, error);
            }
    };
    inEach([&](std::size_t i, Draft& draft) {
        draft.job.arguments.check();
        checkFrames(draft.job.arguments, draft.job.command->inputsAreOutputs);
        draft.job.writes = writtenBy(draft.job);
        for (const std::string& path : draft.job.writes) table.addOutput(i, draft.job.name, path);
    });
    for (const std::string& pattern : patterns) table.refuseMatches(pattern);
    inEach([&](std::size_t i, Draft& draft) {
        draft.job.arguments.inputs = table.expanded(i, draft.job);
        draft.job.reads = readBy(draft.job);
        addAfter(drafts, draft);
        for (const std::string& path : draft.job.reads) {
            const long maker = table.makerOf(i, path);
            if (maker >= 0) draft.job.after.push_back(std::size_t(maker));
        }
        std::vector<std::size_t>& after = draft.job.after;
        std::sort(after.begin(), after.end());
        after.erase(std::unique(after.begin(), after.end()), after.end());
    });
    for (Draft& draft : drafts) plan.jobs.push_back(std::move(draft.job));
    refuseCircles(plan);
    return plan;
}

}  // namespace vdbsynth::cli::batch
