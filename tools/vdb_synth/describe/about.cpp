#include "tools/vdb_synth/describe/about.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/describe/completion.h"
#include "tools/vdb_synth/describe/manual_page.h"
#include "tools/vdb_synth/doctor/doctor_report.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

std::vector<std::string> commandNames() {
    std::vector<std::string> names;
    for (const Command* command : commands()) names.push_back(command->name);
    return names;
}

std::string help(const std::vector<std::string>& words) {
    bool manual = false;
    const Command* command = nullptr;
    for (const std::string& word : words) {
        if (word == "--man") {
            manual = true;
        } else if (command || word.empty() || word[0] == '-') {
            refuse("help " + word + ": must be help [--man] [COMMAND]");
        } else if (command = findCommand(word); !command) {
            refuse("help " + notACommand(word, commandNames()));
        }
    }
    if (manual) return command ? manualPage(*command) : programManual();
    return command ? helpText(*command) : overview();
}

std::string completion(const std::vector<std::string>& words) {
    const std::string shell = words.size() == 1 ? words[0] : "";
    if (shell == "bash") return bashCompletion();
    if (shell == "zsh") return zshCompletion();
    if (shell == "fish") return fishCompletion();
    refuse("completion" + (words.empty() ? "" : " " + words[0]) + ": must be completion bash, zsh or fish");
}

}  // namespace

bool isAboutProgram(const std::string& name) {
    for (const char* known : {"help", "completion", "--help", "-help", "-h", "--version", "-version"})
        if (name == known) return true;
    return false;
}

std::string aboutProgram(const std::string& name, const std::vector<std::string>& words) {
    if (name == "completion") return completion(words);
    if (name == "help") return help(words);
    return name == "--version" || name == "-version" ? versionText() : overview();
}

std::string overview() {
    std::string text =
        "vdb_synth makes new geometry from examples.\n\nUsage: vdb_synth COMMAND INPUTS -o OUTPUT "
        "[options]\n\n";
    for (const Command* command : commands()) {
        std::string name = command->name;
        name.resize(16, ' ');  // the longest and two
        text += "  " + name + command->summary + "\n";
    }
    return text +
           "\nvdb_synth COMMAND --help lists its options. Exit codes: 0 done, 1 unusable input, 2 bad "
           "option, 3 bad file, 130 and 143 stopped.\nvdb_synth help --man COMMAND prints a manual page, "
           "vdb_synth completion bash|zsh|fish what completes its words in a shell.\n";
}

}  // namespace vdbsynth::cli
