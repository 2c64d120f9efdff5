#include "tools/vdb_synth/option_set.h"

#include <catch2/catch.hpp>

#include <functional>

#include <unistd.h>

#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

namespace {

std::string refusalOf(const std::function<void()>& work) {
    const test::Thrown thrown = test::thrownBy(work);
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    return thrown.message;
}

}  // namespace

TEST_CASE("parseArguments: every spelling of an option is the same", "[tools]") {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"a.vdb", "--size", "2x,2x,1x", "-o", "b.vdb"},
          {"--size=2x,2x,1x", "-ob.vdb", "a.vdb"},
          {"-size", "2x,2x,1x", "a.vdb", "--output=b.vdb"}}) {
        const Arguments arguments = parseArguments("synth", words);
        CHECK(arguments.inputs == std::vector<std::string>{"a.vdb"});
        CHECK(arguments.all("output") == std::vector<std::string>{"b.vdb"});
        CHECK(arguments.text("size") == "2x,2x,1x");
        CHECK_NOTHROW(arguments.check());
    }
    CHECK(parseArguments("match", {"--at", "-5,0,7"}).wholeTriple("at").x == -5);
    CHECK(parseArguments("convert", {"-.obj", "-o", "-.ply"}).inputs == std::vector<std::string>{"-.obj"});
}

TEST_CASE("parseArguments: an option whose value may be left out", "[tools]") {
    CHECK(parseArguments("synth", {"--source-map", "a.vdb"}).text("source-map") == "a.vdb");
    const Arguments arguments = parseArguments("synth", {"--source-map", "--draft"});
    CHECK(arguments.text("source-map") == kNoValue);
    CHECK(arguments.has("draft"));
    CHECK_NOTHROW(arguments.check());
}

TEST_CASE("parseArguments: what is refused", "[tools][error]") {
    CHECK(refusalOf([] {
              parseArguments("make", {"--labels", "1"});
          }) ==
          "--labels: is no option of make; convert, crop, mask, match, synth, analogy, texture, repeat, "
          "compare, render, patch, relief and relief-extract take it");
    CHECK(refusalOf([] { parseArguments("synth", {"--which=a.vdb"}); }) == "--which: is now --exemplar-map");
    CHECK(test::contains(refusalOf([] {
                             parseArguments("synth", {"--sise", "1"});
                         }),
                         "did you mean --size?"));
    CHECK(test::contains(refusalOf([] { parseArguments("synth", {"--size"}); }), "--size: needs a value"));
    CHECK(refusalOf([] {
              parseArguments("synth", {"--size", "1,1,1", "--size", "1,1,1"});
          }) == "--size: given twice");
}

TEST_CASE("Arguments: a reader gives what was given, else the default, else nothing", "[tools]") {
    const Arguments none = parseArguments("synth", {});
    CHECK(none.whole("block") == 0);
    CHECK(none.real("longest-run") == 0.3);
    CHECK(none.real("half-width") == 3);
    CHECK(none.text("carry") == "all");
    CHECK(none.labels("labels").empty());
    CHECK_FALSE(none.has("half-width"));
    CHECK(none.takes("half-width"));
    CHECK_FALSE(none.takes("strength"));
    CHECK(none.text("strength").empty());
    const Arguments given =
        parseArguments("synth", {"--block", "8", "--size", "2x,64,1.5x", "--labels", "1,4-5", "--seed", "7",
                                 "--exemplar-box", "0,0,0,1,2,3"});
    CHECK(given.whole("block") == 8);
    CHECK(given.sizes("size")[0].multiple);
    CHECK_FALSE(given.sizes("size")[1].multiple);
    CHECK(given.sizes("size")[2].value == 1.5);
    CHECK(given.labels("labels") == std::vector<std::pair<double, double>>{{1, 1}, {4, 5}});
    CHECK(given.wide("seed") == 7);
    CHECK(given.box("exemplar-box")[5].value == 3);
    CHECK(parseArguments("render", {}).pixels("size") == std::array<int, 2>{800, 600});
    CHECK(parseArguments("render", {"--view", "1,-1.6,0.9"}).triple("view") ==
          std::array<double, 3>{1, -1.6, 0.9});
    CHECK(parseArguments("render", {"--slice", "x=0.25"}).slice("slice").axis == 0);
    CHECK(parseArguments("convert", {"--max-memory", "2M"}).wide("max-memory") == 2000000);
    CHECK(parseArguments("mask", {"--range", "-1,0.5"}).range("range") == std::pair<double, double>(-1, 0.5));
    CHECK(parseArguments("compare", {"--stationary", "xz"}).axes("stationary") ==
          std::array<bool, 3>{true, false, true});
}

TEST_CASE("Arguments: check refuses every bad value, read or not", "[tools][error]") {
    // --guide-weight is read with --guide only.
    CHECK(test::contains(refusalOf([] {
                             parseArguments("synth", {"--guide-weight", "0"}).check();
                         }),
                         "--guide-weight 0"));
    CHECK(test::contains(refusalOf([] {
                             parseArguments("match", {"-o", "old.txt"}).check();
                         }),
                         "--output old.txt"));
    CHECK(test::contains(
        refusalOf([] {
            parseArguments("synth", {"--exemplar-guide", "a.vdb", "--exemplar-guide", "b.png"}).check();
        }),
        "--exemplar-guide b.png"));
}

TEST_CASE("Arguments: metadata has defaults, no paths and nothing of how the run goes", "[tools][property]") {
    const Arguments arguments = parseArguments(
        "synth", {"/home/me/a.vdb", "-o",     "/tmp/b.vdb",       "--size",     "2.0x,1x,1x",
                  "--threads",      "3",      "--exemplar-guide", "/x/g.vdb:d", "--exemplar-guide",
                  "y/h.vdb",        "--keep", "/secret/k.ply",    "--report",   "/tmp/r.json",
                  "--index-cache",  "/tmp",   "--source-map",     "/tmp/m.vdb", "--draft",
                  "--seed",         "5"});
    const auto normal = arguments.normalised();
    for (const auto& [name, values] : normal)
        for (const std::string& value : values) {
            INFO(name);
            CHECK_FALSE(test::contains(value, "/"));
        }
    for (const char* name :
         {"output", "threads", "report", "index-cache", "source-map", "seed", "config", "quiet"})
        CHECK(normal.count(name) == 0);
    CHECK(normal.at("size").front() == "2x,1x,1x");
    CHECK(normal.at("drift").front() == "0");
    CHECK(normal.at("draft").front() == "true");
    CHECK(normal.at("exemplar-guide") == std::vector<std::string>{"g.vdb:d", "h.vdb"});
    CHECK(normal ==
          parseArguments("synth", {"--exemplar-guide", "g.vdb:d", "--exemplar-guide", "h.vdb", "--keep",
                                   "k.ply", "--draft", "--drift", "0", "--size", "2x,1x,1x"})
              .normalised());
}

TEST_CASE("mergeConfig: the command line wins, arrays and flags are taken", "[tools]") {
    const test::TemporaryFolder folder;
    folder.write(
        "c.json",
        R"({"options": {"inputs": ["a.vdb"], "block": 8, "levels": "2", "draft": true, "quiet": false,
                               "output": ["x.vdb", "y.vdb"], "drift": null}})");
    Arguments arguments = parseArguments("synth", {"--block", "12", "--config", folder.path("c.json")});
    mergeConfig(arguments);
    CHECK(arguments.whole("block") == 12);
    CHECK(arguments.whole("levels") == 2);
    CHECK(arguments.has("draft"));
    CHECK_FALSE(arguments.has("quiet"));
    CHECK_FALSE(arguments.has("drift"));
    CHECK(arguments.all("output").size() == 2);
    CHECK(arguments.inputs == std::vector<std::string>{"a.vdb"});
}

TEST_CASE("mergeConfig: what is refused names the file", "[tools][error]") {
    const test::TemporaryFolder folder;
    const auto refusal = [&](const std::string& json) {
        folder.write("c.json", json);
        Arguments arguments = parseArguments("synth", {"--config", folder.path("c.json")});
        return test::thrownBy([&] { mergeConfig(arguments); });
    };
    CHECK(test::contains(refusal(R"({"blok": 3})").message,
                         "c.json: blok: unknown option of synth; did you mean block?"));
    CHECK(test::contains(refusal(R"({"which": "a.vdb"})").message, "c.json: which: is now exemplar-map"));
    CHECK(test::contains(
        refusal(R"({"strength": 1})").message,
        "c.json: strength: is no option of synth; analogy, relief and relief-extract take it"));
    CHECK(test::contains(refusal(R"({"config": "d.json"})").message, "belongs on the command line"));
    CHECK(test::contains(refusal(R"({"block": [1, 2]})").message, "\"block\" has several values"));
    CHECK(test::contains(refusal(R"({"draft": "maybe"})").message, "must be true or false"));
    CHECK(refusal("[1, 2]").code == int(ErrorCode::BadData));
    CHECK(refusal("{").code == int(ErrorCode::BadData));
}

TEST_CASE("refuseOverwriting: an output that is an input, by any path, needs --force", "[tools][error]") {
    const test::TemporaryFolder folder;
    folder.write("a.vdb", "a");
    folder.write("g.vdb", "g");
    const std::string a = folder.path("a.vdb"), again = folder.path("./a.vdb"), g = folder.path("g.vdb");
    const auto check = [](const std::string& command, const std::vector<std::string>& words) {
        refuseOverwriting(parseArguments(command, words), command == "make");
    };
    CHECK(test::contains(refusalOf([&] {
                             check("convert", {a, "-o", again});
                         }),
                         "--output " + again + ": is the file of the input " + a));
    CHECK(test::contains(refusalOf([&] {
                             check("synth", {a, "-o", "new.vdb", "--source-map", again});
                         }),
                         "--source-map"));
    CHECK(test::contains(refusalOf([&] { check("synth", {a, "--guide", g + ":d", "-o", g}); }), "--guide"));
    CHECK(test::contains(refusalOf([&] {
                             check("convert", {a, "-o", "new.vdb", "--config", g, "--report", g});
                         }),
                         "--config"));
    CHECK(test::contains(refusalOf([&] { check("make", {"balls", g, "--config", g}); }), "--config"));
    CHECK_NOTHROW(check("convert", {a, "-o", again, "--force"}));
    CHECK_NOTHROW(check("convert", {a, "-o", g}));
    CHECK_NOTHROW(check("convert", {a, "-o", folder.path("new.vdb")}));
    CHECK_NOTHROW(check("convert", {"-.vdb", "-o", "-.vdb"}));
    CHECK_NOTHROW(check("synth", {a, "--source-map", "-o", g}));
    CHECK_NOTHROW(check("make", {"balls", g}));
}

TEST_CASE("refuseOverwriting: links lead to the same file", "[tools][error]") {
    const test::TemporaryFolder folder;
    folder.write("a.vdb", "a");
    const std::string a = folder.path("a.vdb"), link = folder.path("link.vdb"),
                      hard = folder.path("hard.vdb");
    REQUIRE(::symlink(a.c_str(), link.c_str()) == 0);
    REQUIRE(::link(a.c_str(), hard.c_str()) == 0);
    for (const std::string& other : {link, hard}) {
        CHECK(test::contains(refusalOf([&] {
                                 refuseOverwriting(parseArguments("convert", {a, "-o", other}), false);
                             }),
                             "--force"));
        CHECK(test::contains(refusalOf([&] {
                                 refuseOverwriting(parseArguments("convert", {other, "-o", a}), false);
                             }),
                             "--force"));
    }
}
