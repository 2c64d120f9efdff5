#include "tools/vdb_synth/describe/manual_page.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

TEST_CASE("roffText: nothing of a text is a request or an escape", "[tools]") {
    CHECK(roffText(".TH x") == "\\&.TH x");
    CHECK(roffText("'x'") == "\\&\\(aqx\\(aq");
    CHECK(roffText("a\n.b") == "a\n\\&.b");
    CHECK(roffText("a.b") == "a.b");
    CHECK(roffText("--size \\n") == "\\-\\-size \\en");
    CHECK(roffText("\"make\" 2^24") == "\\(dqmake\\(dq 2\\(ha24");
}

TEST_CASE("manualPage: every option of a command, in its groups", "[tools][property]") {
    for (const Command* command : commands()) {
        const std::string page = manualPage(*command);
        INFO(command->name);
        for (const char* part :
             {".TH ", ".SH NAME\n", ".SH SYNOPSIS\n", ".SH OPTIONS\n", ".SH EXIT STATUS\n"})
            CHECK(test::contains(page, part));
        for (const Option& option : optionsOf(command->name))
            CHECK(test::contains(page, "\\fB" + roffText("--" + option.name) + "\\fR"));
        CHECK(test::contains(page, "\n.SS Running\n"));
        CHECK_FALSE(test::contains(page, "\n\n"));
    }
}

TEST_CASE("manualPage: each form of a command stands on a line of its own", "[tools]") {
    const std::string page = manualPage(*findCommand("synth"));
    CHECK(test::contains(page,
                         "\\fBvdb_synth synth\\fR EXEMPLAR... \\-o OUT \\-\\-size X,Y,Z [options]\n.br\n"
                         "\\fBvdb_synth synth\\fR [EXEMPLAR] \\-\\-keep PARTIAL"));
    CHECK(test::contains(manualPage(*findCommand("patch")), "\\-\\-size X,Y | \\-\\-onto MODEL [options]\n"));
}

TEST_CASE("programManual: lists every command and refers to its page", "[tools]") {
    const std::string page = programManual();
    for (const Command* command : commands()) {
        INFO(command->name);
        CHECK(test::contains(page, ".TP\n\\fB" + roffText(command->name) + "\\fR\n"));
        CHECK(test::contains(page, "\\fB" + roffText("vdb_synth-" + command->name) + "\\fR(1)"));
    }
}
