#include "tools/vdb_synth/describe/about.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/describe/completion.h"
#include "tools/vdb_synth/describe/manual_page.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

TEST_CASE("aboutProgram: help of all, of one command, and as manual pages", "[tools]") {
    CHECK(aboutProgram("--help", {}) == overview());
    CHECK(aboutProgram("help", {}) == overview());
    CHECK(aboutProgram("help", {"synth"}) == helpText(*findCommand("synth")));
    CHECK(aboutProgram("help", {"--man"}) == programManual());
    CHECK(aboutProgram("help", {"--man", "synth"}) == manualPage(*findCommand("synth")));
    CHECK(aboutProgram("help", {"synth", "--man"}) == manualPage(*findCommand("synth")));
    CHECK(aboutProgram("completion", {"bash"}) == bashCompletion());
    CHECK(aboutProgram("completion", {"fish"}) == fishCompletion());
}

TEST_CASE("aboutProgram: what is refused", "[tools][error]") {
    const auto refusal = [](const std::string& name, const std::vector<std::string>& words) {
        const test::Thrown thrown = test::thrownBy([&] { aboutProgram(name, words); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        return thrown.message;
    };
    CHECK(refusal("completion", {}) == "completion: must be completion bash, zsh or fish");
    CHECK(refusal("completion", {"tcsh"}) == "completion tcsh: must be completion bash, zsh or fish");
    CHECK(refusal("help", {"sinth"}) == "help sinth: unknown command; did you mean synth?");
    CHECK(refusal("help", {"--mann"}) == "help --mann: must be help [--man] [COMMAND]");
    CHECK(refusal("help", {"synth", "make"}) == "help make: must be help [--man] [COMMAND]");
}

TEST_CASE("isAboutProgram: no command is taken for it", "[tools]") {
    for (const Command* command : commands()) CHECK_FALSE(isAboutProgram(command->name));
    CHECK(isAboutProgram("--version"));
    CHECK_FALSE(isAboutProgram(""));
}
