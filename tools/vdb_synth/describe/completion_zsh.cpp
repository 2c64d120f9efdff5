#include "tools/vdb_synth/describe/completion.h"
#include "tools/vdb_synth/describe/completion_steps.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/version.h"

namespace vdbsynth::cli {
namespace {

// What does not depend on options; and the last part, which begins the work.
constexpr const char* kHelpers = R"script(
# Files of the given endings, and folders on the way to them.
_vdb_synth_files() {
    _files -g "(#i)*.($1)(|.gz)(-.)"
}

# One of some words, or a file.
_vdb_synth_either() {
    compadd -- ${=1}
    _vdb_synth_files $2
}
)script";

constexpr const char* kBody = R"script(
_vdb_synth() {
    local curcontext=$curcontext state line
    typeset -A opt_args
    _arguments -C '(- *)'{-h,--help}'[list the commands]' '(- *)--version[versions]' \
        '1: :_vdb_synth_commands' '*:: :->words'
    [[ $state == words ]] || return 0
    (( $+functions[_vdb_synth-$words[1]] )) && _vdb_synth-$words[1]
}

_vdb_synth "$@"
)script";

// In a specification of _arguments brackets, colons and backslashes have a meaning.
std::string specified(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
        safe += c;
    }
    return safe;
}

// After "MESSAGE:" of a specification: what completes the value.
std::string action(const Suggestions& suggestions) {
    const std::string words = specified(joined(suggestions.words));
    const std::string endings = joined(suggestions.extensions, "|");
    if (!suggestions.words.empty() && !suggestions.extensions.empty())
        return " _vdb_synth_either \"" + words + "\" \"" + endings + "\"";
    if (!suggestions.words.empty()) return "(" + words + ")";
    if (suggestions.anyFile) return "_files";
    if (suggestions.folders) return "_files -/";
    return endings.empty() ? " " : " _vdb_synth_files \"" + endings + "\"";
}

std::string specificationOf(const Option& option) {
    std::string value;
    if (option.kind != Kind::Flag)
        value =
            (option.valueOptional ? "::" : ":") + specified(option.argument) + ":" + action(valuesOf(option));
    const std::string rest = "[" + specified(briefly(option.help)) + "]" + value;
    const std::string name = "--" + option.name;
    if (!option.letter) return shellQuoted((option.repeats ? "*" : "") + name + rest);
    const std::string letter = std::string("-") + option.letter;
    const std::string before = option.repeats ? "*" : "(" + letter + " " + name + ")";
    return shellQuoted(before) + "{" + letter + "," + name + "}" + shellQuoted(rest);
}

std::string functionOf(const Command& command) {
    std::string text = "_vdb_synth-" + command.name + "() {\n    _arguments -s";
    for (const Option& option : optionsOf(command.name)) text += " \\\n        " + specificationOf(option);
    const std::vector<Suggestions> inputs = inputsOf(command);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        text += " \\\n        " + shellQuoted((i + 1 < inputs.size() ? std::to_string(i + 1) : "*") +
                                              ":input:" + action(inputs[i]));
    return text + "\n}\n\n";
}

}  // namespace

std::string zshCompletion() {
    std::string text = "#compdef vdb_synth\n# zsh completion for vdb_synth " + std::string(kVersion) +
                       ", made by vdb_synth completion zsh\n\n" + kHelpers +
                       "\n_vdb_synth_commands() {\n    local -a names\n    names=(\n";
    std::string names;
    for (const Command* command : commands()) {
        text += "        " + shellQuoted(command->name + ":" + briefly(command->summary)) + "\n";
        names += (names.empty() ? "" : " ") + command->name;
    }
    for (const Extra& extra : extraCommands())
        text += "        " + shellQuoted(std::string(extra.name) + ":" + extra.summary) + "\n";
    text += "    )\n    _describe command names\n}\n\n";
    for (const Command* command : commands()) text += functionOf(*command);
    text += "_vdb_synth-help() {\n    _arguments '--man[print the manual page]' '1:command:(" + names +
            ")'\n}\n\n";
    text += "_vdb_synth-completion() {\n    _arguments '1:shell:(" + joined(shellNames()) + ")'\n}\n";
    return text + kBody;
}

}  // namespace vdbsynth::cli
