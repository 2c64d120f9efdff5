#include "libvdbsynth/io/text_scanner.h"
#include "libvdbsynth/io/whole_file.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>

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

TEST_CASE("parseReal: finite numbers, tiny ones become zero, words are refused", "[io][fast]") {
    float value = 7;
    CHECK((parseReal("+1.5", value) && value == 1.5f));
    CHECK((parseReal("1e-60", value) && value == 0.f));
    CHECK((parseReal("1e60", value) && std::isinf(value)));
    CHECK_FALSE(parseReal("1.5x", value));
    CHECK_FALSE(parseReal("", value));
}

TEST_CASE("appendReal: every float reads back to the same bits", "[io][property]") {
    for (int i = 0; i < 5000; ++i) {
        const std::uint32_t bits = Random(3, std::uint64_t(i)).bits();
        float value, back;
        std::memcpy(&value, &bits, 4);
        if (!std::isfinite(value)) continue;
        std::string text;
        appendReal(text, value);
        REQUIRE(parseReal(text, back));
        if (std::abs(value) >= std::numeric_limits<float>::min()) REQUIRE(back == value);
    }
}

TEST_CASE("readWholeFile: a missing file and a directory are named", "[io][error]") {
    const test::TemporaryFolder folder;
    CHECK(test::contains(test::thrownBy([&] { readWholeFile(folder.path("no.obj")); }).message,
                         "no.obj: no such file"));
    CHECK(test::contains(test::thrownBy([&] { readWholeFile("/tmp"); }).message, "is a directory"));
    CHECK(readWholeFile(folder.write("a", "12\n3")) == "12\n3");
}
