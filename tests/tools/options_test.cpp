#include "tools/vdb_synth/options.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/makers.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/option_value.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

TEST_CASE("allOptions: a name is described once for a command, and commands exist", "[tools][property]") {
    for (const Option& option : allOptions()) {
        INFO(option.name);
        CHECK_FALSE(option.commands.empty());
        for (const std::string& command : option.commands) CHECK(findCommand(command) != nullptr);
        for (const Option::Change& change : option.changes)
            CHECK(std::count(option.commands.begin(), option.commands.end(), change.command) == 1);
    }
    for (const Command* command : commands()) {
        std::map<std::string, int> names;
        std::map<char, int> letters;
        for (const Option& option : optionsOf(command->name)) {
            INFO(command->name << " --" << option.name);
            CHECK(++names[option.name] == 1);
            if (option.letter) CHECK(++letters[option.letter] == 1);
        }
        CHECK(names.count("output") == 1);
    }
}

TEST_CASE("optionsOf: every option has help, a default its own check accepts, and a range",
          "[tools][property]") {
    for (const Command* command : commands())
        for (const Option& option : optionsOf(command->name)) {
            INFO(command->name << " --" << option.name << ": " << helpLine(option));
            CHECK(option.help.size() > 5);
            CHECK(option.help.back() != '.');
            CHECK(option.argument.empty() == (option.kind == Kind::Flag));
            if (!option.initial.empty()) {
                CHECK_NOTHROW(normalValue(option, option.initial));
                CHECK(test::contains(helpLine(option), option.initial));
                CHECK(option.otherwise.empty());
            }
            if (option.kind == Kind::Whole) {
                CHECK(option.low > -kUnbounded);
                CHECK(option.high < kUnbounded);
                CHECK(test::contains(helpLine(option), rangeText(option)));
            }
            if (option.kind == Kind::Choice || option.kind == Kind::AxisChoices)
                CHECK(option.choices.size() > 1);
            if (option.kind == Kind::File || option.kind == Kind::Grid) CHECK_FALSE(option.argument.empty());
        }
}

TEST_CASE("optionsOf: lengths say their unit", "[tools]") {
    for (const char* name :
         {"voxel-size", "half-width", "thickness", "height", "base", "pixel-size", "drift", "block"}) {
        const Option* option = findOption(
            std::string(name) == "drift" || std::string(name) == "block" ? "synth" : "convert", name);
        REQUIRE(option != nullptr);
        INFO(helpLine(*option));
        CHECK(
            (test::contains(helpLine(*option), "(voxels)") || test::contains(helpLine(*option), "(world)")));
    }
}

TEST_CASE("optionsOf: groups stand together, in the order of their headings", "[tools][property]") {
    for (const Command* command : commands()) {
        const std::vector<Option>& options = optionsOf(command->name);
        CHECK(std::is_sorted(options.begin(), options.end(),
                             [](const Option& a, const Option& b) { return a.group < b.group; }));
        CHECK(options.back().group == Group::Running);
    }
}

TEST_CASE("optionsOf: a command takes what it can use", "[tools]") {
    for (const char* name : {"labels", "height", "iso", "grid", "plane", "threshold", "source-map"})
        CHECK(findOption("make", name) == nullptr);
    CHECK(findOption("render", "seed") == nullptr);
    CHECK(findOption("info", "voxel-size") == nullptr);
    CHECK(findOption("match", "half-width") == nullptr);
    for (const char* command :
         {"convert", "crop", "mask", "match", "synth", "analogy", "texture", "repeat", "compare", "render"})
        for (const char* name : {"voxel-size", "labels", "iso", "open"})
            CHECK(findOption(command, name) != nullptr);
    for (const Command* command : commands())
        for (const char* name :
             {"threads", "report", "config", "max-memory", "progress", "quiet", "help", "force"})
            CHECK(findOption(command->name, name) != nullptr);
    CHECK(findOption("no-such-command", "threads") == nullptr);
}

TEST_CASE("optionsOf: what differs for a command holds for it alone", "[tools]") {
    CHECK(findOption("make", "resolution")->initial == "64");
    CHECK(findOption("make", "resolution")->low == 16);
    CHECK(findOption("convert", "resolution")->initial.empty());
    CHECK(findOption("analogy", "levels")->high == 6);
    CHECK(findOption("synth", "levels")->high == 8);
    CHECK(findOption("match", "block")->initial == "16");
    CHECK(findOption("synth", "block")->initial.empty());
}

TEST_CASE("inFlags: a field in backquotes becomes the flag of the running command", "[tools]") {
    CHECK(inFlags("`longestRun` 3: must be from 0.01 to 1", "synth") ==
          "--longest-run 3: must be from 0.01 to 1");
    CHECK(inFlags("use a smaller `size` or larger voxels", "synth") ==
          "use a smaller --size or larger voxels");
    CHECK(inFlags("`SynthOptions::exemplarMap` and `heights.pixelSize`", "synth") ==
          "--exemplar-map and --pixel-size");
    CHECK(inFlags("over `maxMemory`", "make") == "over --max-memory");
    CHECK(inFlags("with `imageAsVolume`", "convert") == "with --as volume");
    CHECK(inFlags("`half` 9: too large", "analogy") == "--samples 9: too large");
}

TEST_CASE("inFlags: a name that is no flag of the command loses its backquotes, other text stays",
          "[tools]") {
    CHECK(inFlags("`longestRun` 3", "make") == "longestRun 3");
    CHECK(inFlags("`noSuchField`", "synth") == "noSuchField");
    CHECK(inFlags("a`b c`d `size`", "synth") == "a`b c`d --size");
    CHECK(inFlags("one ` alone", "synth") == "one ` alone");
    CHECK(inFlags("", "synth").empty());
    CHECK(inFlags("``", "synth") == "``");
}

TEST_CASE("optionsOf: a field stands for one option of a command", "[tools][property]") {
    for (const Command* command : commands()) {
        std::map<std::string, std::string> owners;
        for (const Option& option : optionsOf(command->name)) {
            CHECK_FALSE(option.fields.empty());
            for (const std::string& field : option.fields) {
                INFO(command->name << " " << field << ": " << owners[field] << " and " << option.name);
                CHECK(owners[field].empty());
                owners[field] = option.name;
            }
        }
    }
}

TEST_CASE("unknownOption: an old name has a hint at the present one", "[tools][error]") {
    CHECK(unknownOption("synth", "which") == "--which: is now --exemplar-map");
    CHECK(unknownOption("synth", "which", "") == "which: is now exemplar-map");
    CHECK_FALSE(test::contains(unknownOption("make", "which"), "exemplar-map"));
}

TEST_CASE("unknownOption: of another command's option it says who takes it", "[tools][error]") {
    CHECK(unknownOption("make", "block") == "--block: is no option of make; match and synth take it");
    CHECK(unknownOption("synth", "strength") ==
          "--strength: is no option of synth; analogy, relief and relief-extract take it");
}

TEST_CASE("unknownOption: the nearest name is one of this command", "[tools][error]") {
    CHECK(test::contains(unknownOption("synth", "sise"), "did you mean --size?"));
    CHECK(test::contains(unknownOption("match", "cuont"), "did you mean --count?"));
    // analogy's --sweeps is nearer, but no option of make.
    CHECK_FALSE(test::contains(unknownOption("make", "sweep"), "sweeps"));
    CHECK(test::contains(unknownOption("make", "xyzzyxyzzy"), "vdb_synth make --help"));
}

TEST_CASE("nearestName: none where all are far", "[tools]") {
    CHECK(nearestName("blok", {"block", "box"}) == "block");
    CHECK(nearestName("elephant", {"block", "box"}).empty());
    CHECK(nearestName("a", {}).empty());
}

TEST_CASE("helpText: all options of a command and no other", "[tools][property]") {
    for (const Command* command : commands()) {
        const std::string text = helpText(*command);
        std::set<std::string> own;
        for (const Option& option : optionsOf(command->name)) own.insert(option.name);
        for (const Option& option : allOptions()) {
            INFO(command->name << " --" << option.name);
            const bool listed = test::contains(text, "  --" + option.name + " ") ||
                                test::contains(text, ", --" + option.name + " ") ||
                                test::contains(text, "  --" + option.name + "\n");
            CHECK(listed == (own.count(option.name) > 0));
        }
    }
}
