#include "tools/vdb_synth/batch/slurm/slurm_commands.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"

using namespace vdbsynth;
using namespace vdbsynth::cli::batch;

TEST_CASE("readTasks: rows of squeue", "[tools]") {
    const SlurmTasks tasks = readTasks(
        "12|3|RUNNING|1-02:03:04|n[1-2]|None\n12|4|PENDING|0:00||Dependency\nslurm: a line of the site\n"
        "12|N/A|PENDING|0:00||None\n13|1|CANCELLED|0:00|(null)|DependencyNeverSatisfied\n");
    REQUIRE(tasks.size() == 3);
    const SlurmTask& running = tasks.at({"12", 3});
    CHECK(running.state == "RUNNING");
    CHECK(running.started);
    CHECK(running.seconds == 93784);
    CHECK_FALSE(tasks.at({"12", 4}).started);
    CHECK(tasks.at({"12", 4}).reason == "Dependency");
    CHECK_FALSE(tasks.at({"13", 1}).started);
    CHECK(readTasks("").empty());
}

TEST_CASE("readAccounts: rows of sacct", "[tools]") {
    const SlurmTasks tasks = readAccounts(
        "12_3|CANCELLED by 1000|00:00:07|n1\n12_[4-9]|PENDING|00:00:00|None assigned\n12_10|TIMEOUT|00:10:"
        "00|n2\n");
    REQUIRE(tasks.size() == 2);
    CHECK(tasks.at({"12", 3}).state == "CANCELLED");
    CHECK(tasks.at({"12", 3}).seconds == 7);
    CHECK(tasks.at({"12", 10}).seconds == 600);
}

TEST_CASE("isEndState, isRunState: a state is one of them or waits", "[tools]") {
    for (const char* state : {"COMPLETED", "FAILED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "CANCELLED"}) {
        CHECK(isEndState(state));
        CHECK_FALSE(isRunState(state));
    }
    for (const char* state : {"RUNNING", "COMPLETING", "SUSPENDED"}) {
        CHECK(isRunState(state));
        CHECK_FALSE(isEndState(state));
    }
    for (const char* state : {"PENDING", "CONFIGURING", "REQUEUED", "REQUEUE_HOLD", ""}) {
        CHECK_FALSE(isEndState(state));
        CHECK_FALSE(isRunState(state));
    }
}

TEST_CASE("sbatchArguments: words as a shell parts them", "[tools]") {
    CHECK(sbatchArguments("").empty());
    CHECK(sbatchArguments("  --account=show   -q night ") ==
          std::vector<std::string>{"--account=show", "-q", "night"});
    CHECK(sbatchArguments("--comment='two words' \"\" --x=\"it's\"") ==
          std::vector<std::string>{"--comment=two words", "", "--x=it's"});
    for (const char* text : {"--comment='a", "--array=1-3", "-d afterok:1", "--output x"})
        CHECK(test::thrownBy([&] { sbatchArguments(text); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("runCommand: streams, exit codes, a command that hangs", "[tools]") {
    const CommandOutput output = runCommand({"sh", "-c", "cat; echo wrong >&2; exit 3"}, "text", 20);
    CHECK(output.code == 3);
    CHECK(output.text == "text");
    CHECK(output.errors == "wrong\n");
    CHECK(runCommand({"sh", "-c", "yes | head -c 300000"}, "", 20).text.size() == 300000);
    CHECK(runCommand({"sh", "-c", "kill -9 $$"}, "", 20).code == 137);
    CHECK(runCommand({"no-such-command-at-all"}, "", 20).code == 127);
    CHECK(runCommand({"sleep", "20"}, "", 0.2).code == -1);
}
