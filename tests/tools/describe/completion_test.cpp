#include "tools/vdb_synth/describe/completion.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/describe/completion_steps.h"
#include "tools/vdb_synth/options.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

// That the scripts complete is tested in their shells, tests/cli/about_test.py.

TEST_CASE("completion: every command and option is in every script", "[tools][property]") {
    const std::string bash = bashCompletion(), zsh = zshCompletion(), fish = fishCompletion();
    for (const Command* command : commands())
        for (const Option& option : optionsOf(command->name)) {
            INFO(command->name << " --" << option.name);
            CHECK(test::contains(bash, " --" + option.name));
            CHECK(test::contains(zsh, "--" + option.name));
            CHECK(test::contains(fish, "'__vdb_synth_is " + command->name + "' -l " + option.name + " "));
        }
}

TEST_CASE("shellQuoted: a quote is closed, escaped and opened", "[tools]") {
    CHECK(shellQuoted("a b") == "'a b'");
    CHECK(shellQuoted("it's") == "'it'\\''s'");
    CHECK(shellQuoted("") == "''");
}

TEST_CASE("briefly: the first part, cut between words", "[tools]") {
    CHECK(briefly("number of threads; more") == "number of threads");
    CHECK(briefly("file to write: .vdb, .obj") == "file to write");
    const std::string cut = briefly(std::string(40, 'a') + " " + std::string(40, 'b'));
    CHECK(cut == std::string(40, 'a') + " ...");
}

TEST_CASE("joined: with what stands between", "[tools]") {
    CHECK(joined({"a", "b"}) == "a b");
    CHECK(joined({"a", "b"}, "|") == "a|b");
    CHECK(joined({}).empty());
}
