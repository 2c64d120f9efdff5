#include "tools/vdb_synth/describe/completion.h"
#include "tools/vdb_synth/describe/completion_steps.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/version.h"

namespace vdbsynth::cli {
namespace {

constexpr const char* kHelpers = R"script(
# The command of the line; none while it is being typed.
function __vdb_synth_command
    set -l words (commandline -opc)
    test (count $words) -gt 1; and echo $words[2]
end

function __vdb_synth_is
    test "$(__vdb_synth_command)" = $argv[1]
end

function __vdb_synth_none
    test -z "$(__vdb_synth_command)"
end

# True if the word at the cursor is an input of the command, by its number from FIRST to LAST.
function __vdb_synth_input --argument-names command first last
    __vdb_synth_is $command; or return 1
    set -l number 0
    set -l skip 0
    for word in (commandline -opc)[3..]
        if test $skip = 1
            set skip 0
        else if string match -q -- '-*' $word
            string match -q -- '*=*' $word; or contains -- $word (__vdb_synth_flags); or set skip 1
        else
            set number (math $number + 1)
        end
    end
    test $skip = 0; and test $number -ge $first; and test $number -le $last
end

# Files of the given endings, and folders on the way to them.
function __vdb_synth_files
    set -l typed (string replace -r -- '^--[^=]*=' '' (commandline -ct))
    for file in $typed*
        if test -d $file
            echo $file/
        else
            string match -qir -- "\.($argv[1])(\.gz)?\$" $file; and echo $file
        end
    end
end
)script";

// In single quotes fish knows \' and \\ only.
std::string fishQuoted(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "'";
}

// The end of a `complete` line for a value or an input.
std::string offers(const Suggestions& suggestions) {
    std::string list = joined(suggestions.words);
    if (!suggestions.extensions.empty())
        list += (list.empty() ? "" : " ") + std::string("(__vdb_synth_files \"") +
                joined(suggestions.extensions, "|") + "\")";
    if (suggestions.folders) list = "(__fish_complete_directories)";
    if (suggestions.anyFile) return list.empty() ? " -F" : " -F -a " + fishQuoted(list);
    return list.empty() ? " -f" : " -f -a " + fishQuoted(list);
}

std::string lineOf(const Command& command, const Option& option) {
    std::string text = "complete -c vdb_synth -n '__vdb_synth_is " + command.name + "' -l " + option.name;
    if (option.letter) text += std::string(" -s ") + option.letter;
    text += " -d " + fishQuoted(briefly(option.help));
    if (option.kind != Kind::Flag && !option.valueOptional) text += " -r";
    return text + (option.kind == Kind::Flag ? "" : offers(valuesOf(option))) + "\n";
}

std::string inputLines(const Command& command) {
    std::string text;
    const std::vector<Suggestions> inputs = inputsOf(command);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (inputs[i].empty()) continue;
        const std::size_t last = i + 1 < inputs.size() ? i : 1000000;
        text += "complete -c vdb_synth -n '__vdb_synth_input " + command.name + " " + std::to_string(i) +
                " " + std::to_string(last) + "'" + offers(inputs[i]) + "\n";
    }
    return text;
}

// Flags of the command of the line, which take no value.
std::string flagsFunction() {
    std::string text = "\nfunction __vdb_synth_flags\n    switch (__vdb_synth_command)\n";
    for (const Command* command : commands()) {
        text += "        case " + command->name + "\n            string split ' ' -- '";
        std::string names;
        for (const Option& option : optionsOf(command->name)) {
            if (option.kind != Kind::Flag && !option.valueOptional) continue;
            names += " --" + option.name + " -" + option.name;
            if (option.letter) names += std::string(" -") + option.letter;
        }
        text += names.substr(1) + "'\n";
    }
    return text + "        case help\n            echo --man\n    end\nend\n";
}

}  // namespace

std::string fishCompletion() {
    std::string text = "# fish completion for vdb_synth " + std::string(kVersion) +
                       ", made by vdb_synth completion fish\n" + kHelpers + flagsFunction() +
                       "\ncomplete -c vdb_synth -f\n";
    const std::string noCommand = "complete -c vdb_synth -n __vdb_synth_none";
    std::string names;
    for (const Command* command : commands()) {
        text += noCommand + " -a " + command->name + " -d " + fishQuoted(briefly(command->summary)) + "\n";
        names += (names.empty() ? "" : " ") + command->name;
    }
    for (const Extra& extra : extraCommands())
        text += noCommand + " -a " + extra.name + " -d " + fishQuoted(extra.summary) + "\n";
    text += noCommand + " -l help -s h -d 'List the commands'\n" + noCommand + " -l version -d 'Versions'\n";
    for (const Command* command : commands()) {
        for (const Option& option : optionsOf(command->name)) text += lineOf(*command, option);
        text += inputLines(*command);
    }
    text += "complete -c vdb_synth -n '__vdb_synth_is help' -l man -d 'Print the manual page'\n";
    text += "complete -c vdb_synth -n '__vdb_synth_input help 0 0' -a '" + names + "'\n";
    return text + "complete -c vdb_synth -n '__vdb_synth_input completion 0 0' -a '" + joined(shellNames()) +
           "'\n";
}

}  // namespace vdbsynth::cli
