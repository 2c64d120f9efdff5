#include "tools/vdb_synth/batch/job_schema.h"

#include "tools/vdb_synth/batch/job_file.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli::batch {
namespace {

Json withVariable(Json kinds) {
    kinds.push_back({{"type", "string"}, {"pattern", "\\$\\{"}});
    return {{"anyOf", kinds}};
}

Json valueSchema(const Option& option) {
    Json choices = Json::array();
    switch (option.kind) {
        case Kind::Flag:
            return withVariable(Json::array({{{"type", "boolean"}}}));
        case Kind::Choice:
            if (option.orExtension) return {{"type", "string"}};
            for (const Choice& choice : option.choices) choices.push_back(choice.word);
            return withVariable(Json::array({{{"enum", choices}}}));
        case Kind::Whole:
        case Kind::Real: {
            Json number{{"type", option.kind == Kind::Whole ? "integer" : "number"}};
            if (option.low > -kUnbounded && option.low != kAboveZero) number["minimum"] = option.low;
            if (option.low == kAboveZero) number["exclusiveMinimum"] = 0;
            if (option.high < kUnbounded) number["maximum"] = option.high;
            return withVariable(Json::array({number, {{"type", "string"}, {"pattern", "^[-+0-9.]"}}}));
        }
        default: {
            Json types = Json::array({"string", "number"});
            if (option.valueOptional) types.push_back("boolean");
            return {{"type", types}};
        }
    }
}

Json optionSchema(const Option& option) {
    Json value = valueSchema(option);
    if (option.repeats) value = {{"anyOf", Json::array({value, {{"type", "array"}, {"items", value}}})}};
    Json kinds = Json::array({value, {{"type", "null"}}});
    return {{"description", helpLine(option)}, {"anyOf", kinds}};
}

Json optionsSchema(const std::string& command) {
    Json properties = Json::object();
    for (const Option& option : optionsOf(command))
        if (whyNoJobOption(option.name).empty()) properties[option.name] = optionSchema(option);
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

Json words() {
    return {
        {"anyOf", Json::array({{{"type", "string"}}, {{"type", "array"}, {"items", {{"type", "string"}}}}})}};
}

Json described(Json schema, const std::string& text) {
    schema["description"] = text;
    return schema;
}

Json values() {
    const Json scalar{{"type", Json::array({"string", "number", "boolean"})}};
    return {{"additionalProperties",
             {{"anyOf", Json::array({scalar, {{"type", "array"}, {"items", scalar}, {"minItems", 1}}})}}},
            {"type", "object"}};
}

Json jobSchemaOf(const Json& names) {
    Json conditions = Json::array();
    for (const Json& name : names)
        conditions.push_back(
            {{"if", {{"properties", {{"command", {{"const", name}}}}}}},
             {"then",
              {{"properties", {{"options", {{"$ref", "#/definitions/" + name.get<std::string>()}}}}}}}});
    const Json properties{
        {"name", {{"type", "string"}, {"description", "names the job, its log and its report"}}},
        {"command", {{"enum", names}}},
        {"inputs",
         described(words(), "files; * ? [ ] match several; a file that another job writes is waited for")},
        {"output", described(words(), "files that the job writes")},
        {"options", {{"type", "object"}, {"description", "long options of the command"}}},
        {"after", described(words(), "names of jobs that must be done before")},
        {"matrix", described(values(), "a job for each combination of values; ${NAME} stands for a value")},
        {"frames",
         {{"type", Json::array({"string", "integer"})},
          {"description", "a job for each frame, such as 1-20; #### in paths stands for its number"}}}};
    return {{"type", "object"},
            {"properties", properties},
            {"required", Json::array({"name", "command"})},
            {"additionalProperties", false},
            {"allOf", conditions}};
}

}  // namespace

Json jobSchema() {
    Json names = Json::array(), definitions = Json::object();
    Json defaults{
        {"options", {{"type", "object"}, {"description", "for the jobs whose command takes the option"}}}};
    for (const std::string& name : jobCommands()) {
        names.push_back(name);
        definitions[name] = optionsSchema(name);
        defaults[name] = {{"$ref", "#/definitions/" + name}};
    }
    return {{"$schema", "http://json-schema.org/draft-07/schema#"},
            {"title", "Jobs of vdb_synth batch"},
            {"type", "object"},
            {"properties",
             {{"$schema", {{"type", "string"}}},
              {"variables", described(values(), "${NAME} in a job stands for the value")},
              {"defaults", {{"type", "object"}, {"properties", defaults}, {"additionalProperties", false}}},
              {"jobs", {{"type", "array"}, {"minItems", 1}, {"items", jobSchemaOf(names)}}}}},
            {"required", Json::array({"jobs"})},
            {"additionalProperties", false},
            {"definitions", definitions}};
}

}  // namespace vdbsynth::cli::batch
