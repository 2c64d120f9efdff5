#include "tools/vdb_synth/command.h"

#include <catch2/catch.hpp>

using namespace vdbsynth::cli;

TEST_CASE("notACommand: a command that the build leaves out is named with how to build it", "[tools]") {
    CHECK(notACommand("analogy", {"make", "synth"}, {"analogy", "patch"}) ==
          "analogy: this build leaves it out; build all commands with: cmake --preset release && cmake "
          "--build --preset release");
}

TEST_CASE("notACommand: any other word is unknown, with the nearest command", "[tools]") {
    CHECK(notACommand("sinth", {"make", "synth"}, {"analogy"}) ==
          "sinth: unknown command; did you mean synth?");
    CHECK(notACommand("xyzzyplugh", {"make", "synth"}, {"analogy"}) ==
          "xyzzyplugh: unknown command; see vdb_synth --help");
}

TEST_CASE("leftOutCommands: a build with tests leaves none out", "[tools]") {
    CHECK(leftOutCommands().empty());
    CHECK(commands().size() == 17);
}
