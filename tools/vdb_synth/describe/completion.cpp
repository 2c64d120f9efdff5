#include "tools/vdb_synth/describe/completion.h"

#include "tools/vdb_synth/describe/completion_steps.h"

namespace vdbsynth::cli {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
    return text;
}

std::string shellQuoted(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string briefly(const std::string& help) {
    constexpr std::size_t kMost = 70;  // what fits beside an option
    std::string text = help.substr(0, help.find_first_of(";:"));
    if (text.size() <= kMost) return text;
    text.resize(text.rfind(' ', kMost));
    return text + " ...";
}

const std::vector<Extra>& extraCommands() {
    static const std::vector<Extra> all{{"help", "Print the help or the manual page of a command"},
                                        {"completion", "Print a script that completes words in a shell"}};
    return all;
}

const std::vector<std::string>& shellNames() {
    static const std::vector<std::string> names{"bash", "zsh", "fish"};
    return names;
}

}  // namespace vdbsynth::cli
