#include "tools/vdb_synth/describe/suggestions.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/option_value.h"
#include "tools/vdb_synth/options.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

TEST_CASE("modelExtensions: those that loadModel reads, each once", "[tools][property]") {
    std::set<std::string> seen;
    for (const std::string& extension : modelExtensions()) {
        INFO(extension);
        CHECK(isModelPath("x." + extension));
        CHECK(isKnownExtension(extension));
        CHECK(seen.insert(extension).second);
    }
}

TEST_CASE("valuesOf: every word that is offered is accepted", "[tools][property]") {
    for (const Command* command : commands())
        for (const Option& option : optionsOf(command->name))
            for (const std::string& word : valuesOf(option).words) {
                INFO(command->name << " --" << option.name << " " << word);
                CHECK_NOTHROW(normalValue(option, word));
            }
}

TEST_CASE("valuesOf: every file that is offered has an accepted name", "[tools][property]") {
    for (const Command* command : commands())
        for (const Option& option : optionsOf(command->name))
            for (const std::string& extension : valuesOf(option).extensions) {
                INFO(command->name << " --" << option.name << " x." << extension);
                CHECK_NOTHROW(normalValue(option, "x." + extension));
            }
}

TEST_CASE("valuesOf: choices are all offered, numbers and flags offer nothing", "[tools]") {
    CHECK(valuesOf(*findOption("synth", "method")).words ==
          std::vector<std::string>{"default", "exact", "paper"});
    CHECK(valuesOf(*findOption("synth", "block")).empty());
    CHECK(valuesOf(*findOption("synth", "draft")).empty());
    CHECK(valuesOf(*findOption("synth", "index-cache")).folders);
    CHECK(valuesOf(*findOption("synth", "report")).anyFile);
    CHECK(valuesOf(*findOption("render", "output")).extensions ==
          std::vector<std::string>{"png", "html", "htm"});
    CHECK(valuesOf(*findOption("analogy", "direction")).words.size() > 5);
}

TEST_CASE("inputsOf: kinds, models, images and job files by position", "[tools]") {
    const auto words = inputsOf(*findCommand("make")).front().words;
    CHECK(std::count(words.begin(), words.end(), "grid") == 1);
    CHECK(std::count(words.begin(), words.end(), "grooves") == 1);
    CHECK(inputsOf(*findCommand("mask")).front().words.size() == 4);
    CHECK(inputsOf(*findCommand("synth")).front().extensions == modelExtensions());
    CHECK(inputsOf(*findCommand("batch")).front().extensions.front() == "json");
    CHECK(inputsOf(*findCommand("doctor")).empty());
}
