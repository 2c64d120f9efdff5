#include "libvdbsynth/io/readers/joined_lines.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("joinedLines: text without backslashes and CR stays", "[io][hand]") {
    for (const std::string text : {"", "v 1 2 3", "v 1 2 3\nf 1 2 3\n", "\n\n"})
        CHECK(joinedLines(text) == text);
}

TEST_CASE("joinedLines: line ends of all systems", "[io][hand]") {
    CHECK(joinedLines("v 1\rv 2\r\rf 1\r") == "v 1\nv 2\n\nf 1\n");
    CHECK(joinedLines("v 1\r\nv 2\r\n\r\nf 1") == "v 1\nv 2\n\nf 1");
    CHECK(joinedLines("v 1\r\r\nv 2\r\r\n") == "v 1\nv 2\n");
}

TEST_CASE("joinedLines: a backslash joins, and the lines behind keep their numbers", "[io][hand]") {
    CHECK(joinedLines("f 1 2 \\\n3\nv 1") == "f 1 2  3\n\nv 1");
    CHECK(joinedLines("f 1 \\\r\n2 \\  \r3\r\nv 1") == "f 1  2  3\n\n\nv 1");
    CHECK(joinedLines("\\\nf 1 2\n") == " f 1 2\n\n");
    CHECK(joinedLines("f\\\n1\n") == "f 1\n\n");
    CHECK(joinedLines("f 1\\") == "f 1 ");
    CHECK(joinedLines("f 1\\  ") == "f 1 ");
}

TEST_CASE("joinedLines: paths in comments and names keep their backslashes", "[io][hand]") {
    for (const std::string text : {"# C:\\models\\\nv 1\n", "  # \\\nv 1\n", "v 1 # \\\nv 2\n",
                                   "g a\\\nv 1\n", "MTLLIB C:\\a\\\nv 1\n", "o \\\nv 1\n", "f 1\\2\n"})
        CHECK(joinedLines(text) == text);
}

TEST_CASE("joinedLines: many backslashes take linear time", "[io][hostile]") {
    std::string text = "f";
    for (int i = 0; i < 500000; ++i) text += i % 2 ? "\\\n" : " \\\r";
    CHECK(joinedLines(text).size() == 1 + 250000 + 500000);
}
