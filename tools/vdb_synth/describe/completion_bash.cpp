#include "tools/vdb_synth/describe/completion.h"
#include "tools/vdb_synth/describe/completion_steps.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/version.h"

#include <map>

namespace vdbsynth::cli {
namespace {

// The part that does not depend on options. `_vdb_synth_place COMMAND PLACE` sets words, endings and folders
// for the value of an option (PLACE is its name) or for an input (its number), and gives false for a flag.
constexpr const char* kBody = R"script(
# Adds the files of the given endings, and folders on the way to them, as bash shows names.
_vdb_synth_files() {
    local name lower ending
    compopt -o filenames 2>/dev/null
    while IFS= read -r name; do
        lower=${name,,}
        lower=${lower%.gz}
        if [[ -d $name ]]; then
            COMPREPLY+=("$name")
        else
            for ending in "${endings[@]}"; do
                [[ $ending == '*' || $lower == *."$ending" ]] && { COMPREPLY+=("$name"); break; }
            done
        fi
    done < <(compgen -f -- "$1")
}

# Bash cuts words at = and :, of which a value such as axis:x and --method=exact are one to the program.
_vdb_synth_words() {
    local i word joins=0
    typed=()
    for ((i = 0; i <= COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        if [[ $word == [=:]* && $i -gt 0 ]]; then
            typed[-1]+=$word
            joins=1
        elif [[ $joins == 1 ]]; then
            typed[-1]+=$word
            joins=0
        else
            typed+=("$word")
        fi
    done
}

_vdb_synth() {
    local typed words='' endings=() folders='' command current before value cut number=0 i
    COMPREPLY=()
    _vdb_synth_words
    current=${typed[-1]} command=${typed[1]}
    if ((${#typed[@]} <= 2)); then
        mapfile -t COMPREPLY < <(compgen -W "$_vdb_synth_commands --help --version" -- "$current")
        return
    fi
    before=${typed[-2]} value=$current
    for ((i = 2; i < ${#typed[@]} - 1; i++)); do
        if [[ ${typed[i]} != -* || ${typed[i]} == -.* ]]; then
            ((number += 1))
        elif [[ ${typed[i]} != *=* ]] && _vdb_synth_place "$command" "${typed[i]}"; then
            ((i += 1))
        fi
    done
    words='' endings=() folders=''
    if [[ $current == --*=* ]]; then
        value=${current#*=}
        _vdb_synth_place "$command" "${current%%=*}" || return
    elif [[ $before == -* && $before != *=* ]] && _vdb_synth_place "$command" "$before"; then
        :
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_vdb_synth_options "$command")" -- "$current")
        return
    else
        _vdb_synth_place "$command" "$number"
    fi
    [[ $words ]] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$value")
    # What bash holds for the word begins behind its last = or :.
    if [[ $value == *:* && $COMP_WORDBREAKS == *:* ]]; then
        cut=${value%"${value##*:}"}
        COMPREPLY=("${COMPREPLY[@]#"$cut"}")
    elif ((${#endings[@]})); then
        _vdb_synth_files "$value"
    elif [[ $folders ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -d -- "$value")
    fi
    if [[ $current == --*=* && $COMP_WORDBREAKS != *=* ]]; then
        COMPREPLY=("${COMPREPLY[@]/#/${current%%=*}=}")
    fi
}

complete -F _vdb_synth vdb_synth
)script";

std::string assignments(const Suggestions& suggestions) {
    std::string text;
    if (!suggestions.words.empty()) text += " words=" + shellQuoted(joined(suggestions.words));
    if (suggestions.anyFile)
        text += " endings=('*')";
    else if (!suggestions.extensions.empty())
        text += " endings=(" + joined(suggestions.extensions) + ")";
    if (suggestions.folders) text += " folders=1";
    return text.empty() ? " :" : text;
}

std::string patternOf(const std::string& command, const Option& option) {
    std::string pattern = shellQuoted(command + " --" + option.name);
    // Of a long name one dash is enough.
    pattern += "|" + shellQuoted(command + " -" + option.name);
    if (option.letter) pattern += "|" + shellQuoted(command + " -" + option.letter);
    return pattern;
}

// Options that suggest the same share a line.
std::string placesOf(const Command& command) {
    std::map<std::string, std::string> lines;
    for (const Option& option : optionsOf(command.name)) {
        if (option.kind == Kind::Flag) continue;
        std::string& patterns = lines[assignments(valuesOf(option))];
        patterns += (patterns.empty() ? "" : "|") + patternOf(command.name, option);
    }
    std::string text;
    for (const auto& [values, patterns] : lines) text += "        " + patterns + ")" + values + " ;;\n";
    const std::vector<Suggestions> inputs = inputsOf(command);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const std::string pattern = i + 1 < inputs.size()
                                        ? shellQuoted(command.name + " " + std::to_string(i))
                                        : shellQuoted(command.name + " ") + "[0-9]*";
        text += "        " + pattern + ")" + assignments(inputs[i]) + " ;;\n";
    }
    return text;
}

std::string allNames() {
    std::vector<std::string> names;
    for (const Command* command : commands()) names.push_back(command->name);
    return joined(names);
}

}  // namespace

std::string bashCompletion() {
    std::string text = "# bash completion for vdb_synth " + std::string(kVersion) +
                       ", made by vdb_synth completion bash\n\n_vdb_synth_commands='" + allNames();
    for (const Extra& extra : extraCommands()) text += std::string(" ") + extra.name;
    text += "'\n\n_vdb_synth_options() {\n    case $1 in\n";
    for (const Command* command : commands()) {
        std::string names;
        for (const Option& option : optionsOf(command->name)) names += " --" + option.name;
        text += "        " + command->name + ") echo '" + names.substr(1) + "' ;;\n";
    }
    text += "        help) echo '--man' ;;\n    esac\n}\n\n_vdb_synth_place() {\n    case \"$1 $2\" in\n";
    for (const Command* command : commands()) text += placesOf(*command);
    text += "        'help '[0-9]*) words='" + allNames() + "' ;;\n";
    text += "        'completion 0') words='" + joined(shellNames()) + "' ;;\n";
    return text + "        *) return 1 ;;\n    esac\n}\n" + kBody;
}

}  // namespace vdbsynth::cli
