#include "libvdbsynth/io/points/row_text.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// The numbers of the next line; -999 stands for a missing one, 999 for a word.
std::vector<double> nextOf(RowText& text) {
    std::vector<double> values;
    std::vector<RowWord> words;
    REQUIRE(text.next());
    text.numbers(values, words);
    for (double& value : values)
        if (std::isnan(value)) value = -999;
    for (const RowWord& word : words) values.at(word.place) = 999;
    return values;
}

std::vector<double> numbersOf(const std::string& line) {
    const std::string path = "a";
    RowText text(path, line);
    return nextOf(text);
}

bool decimal(const std::string& content) {
    const std::string path = "a";
    RowText text(path, content);
    REQUIRE(text.next());
    return text.findDecimalCommas();
}

}  // namespace

TEST_CASE("RowText: words between any separators", "[io][hand]") {
    const std::vector<double> right{1, -2.5, 3e4};
    for (const char* line : {"1 -2.5 3e4", "1\t-2.5\t3e4", "1,-2.5,3e4", "1, -2.5 ,3e4", "1;-2.5;3e4",
                             "1|-2.5 | 3e4", "  1 , -2.5\t3e4 # comment", "\"1\";\"-2.5\";\"3e4\"",
                             "+1 -2.5 +3E+4", "1,-2.5,3e4,", "1 -2.5D0 3d4", "1 -2.5 3e4\r", "1 -2.5 3e4#"}) {
        CAPTURE(line);
        CHECK(numbersOf(line) == right);
    }
}

TEST_CASE("RowText: missing numbers and words", "[io][hand]") {
    CHECK(numbersOf("1,,3") == std::vector<double>{1, -999, 3});
    CHECK(numbersOf(",2,3") == std::vector<double>{-999, 2, 3});
    CHECK(numbersOf("1;  ;3") == std::vector<double>{1, -999, 3});
    for (const char* word : {"nan", "NaN", "-nan", "NA", "N/A", "null", "None", "-", "1.#QNAN", "-1.#IND",
                             "-nan(ind)", "\"\""}) {
        CAPTURE(word);
        CHECK(numbersOf(std::string("1 ") + word + " 3") == std::vector<double>{1, -999, 3});
    }
    CHECK(numbersOf("1 two 3") == std::vector<double>{1, 999, 3});
    CHECK(numbersOf("1 2x 3..4") == std::vector<double>{1, 999, 999});
    CHECK(numbersOf("1 \"a b,c\" 3") == std::vector<double>{1, 999, 3});
}

TEST_CASE("RowText: line ends, byte order mark, blank lines, a last line that is cut off", "[io][hand]") {
    const std::string path = "a";
    for (const std::string end : {"\n", "\r\n", "\r", "\n\r\n", "\r\r"}) {
        const std::string content =
            "\xef\xbb\xbf"
            "1 2" +
            end + end + "3 4" + end;
        RowText text(path, content);
        CHECK(nextOf(text) == std::vector<double>{1, 2});
        CHECK_FALSE(text.isCutOff());
        CHECK(nextOf(text) == std::vector<double>{3, 4});
        CHECK_FALSE(text.isCutOff());
        CHECK_FALSE(text.next());
    }
    const std::string cut = "1 2\n3 4 ";
    RowText text(path, cut);
    CHECK(nextOf(text) == std::vector<double>{1, 2});
    CHECK(nextOf(text) == std::vector<double>{3, 4});
    CHECK(text.isCutOff());
    CHECK(text.lineNumber() == 2);
    CHECK(test::thrownBy([&] { text.fail("is bad"); }).message == "a:2: is bad");
    const std::string header = "x\ny\n5 6";
    RowText later(path, header, 4);
    CHECK(nextOf(later) == std::vector<double>{5, 6});
    CHECK(later.lineNumber() == 3);
}

TEST_CASE("RowText: what is no text of rows", "[io][error]") {
    const std::string path = "a";
    const auto refusal = [&](const std::string& content) {
        return test::thrownBy([&] { RowText(path, content); }).message;
    };
    CHECK(test::contains(refusal(std::string("\xff\xfe"
                                             "1\0 \0",
                                             6)),
                         "UTF-16"));
    CHECK(test::contains(refusal("LASF and more"), "LAS file"));
    CHECK(test::contains(refusal(std::string("1 2\0 3", 6)), "not text"));
    CHECK(refusal(std::string("1 2 3\n\0\0", 8)) == "");  // padding
    CHECK(refusal("") == "");
}

TEST_CASE("RowText: decimal commas are found, and only those", "[io][hand]") {
    for (const char* content :
         {"1,234;5,678;9,012\n", "1,5 2,5 3,5\n4,5 5 6\n", "1,5\t2,5\t3,5", "1 2 3\n4 5 6\n1,5 2 3\n",
          "-1,5;+2,5e-3;0,5\n", "\"1,5\",\"2,5\",\"3,5\"\n", "1,5|2,5|3,5\n", "1,5;nan;3,5;7\n"}) {
        CAPTURE(content);
        CHECK(decimal(content));
    }
    for (const char* content :
         {"1,2,3\n", "1, 2, 3\n", "1 ,2 ,3\n", "1 2 3\n", "1,2 3\n", "1.5,2.5,3.5\n", "1,234.5;2;3\n",
          "1.234,5;2;3\n", "1,2,3 4,5,6 7,8,9\n", "1,2;3\n", "1,5 2,5 3,5\n1,2,3\n", "1,5 2,5 word\n", ""}) {
        CAPTURE(content);
        if (*content) CHECK_FALSE(decimal(content));
    }
    const std::string path = "a", content = "1,5;2,25;-3\n4.5;5;6\n\"7,5\";8;9\n";
    RowText text(path, content);
    std::vector<double> values;
    std::vector<RowWord> words;
    REQUIRE(text.next());
    CHECK(text.findDecimalCommas());
    CHECK(nextOf(text) == std::vector<double>{999, 5, 6});  // a point among decimal commas is none
    const std::string plain = "1,5;2,25;-3\n4;5;6\n\"7,5\";8;9\n";
    RowText commas(path, plain);
    REQUIRE(commas.next());
    REQUIRE(commas.findDecimalCommas());
    commas.numbers(values, words);
    CHECK(values == std::vector<double>{1.5, 2.25, -3});
    CHECK(nextOf(commas) == std::vector<double>{4, 5, 6});
    CHECK(nextOf(commas) == std::vector<double>{7.5, 8, 9});
}

TEST_CASE("RowText: names of columns", "[io][hand]") {
    const std::string path = "a";
    const auto namesOf = [&](const std::string& line) {
        RowText text(path, line);
        REQUIRE(text.next());
        return text.names();
    };
    using Names = std::vector<std::string>;
    CHECK(namesOf("//X Y Z") == Names{"//X", "Y", "Z"});
    CHECK(namesOf("\"x\";\"y, z\"") == Names{"x", "y, z"});
    CHECK(namesOf(",x, y ,z") == Names{"", "x", "y", "z"});
    CHECK(namesOf("Point ID\tx\ty") == Names{"Point ID", "x", "y"});
    const std::string comment = "# c\n";
    RowText text(path, comment);
    REQUIRE(text.next());
    CHECK(text.isComment());
    CHECK_FALSE(text.beginsWithNumber());
}

TEST_CASE("shownWord: bytes of a file are not printed", "[io][hostile]") {
    CHECK(shownWord("three") == "\"three\"");
    CHECK(shownWord("a\x1b[31m\xff\n") == "\"a?[31m??\"");
    CHECK(shownWord(std::string(100, 'x')).size() == 42);
}
