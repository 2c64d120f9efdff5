#include "tools/vdb_synth/batch/job_file.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>

namespace vdbsynth::cli::batch {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

std::string hint(const std::string& word, const std::vector<std::string>& names) {
    const std::string near = nearestName(word, names);
    if (!near.empty()) return "; did you mean \"" + near + "\"?";
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return "; known are " + list;
}

void requireObject(const Json& json, const std::string& where) {
    if (!json.is_object()) refuse(where + ": must be an object, { \"key\": value }");
}

void requireKeys(const Json& json, const std::vector<std::string>& names, const std::string& where) {
    requireObject(json, where);
    for (const auto& [key, value] : json.items())
        if (std::find(names.begin(), names.end(), key) == names.end())
            refuse(where + ": \"" + key + "\": unknown key" + hint(key, names));
}

bool isScalar(const Json& json) {
    return json.is_string() || json.is_number() || json.is_boolean();
}

std::string wordIn(const Json& json, const std::string& key, const std::string& where) {
    if (!json.contains(key)) return "";
    if (!json[key].is_string() && !json[key].is_number())
        refuse(where + ": \"" + key + "\": must be a string");
    return textOf(json[key]);
}

std::vector<std::string> wordsIn(const Json& json, const std::string& key, const std::string& where) {
    std::vector<std::string> words;
    if (!json.contains(key)) return words;
    const Json& value = json[key];
    const auto add = [&](const Json& item) {
        if (!item.is_string() || item.get_ref<const std::string&>().empty())
            refuse(where + ": \"" + key + "\": must be a string or a list of strings");
        words.push_back(item.get<std::string>());
    };
    if (value.is_array())
        for (const Json& item : value) add(item);
    else
        add(value);
    return words;
}

void checkOptions(const Json& options, const std::string& command, const std::string& where) {
    requireObject(options, where + ": \"options\"");
    for (const auto& [name, value] : options.items()) {
        const std::string reason = whyNoJobOption(name);
        if (!reason.empty()) refuse(where + ": \"" + name + "\": no option of a job: " + reason);
        const Option* option = findOption(command, name);
        if (!option) refuse(where + ": " + unknownOption(command, name, ""));
        if (value.is_null()) continue;
        if (value.is_array()) {
            if (value.size() > 1 && !option->repeats)
                refuse(where + ": \"" + name +
                       "\": must have one value; several values of one option are a "
                       "string with commas");
            if (!std::all_of(value.begin(), value.end(), isScalar))
                refuse(where + ": \"" + name + "\": must be a list of strings or numbers");
        } else if (!isScalar(value)) {
            refuse(where + ": \"" + name + "\": must be a string, a number, true or false");
        }
    }
}

struct Defaults {
    Json all = Json::object();
    std::map<std::string, Json> byCommand;
};

// A default for all commands: at least one must take it.
void checkDefault(const std::string& name, const Json& value, const std::string& where) {
    std::vector<std::string> names;
    for (const std::string& command : jobCommands()) {
        if (findOption(command, name)) return checkOptions({{name, value}}, command, where);
        for (const Option& option : optionsOf(command)) names.push_back(option.name);
    }
    const std::string near = nearestName(name, names);
    refuse(where + ": \"" + name + "\": no command has this option" +
           (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

Defaults readDefaults(const Json& json, const std::string& path) {
    Defaults defaults;
    if (!json.contains("defaults")) return defaults;
    std::vector<std::string> names = jobCommands();
    names.insert(names.begin(), "options");
    const std::string where = path + ": \"defaults\"";
    requireKeys(json["defaults"], names, where);
    for (const auto& [key, options] : json["defaults"].items()) {
        if (key != "options") {
            checkOptions(options, key, where + ": \"" + key + "\"");
            defaults.byCommand[key] = options;
            continue;
        }
        requireObject(options, where + ": \"options\"");
        for (const auto& [name, value] : options.items()) checkDefault(name, value, where);
        defaults.all = options;
    }
    return defaults;
}

Json withDefaults(const Defaults& defaults, const std::string& command, const Json& own) {
    Json options = Json::object();
    for (const auto& [name, value] : defaults.all.items())
        if (findOption(command, name)) options[name] = value;
    const auto of = defaults.byCommand.find(command);
    if (of != defaults.byCommand.end()) options.update(of->second);
    options.update(own);
    return options;
}

JobEntry readEntry(const Json& json, const Defaults& defaults, const std::string& path, std::size_t number) {
    std::string where = path + ": job " + std::to_string(number);
    requireObject(json, where);
    JobEntry entry;
    entry.name = wordIn(json, "name", where);
    if (!entry.name.empty()) where = path + ": job " + entry.name;
    requireKeys(json, {"name", "command", "inputs", "output", "options", "after", "matrix", "frames"}, where);
    if (entry.name.empty()) refuse(where + ": \"name\": missing; every job needs one");
    entry.command = wordIn(json, "command", where);
    const std::vector<std::string> known = jobCommands();
    if (entry.command.empty()) refuse(where + ": \"command\": missing; one of vdb_synth --help");
    if (std::find(known.begin(), known.end(), entry.command) == known.end())
        refuse(where + ": \"command\": " + entry.command + ": unknown command" + hint(entry.command, known));
    entry.inputs = wordsIn(json, "inputs", where);
    entry.outputs = wordsIn(json, "output", where);
    entry.after = wordsIn(json, "after", where);
    entry.frames = wordIn(json, "frames", where);
    const Json own = json.value("options", Json::object());
    checkOptions(own, entry.command, where);
    entry.options = withDefaults(defaults, entry.command, own);
    if (json.contains("matrix")) entry.matrix = json["matrix"];
    requireObject(entry.matrix, where + ": \"matrix\"");
    return entry;
}

std::map<std::string, Json> readVariables(const Json& json, const std::string& path,
                                          const std::map<std::string, std::string>& set) {
    std::map<std::string, Json> values;
    const Json given = json.value("variables", Json::object());
    requireObject(given, path + ": \"variables\"");
    for (const auto& [name, value] : set) {
        if (!given.contains(name)) {
            std::vector<std::string> names;
            for (const auto& [known, ignored] : given.items()) names.push_back(known);
            refuse("--set " + name + ": " + path + " has no such variable" +
                   (names.empty() ? "" : hint(name, names)));
        }
    }
    for (const auto& [name, value] : given.items()) {
        const std::string where = path + ": variable " + name;
        const bool list = value.is_array() && std::all_of(value.begin(), value.end(), isScalar);
        if (!isScalar(value) && !list) refuse(where + ": must be a string, a number or a list of these");
        try {
            // One may use those before it.
            if (const auto own = set.find(name); own != set.end()) {
                values[name] = own->second;
            } else if (list) {
                Json words = Json::array();
                for (const Json& item : value) words.push_back(filledIn(textOf(item), values));
                values[name] = words;
            } else {
                values[name] = filledIn(textOf(value), values);
            }
        } catch (const Error& error) {
            refuse(where + ": " + error.what());
        }
    }
    return values;
}

}  // namespace

std::vector<std::string> jobCommands() {
    std::vector<std::string> names;
    for (const Command* command : commands())
        if (!command->runsOthers) names.push_back(command->name);
    return names;
}

std::string whyNoJobOption(const std::string& option) {
    if (option == "output") return "write it as the job's \"output\"";
    if (option == "report") return "every job has one in the folder of --logs";
    if (option == "config") return "write the options themselves into the job";
    if (option == "progress" || option == "no-supervisor") return "batch decides it";
    if (option == "help" || option == "version") return "belongs on the command line";
    return "";
}

std::string textOf(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

JobFile readJobFile(const std::string& path, const Json& json,
                    const std::map<std::string, std::string>& set) {
    requireKeys(json, {"variables", "defaults", "jobs", "$schema"}, path);
    JobFile file;
    file.path = path;
    file.variables = readVariables(json, path, set);
    const Defaults defaults = readDefaults(json, path);
    if (!json.contains("jobs") || !json["jobs"].is_array() || json["jobs"].empty())
        refuse(path + ": \"jobs\": must be a list of at least one job");
    std::size_t number = 0;
    for (const Json& entry : json["jobs"]) file.entries.push_back(readEntry(entry, defaults, path, ++number));
    return file;
}

}  // namespace vdbsynth::cli::batch
