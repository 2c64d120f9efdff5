#include "libvdbsynth/io/readers/text_scanner.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <catch2/catch.hpp>

#include <cmath>

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

TEST_CASE("TextScanner: lines end in LF, CR LF or CR", "[io][oracle]") {
    const std::string path = "f";
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        CAPTURE(end.size(), int(end[0]));
        const std::string text = "a 1" + end + "# note" + end + end + "b" + end + "c 2 rest" + end + "last";
        TextScanner scanner(path, text);
        CHECK(scanner.word() == "a");
        CHECK(scanner.wordOnLine() == "1");
        CHECK(scanner.wordOnLine().empty());
        CHECK(scanner.word() == "b");
        CHECK(scanner.line() == 4);
        CHECK(scanner.word() == "c");
        scanner.skipLine();
        CHECK(scanner.line() == 6);
        CHECK(scanner.word() == "last");
        CHECK(scanner.atEnd());
    }
}

TEST_CASE("TextScanner: the mark of UTF-8 is skipped, UTF-16 is named", "[io][error]") {
    const std::string path = "f", marked = "\xEF\xBB\xBFone";
    CHECK(TextScanner(path, marked).word() == "one");
    CHECK(TextScanner(path, "\xEF\xBB\xBF").atEnd());
    for (const char* text : {"\xFF\xFEo", "\xFE\xFF"})
        CHECK(test::contains(test::thrownBy([&] { TextScanner scanner(path, text); }).message,
                             "f:1: the text is UTF-16"));
}

TEST_CASE("TextScanner: numbers as other programs print them", "[io][oracle]") {
    const std::string path = "f", text = "1.5D+02 -2d0 1.#QNAN -1.#IND nan -inf d5 1.#note";
    TextScanner scanner(path, text);  // of which # begins comments
    CHECK(scanner.real() == 150);
    CHECK(scanner.anyReal() == -2);
    for (int i = 0; i < 3; ++i) CHECK(std::isnan(scanner.anyReal()));
    CHECK(std::isinf(scanner.anyReal()));
    CHECK(test::contains(test::thrownBy([&] { scanner.anyReal(); }).message, "\"d5\" is not a number"));
    CHECK(scanner.real() == 1);
    CHECK(scanner.atEnd());
    double value = 7;
    CHECK_FALSE(parseForeignReal("", value));
    CHECK_FALSE(parseForeignReal("D", value));
    CHECK_FALSE(parseForeignReal("#", value));
    CHECK(value == 7);
}

TEST_CASE("TextScanner: messages show no raw bytes of the file", "[io][error]") {
    const std::string path = "f", text = "\x01\xFF\x1B[2J";
    TextScanner scanner(path, text);
    CHECK(test::thrownBy([&] { scanner.real(); }).message == "f:1: \"???[2J\" is not a number");
}

TEST_CASE("readWholeFile: a missing file and a directory are named", "[io][error]") {
    const test::TemporaryFolder folder;
    CHECK(test::contains(test::thrownBy([&] { readWholeFile(folder.path("no.obj")); }).message,
                         "no.obj: no such file"));
    CHECK(test::contains(test::thrownBy([&] { readWholeFile("/tmp"); }).message, "is a directory"));
    CHECK(readWholeFile(folder.write("a", "12\n3")) == "12\n3");
}
