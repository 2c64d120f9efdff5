// The plan for people and programs.
#include "tools/vdb_synth/batch/job_plan.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

#include <cctype>

namespace vdbsynth::cli::batch {
namespace {

std::string quoted(const std::string& word) {
    bool plain = !word.empty();
    for (const char c : word)
        plain = plain && (std::isalnum(static_cast<unsigned char>(c)) ||
                          std::string("._-+=,@/:%").find(c) != std::string::npos);
    if (plain) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace

std::vector<std::string> wordsOf(const Job& job) {
    std::vector<std::string> words{job.command->name}, bare;
    for (const std::string& input : job.arguments.inputs)
        words.push_back(input[0] == '-' ? "./" + input : input);
    for (const auto& [name, values] : job.arguments.values)
        for (const std::string& value : values) {
            const Option* option = findOption(job.command->name, name);
            if (value == kNoValue || (option && option->kind == Kind::Flag))
                bare.push_back("--" + name);
            else
                words.push_back("--" + name + "=" + value);
        }
    // At the end: what follows an option without its value could be taken for it.
    words.insert(words.end(), bare.begin(), bare.end());
    return words;
}

std::string shellText(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word);
    return text;
}

std::string planText(const Plan& plan) {
    std::string text;
    for (const Job& job : plan.jobs) {
        if (!text.empty()) text += "\n";
        text += job.name + ": vdb_synth " + shellText(wordsOf(job));
        for (std::size_t i = 0; i < job.after.size(); ++i)
            text += (i == 0 ? "  # after " : ", ") + plan.jobs[job.after[i]].name;
    }
    return text;
}

Json planJson(const Plan& plan) {
    Json jobs = Json::array();
    for (const Job& job : plan.jobs) {
        Json after = Json::array();
        for (const std::size_t before : job.after) after.push_back(plan.jobs[before].name);
        jobs.push_back({{"name", job.name},
                        {"words", wordsOf(job)},
                        {"reads", job.reads},
                        {"writes", job.writes},
                        {"after", after}});
    }
    return {{"folder", plan.folder}, {"jobs", jobs}};
}

}  // namespace vdbsynth::cli::batch
