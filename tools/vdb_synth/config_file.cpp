// --config: options from a file or from the report of an earlier run.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "tools/vdb_synth/option_set.h"
#include "tools/vdb_synth/options.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

nlohmann::json readConfig(const std::string& path) {
    nlohmann::json json = nlohmann::json::parse(readWholeFile(path), nullptr, /* allow_exceptions= */ false);
    if (json.is_object() && json.contains("options")) json = json["options"];
    if (!json.is_object())
        throw Error(ErrorCode::BadData,
                    path + ": not a JSON object of options, such as the \"options\" of a --report");
    return json;
}

std::vector<std::string> valuesOf(const nlohmann::json& value) {
    std::vector<std::string> values;
    const auto add = [&values](const nlohmann::json& item) {
        values.push_back(item.is_string() ? item.get<std::string>() : item.dump());
    };
    if (value.is_null()) return values;
    if (!value.is_array()) add(value);
    if (value.is_array())
        for (const auto& item : value) add(item);
    return values;
}

}  // namespace

void mergeConfig(Arguments& arguments) {
    if (!arguments.has("config")) return;
    const std::string path = arguments.text("config");
    const nlohmann::json json = readConfig(path);
    for (const auto& [name, value] : json.items()) {
        const std::vector<std::string> values = valuesOf(value);
        if (name == "inputs") {
            if (arguments.inputs.empty()) arguments.inputs = values;
            continue;
        }
        const Option* option = findOption(arguments.command(), name);
        if (!option)
            throw Error(ErrorCode::InvalidOption, path + ": " + unknownOption(arguments.command(), name, ""));
        if (name == "help" || name == "version" || name == "config")
            throw Error(ErrorCode::InvalidOption, path + ": " + name + ": belongs on the command line");
        if (values.size() > 1 && !option->repeats)
            throw Error(ErrorCode::InvalidOption, path + ": \"" + name + "\" has several values");
        if (arguments.has(name) || values.empty()) continue;
        if (option->kind == Kind::Flag) {
            if (values[0] == "false") continue;
            if (values[0] != "true")
                throw Error(ErrorCode::InvalidOption,
                            path + ": " + name + " " + values[0] + ": must be true or false");
        }
        if (option->valueOptional && (values[0] == "true" || values[0] == "false")) {
            if (values[0] == "true") arguments.values[name] = {kNoValue};
            continue;
        }
        arguments.values[name] = values;
    }
}

}  // namespace vdbsynth::cli
