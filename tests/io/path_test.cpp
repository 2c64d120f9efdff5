#include "libvdbsynth/io/path.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("extensionOf, fileNameOf, folderOf: the usual and the odd paths", "[io][fast]") {
    CHECK(extensionOf("a/b.VDB") == "vdb");
    CHECK(extensionOf("a.b/c") == "");
    CHECK(extensionOf(".hidden") == "");
    CHECK(extensionOf("x.tar.gz") == "gz");
    CHECK(fileNameOf("/a/b c.obj") == "b c.obj");
    CHECK(fileNameOf("plain") == "plain");
    CHECK(folderOf("/a") == "/");
    CHECK(folderOf("a/b/c") == "a/b");
    CHECK(folderOf("c") == ".");
}

TEST_CASE("pathBelow: beside and below a folder, nowhere else", "[io]") {
    const auto named = [](const std::string& name) {
        std::string problem;
        const std::string path = pathBelow("assets", name, problem);
        return problem.empty() ? path : "refused: " + problem;
    };
    CHECK(named("a.bin") == "assets/a.bin");
    CHECK(named("./b/../c/a b.bin") == "assets/c/a b.bin");
    for (const char* name : {"../a.bin", "b/../../a.bin", "/etc/passwd"})
        CHECK(named(name).find("refused: is outside") == 0);
    CHECK(named("http://example.org/a.bin").find("refused: is an address") == 0);
    CHECK(named(std::string("a\0b", 3)).find("refused: is not a valid") == 0);
}
