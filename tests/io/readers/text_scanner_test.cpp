#include "libvdbsynth/io/readers/text_scanner.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("TextScanner: words, lines, comments and numbers", "[io][fast]") {
    const std::string path = "f", text = "one # note\n\n two\t-3 4.5e1\r\nlast";
    TextScanner scanner(path, text);
    CHECK(scanner.word() == "one");
    CHECK(scanner.wordOnLine().empty());
    CHECK(scanner.word() == "two");
    CHECK(scanner.whole() == -3);
    CHECK(scanner.real() == 45.f);
    CHECK(scanner.line() == 3);
    CHECK(scanner.word() == "last");
    CHECK(scanner.atEnd());
    CHECK(test::contains(test::thrownBy([&] { scanner.real(); }).message, "f:4: the file ends"));
}

TEST_CASE("TextScanner: zero bytes neither end it nor hang it", "[io][degenerate]") {
    const std::string path = "f", text("a\0b \0 c", 7);
    TextScanner scanner(path, text);
    int words = 0;
    while (!scanner.atEnd() && words < 10) {
        CHECK_FALSE(scanner.word().empty());
        ++words;
    }
    CHECK(words == 3);
}

TEST_CASE("TextScanner: tiny numbers become zero, what is not finite or no number is named", "[io][error]") {
    const std::string path = "f", text = "1e-400 1e400 nan 1.5x 3000000000000000000000 7.5";
    TextScanner scanner(path, text);
    CHECK(scanner.real() == 0);
    CHECK(test::contains(test::thrownBy([&] { scanner.real(); }).message, "not a finite number"));
    CHECK(test::contains(test::thrownBy([&] { scanner.real(); }).message, "not a finite number"));
    CHECK(test::contains(test::thrownBy([&] { scanner.real(); }).message, "\"1.5x\" is not a number"));
    CHECK(test::contains(test::thrownBy([&] { scanner.whole(); }).message, "is not a whole number"));
    CHECK(test::contains(test::thrownBy([&] { scanner.whole(); }).message, "\"7.5\" is not a whole number"));
}

TEST_CASE("readWholeFile: a missing file and a directory are named", "[io][error]") {
    const test::TemporaryFolder folder;
    CHECK(test::contains(test::thrownBy([&] { readWholeFile(folder.path("no.obj")); }).message,
                         "no.obj: no such file"));
    CHECK(test::contains(test::thrownBy([&] { readWholeFile("/tmp"); }).message, "is a directory"));
    CHECK(readWholeFile(folder.write("a", "12\n3")) == "12\n3");
}
