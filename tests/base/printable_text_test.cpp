#include "libvdbsynth/base/printable_text.h"

#include <catch2/catch.hpp>

#include <string>

using namespace vdbsynth;

TEST_CASE("printableText: what can be printed stays", "[base][fast]") {
    for (const char* text : {"", "plain text ~", "caf\xC3\xA9", "\xE2\x82\xAC 5", "\xF0\x9F\x99\x82"}) {
        CHECK(printableText(text) == text);
        CHECK(printableText(printableText(text)) == printableText(text));
    }
}

TEST_CASE("printableText: controls, escapes and bytes that are no UTF-8", "[base][error]") {
    CHECK(printableText("a\nb\r\tc") == "a b  c");
    CHECK(printableText(std::string("a\0b", 3)) == "a?b");
    CHECK(printableText("\x1B[2J\x7F") == "?[2J?");
    CHECK(printableText("\x80\xBFz") == "??z");
    CHECK(printableText("\xC3") == "?");                 // cut
    CHECK(printableText("\xC3(") == "?(");               // not continued
    CHECK(printableText("\xC0\xAF") == "??");            // overlong
    CHECK(printableText("\xE0\x80\xAF") == "???");       // overlong
    CHECK(printableText("\xED\xA0\x80") == "???");       // half of a pair
    CHECK(printableText("\xF4\x90\x80\x80") == "????");  // beyond the last
    CHECK(printableText("\xF5\xFF\xFE") == "???");
    CHECK(printableText("\xC2\x9B") == "??");  // Latin-1's escape
}

TEST_CASE("printableText: every byte alone gives one printable byte", "[base][property]") {
    for (int byte = 0; byte < 256; ++byte) {
        const std::string out = printableText(std::string(1, char(byte)));
        REQUIRE(out.size() == 1);
        CHECK(out[0] >= 0x20);
        CHECK(out[0] < 0x7F);
    }
}

TEST_CASE("printableText: long text is cut, but not within a character", "[base][hand]") {
    CHECK(printableText(std::string(1000, 'x'), 80) == std::string(80, 'x') + "...");
    CHECK(printableText("abc", 3) == "abc");
    CHECK(printableText("ab\xc3\xb6", 3) == "ab...");
    CHECK(printableText("", 3).empty());
}
