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
