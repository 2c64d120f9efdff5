#include "tools/vdb_synth/batch/job_file.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"
#include "tools/vdb_synth/batch/job_schema.h"
#include "tools/vdb_synth/options.h"

using namespace vdbsynth;
using namespace vdbsynth::cli::batch;

namespace {

JobFile fileOf(const std::string& text, const std::map<std::string, std::string>& set = {}) {
    return readJobFile("j.json", Json::parse(text), set);
}

std::string refusalOf(const std::string& text, const std::map<std::string, std::string>& set = {}) {
    const test::Thrown thrown = test::thrownBy([&] { fileOf(text, set); });
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    return thrown.message;
}

std::string filledText(const std::string& text) {
    return filledIn(text, {{"a", "x/y.tar.vdb"}, {"n", 3}, {"list", Json::array({"1"})}});
}

}  // namespace

TEST_CASE("readJobFile: defaults by command, own options first, null takes one away", "[tools]") {
    const JobFile file =
        fileOf(R"({"defaults": {"options": {"seed": 1, "block": 8}, "synth": {"block": 6, "draft": true}},
        "jobs": [{"name": "a", "command": "synth", "inputs": "a.vdb", "output": ["b.vdb"], "options": {"draft": null}},
                 {"name": "b", "command": "info", "inputs": ["a.vdb"]}]})");
    CHECK(file.entries[0].options == Json({{"seed", 1}, {"block", 6}, {"draft", nullptr}}));
    CHECK(file.entries[0].inputs == std::vector<std::string>{"a.vdb"});
    CHECK(file.entries[1].options.empty());
}

TEST_CASE("readJobFile: variables", "[tools]") {
    const std::string text =
        R"({"variables": {"root": "/a", "shots": ["${root}/1", 2]}, "jobs": [{"name": "a", "command": "info"}]})";
    CHECK(fileOf(text).variables.at("shots") == Json::array({"/a/1", "2"}));
    CHECK(fileOf(text, {{"root", "/b"}}).variables.at("shots") == Json::array({"/b/1", "2"}));
    CHECK(test::contains(refusalOf(text, {{"rot", "/b"}}), "did you mean \"root\"?"));
    CHECK(test::contains(refusalOf(R"({"variables": {"a": "${b}", "b": 1}, "jobs": []})"),
                         "${b}: unknown variable"));
    CHECK(
        test::contains(refusalOf(R"({"variables": {"a": {}}, "jobs": []})"), "variable a: must be a string"));
}

TEST_CASE("readJobFile: what is refused", "[tools][error]") {
    const auto job = [](const std::string& more) {
        return refusalOf(R"({"jobs": [{"name": "a", "command": "synth", )" + more + "}]}");
    };
    CHECK(test::contains(refusalOf("[]"), "j.json: must be an object"));
    CHECK(test::contains(refusalOf(R"({"jobs": [3]})"), "job 1: must be an object"));
    CHECK(test::contains(refusalOf(R"({"jobs": [{"command": "info"}]})"), "job 1: \"name\": missing"));
    CHECK(test::contains(refusalOf(R"({"jobs": [{"name": "a"}]})"), "job a: \"command\": missing"));
    CHECK(test::contains(job(R"("input": "x")"), "job a: \"input\": unknown key; did you mean \"inputs\"?"));
    CHECK(test::contains(job(R"("inputs": [1])"), "must be a string or a list of strings"));
    CHECK(test::contains(job(R"("options": {"sise": 1})"),
                         "sise: unknown option of synth; did you mean size?"));
    CHECK(test::contains(job(R"("options": {"output": "x"})"), "write it as the job's \"output\""));
    CHECK(test::contains(job(R"("options": {"size": {}})"), "must be a string, a number"));
    CHECK(test::contains(job(R"("options": {"carry": [[]]})"), "must"));
    CHECK(test::contains(job(R"("options": 3)"), "\"options\": must be an object"));
    CHECK(test::contains(job(R"("matrix": [])"), "\"matrix\": must be an object"));
    CHECK(test::contains(refusalOf(R"({"defaults": {"options": {"sed": 1}}, "jobs": []})"),
                         "did you mean \"seed\"?"));
    CHECK(test::contains(refusalOf(R"({"defaults": {"info": {"size": 1}}, "jobs": []})"),
                         "is no option of info"));
}

TEST_CASE("filledIn: variables and parts of paths", "[tools]") {
    CHECK(filledText("${n}-${a}") == "3-x/y.tar.vdb");
    CHECK(filledText("${a.stem} ${a.file} ${a.folder}") == "y.tar y.tar.vdb x");
    CHECK(filledText("$${n} $n {n}") == "${n} $n {n}");
    CHECK(filledText("") == "");
    CHECK(test::thrownBy([] { filledText(std::string("a\0b", 3)); }).code == int(ErrorCode::InvalidOption));
    for (const char* text : {"${m}", "${n", "${}", "${a.size}", "${list}"})
        CHECK(test::thrownBy([&] { filledText(text); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("jobSchema: every command and option that a job can have", "[tools][property]") {
    const Json schema = jobSchema();
    for (const std::string& command : jobCommands())
        for (const cli::Option& option : cli::optionsOf(command)) {
            INFO(command << " " << option.name);
            CHECK(schema["definitions"][command]["properties"].contains(option.name) ==
                  whyNoJobOption(option.name).empty());
        }
}
