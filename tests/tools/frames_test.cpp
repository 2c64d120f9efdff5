#include "tools/vdb_synth/frames.h"

#include "tests/support/makers.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;
using namespace vdbsynth::cli;

namespace {

std::vector<int> framesOf(const std::string& text) {
    std::vector<int> frames;
    REQUIRE(readFrames(text, frames));
    return frames;
}

Arguments argumentsOf(const std::vector<std::string>& words) {
    return parseArguments("convert", words);
}

std::string refusalOf(const std::vector<std::string>& words) {
    return test::thrownBy([&] { checkFrames(argumentsOf(words), false); }).message;
}

}  // namespace

TEST_CASE("readFrames: single ones, ranges and steps, in the order given", "[tools]") {
    CHECK(framesOf("7") == std::vector<int>{7});
    CHECK(framesOf("1-4") == std::vector<int>{1, 2, 3, 4});
    CHECK(framesOf("1-8x3") == std::vector<int>{1, 4, 7});
    CHECK(framesOf("10,1-2,0") == std::vector<int>{10, 1, 2, 0});
    std::vector<int> frames;
    for (const char* text :
         {"", "a", "-1", "1-", "4-1", "1-4x0", "1-4x", "1,,2", "1-4-6", "1.5", "12345678", "0-100000"})
        CHECK_FALSE(readFrames(text, frames));
}

TEST_CASE("atFrame: of arguments every path, and nothing else", "[tools]") {
    const Arguments given = parseArguments("analogy", {"a.vdb", "b.vdb", "shot.##.obj", "-o", "out.##.vdb",
                                                       "--mask", "m.##.vdb:mask", "--report", "r##.json"});
    const Arguments second = atFrame(given, 2);
    CHECK(second.inputs == std::vector<std::string>{"a.vdb", "b.vdb", "shot.02.obj"});
    CHECK(second.text("output") == "out.02.vdb");
    CHECK(second.text("mask") == "m.02.vdb:mask");
    CHECK(second.text("report") == "r02.json");
    const FrameCache cache(given);
    CHECK(cache.isShared("a.vdb"));
    CHECK_FALSE(cache.isShared("shot.02.obj"));
}

TEST_CASE("checkFrames: what it refuses", "[tools][error]") {
    CHECK_NOTHROW(checkFrames(argumentsOf({"a.##.obj", "-o", "b.##.vdb", "--frames", "1-3"}), false));
    CHECK_NOTHROW(checkFrames(argumentsOf({"a.##.obj", "-o", "b.vdb", "--frames", "2"}), false));
    CHECK_NOTHROW(checkFrames(argumentsOf({"a.#1.obj", "-o", "b.vdb"}), false));
    CHECK(test::contains(refusalOf({"a.##.obj", "-o", "b.vdb", "--frames", "1-3"}),
                         "b.vdb: every frame would replace it"));
    CHECK(test::contains(refusalOf({"a.obj", "-o", "b.vdb", "--frames", "2"}),
                         "--frames: no file names frames"));
    CHECK(test::contains(refusalOf({"a.obj", "-o", "b.##.vdb"}), "add --frames"));
}

TEST_CASE("FrameCache: made once for a name", "[tools]") {
    FrameCache cache(argumentsOf({"a.obj", "-o", "b.##.vdb"}));
    int made = 0;
    const std::function<std::shared_ptr<int>()> make = [&] { return std::make_shared<int>(++made); };
    CHECK(*cache.kept<int>("one", make) == 1);
    CHECK(*cache.kept<int>("one", make) == 1);
    CHECK(*cache.kept<int>("two", make) == 2);
}
