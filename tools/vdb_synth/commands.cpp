#include "tools/vdb_synth/command.h"

#include "tools/vdb_synth/chosen_commands.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>

namespace vdbsynth::cli {

const std::vector<const Command*>& commands() {
    static const std::vector<const Command*> all{VDBSYNTH_COMMAND_VARIABLES};
    return all;
}

const Command* findCommand(const std::string& name) {
    for (const Command* command : commands())
        if (command->name == name) return command;
    return nullptr;
}

const std::vector<std::string>& leftOutCommands() {
    static const std::vector<std::string> names{VDBSYNTH_LEFT_OUT_NAMES};
    return names;
}

std::string notACommand(const std::string& name, const std::vector<std::string>& candidates,
                        const std::vector<std::string>& leftOut) {
    if (std::find(leftOut.begin(), leftOut.end(), name) != leftOut.end())
        return name +
               ": this build leaves it out; build all commands with: cmake --preset release && cmake --build "
               "--preset release";
    const std::string near = nearestName(name, candidates);
    return name + ": unknown command" +
           (near.empty() ? "; see vdb_synth --help" : "; did you mean " + near + "?");
}

}  // namespace vdbsynth::cli
