#include "tools/vdb_synth/doctor/doctor_report.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstdlib>

#include "tests/support/makers.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

namespace {

RunContext someContext() {
    RunContext context;
    context.threads = 3;
    context.maxMemory = 4000000000u;
    return context;
}

}  // namespace

TEST_CASE("doctorReport: threads and memory are those of the run", "[tools]") {
    const nlohmann::ordered_json report = doctorReport(someContext());
    CHECK(report.at("processor").at("threads") == 3);
    CHECK(report.at("memory").at("most_used") == 4000000000u);
    CHECK(report.at("memory").at("present").get<std::uint64_t>() > 0);
    CHECK(report.at("libraries").at(0).at("name") == "OpenVDB");
}

TEST_CASE("doctorText: every part of the report is a line", "[tools]") {
    const std::string text = doctorText(doctorReport(someContext()));
    for (const char* part :
         {"program ", "built ", "libraries ", "system ", "processor ", "memory ", "limits ",
          "temporary files ", "working folder ", "locale ", "terminal ", "note "})
        CHECK(test::contains("\n" + text, std::string("\n") + part));
    CHECK(test::contains(text, "threads used 3"));
    CHECK(test::contains(text, "used at most 4 GB"));
}

TEST_CASE("doctorReport: nothing of the environment but what it names", "[tools]") {
    ::setenv("VDBSYNTH_TEST_SECRET", "s3cr3t-of-the-environment", 1);
    CHECK_FALSE(test::contains(doctorReport(someContext()).dump(), "s3cr3t"));
    ::unsetenv("VDBSYNTH_TEST_SECRET");
}

TEST_CASE("doctorText: what may cause trouble is a note", "[tools]") {
    nlohmann::ordered_json report = doctorReport(someContext());
    report["notes"] = nlohmann::ordered_json::array();
    CHECK(test::contains(doctorText(report), "note            nothing here looks wrong\n"));
    report["notes"] = {"the disk sings"};
    CHECK(test::contains(doctorText(report), "note            the disk sings\n"));
    CHECK_FALSE(test::contains(doctorText(report), "nothing here looks wrong"));
}

TEST_CASE("versionText: the first line is the program's, each other one a library's", "[tools]") {
    const std::string text = versionText();
    CHECK(text.compare(0, 10, "vdb_synth ") == 0);
    CHECK(test::contains(text.substr(0, text.find('\n')), "(OpenVDB "));
    CHECK(test::contains(text, "\n  zlib "));
}
