#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace vdbsynth::cli {
namespace {

std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
            diagonal = above;
        }
    }
    return row[b.size()];
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::vector<Option> makeOptionsOf(const std::string& command) {
    std::vector<Option> options;
    for (const Option& entry : allOptions()) {
        if (!contains(entry.commands, command)) continue;
        options.push_back(entry);
        for (const Option::Change& change : entry.changes)
            if (change.command == command) change.apply(options.back());
    }
    std::stable_sort(options.begin(), options.end(),
                     [](const Option& a, const Option& b) { return a.group < b.group; });
    return options;
}

// "convert, crop and synth take it", empty if none does.
std::string takers(const std::string& name) {
    std::vector<std::string> commands;
    for (const Option& entry : allOptions())
        if (entry.name == name)
            for (const std::string& command : entry.commands) commands.push_back(command);
    std::string text;
    for (std::size_t i = 0; i < commands.size(); ++i)
        text += (i == 0 ? "" : i + 1 == commands.size() ? " and " : ", ") + commands[i];
    return text.empty() ? "" : text + (commands.size() == 1 ? " takes it" : " take it");
}

bool isName(const std::string& text) {
    return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
           std::all_of(text.begin(), text.end(), [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == ':' || c == '_';
           });
}

// The last part of `options.heights.pixelSize` and of `SynthOptions::size`.
std::string lastName(const std::string& field) {
    return field.substr(field.find_last_of(".:") + 1);
}

// " volume" for the field that `--as volume` sets.
std::string valueFor(const Option& option, const std::string& field) {
    const auto value = option.valueOf.find(lastName(field));
    return value == option.valueOf.end() ? "" : " " + value->second;
}

std::string flagOf(const std::string& field, const std::string& command) {
    for (const Option& option : optionsOf(command))
        if (contains(option.fields, lastName(field))) return "--" + option.name + valueFor(option, field);
    return field;
}

}  // namespace

const std::vector<Option>& allOptions() {
    static const std::vector<Option> all = [] {
        std::vector<Option> table;
        for (const auto& part : {methodOptionTable(), textureOptionTable(), patchOptionTable(),
                                 reliefOptionTable(), reliefExtractOptionTable(), renderOptionTable(),
                                 modelOptionTable(), batchOptionTable(), runningOptionTable()})
            table.insert(table.end(), part.begin(), part.end());
        return table;
    }();
    return all;
}

const std::vector<Option>& optionsOf(const std::string& command) {
    static const std::map<std::string, std::vector<Option>> byCommand = [] {
        std::map<std::string, std::vector<Option>> made;
        for (const Option& entry : allOptions())
            for (const std::string& name : entry.commands) made[name];
        for (auto& [name, options] : made) options = makeOptionsOf(name);
        return made;
    }();
    static const std::vector<Option> none;
    const auto it = byCommand.find(command);
    return it == byCommand.end() ? none : it->second;
}

const Option* findOption(const std::string& command, const std::string& name) {
    for (const Option& option : optionsOf(command))
        if (option.name == name) return &option;
    return nullptr;
}

std::string nearestName(const std::string& word, const std::vector<std::string>& names) {
    std::string best;
    std::size_t distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t d = editDistance(word, name);
        if (d < distance) {
            distance = d;
            best = name;
        }
    }
    return best;
}

std::string unknownOption(const std::string& command, const std::string& name, const std::string& dashes) {
    const std::string shown = dashes + name;
    std::vector<std::string> names;
    for (const Option& option : optionsOf(command)) {
        names.push_back(option.name);
        if (contains(option.oldNames, name)) return shown + ": is now " + dashes + option.name;
    }
    const std::string others = takers(name);
    if (!others.empty()) return shown + ": is no option of " + command + "; " + others;
    const std::string near = nearestName(name, names);
    return shown + ": unknown option of " + command +
           (near.empty() ? "; see vdb_synth " + command + " --help"
                         : "; did you mean " + dashes + near + "?");
}

std::string inFlags(const std::string& text, const std::string& command) {
    std::string result;
    std::size_t at = 0;
    for (;;) {
        const std::size_t open = text.find('`', at);
        const std::size_t close = open == std::string::npos ? open : text.find('`', open + 1);
        if (close == std::string::npos) return result + text.substr(at);
        const std::string field = text.substr(open + 1, close - open - 1);
        result += text.substr(at, open - at);
        if (isName(field)) {
            result += flagOf(field, command);
            at = close + 1;
        } else {
            result += '`';
            at = open + 1;
        }
    }
}

}  // namespace vdbsynth::cli
