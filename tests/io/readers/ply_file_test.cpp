#include "libvdbsynth/io/readers/ply_file.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/stl_files.h"

using namespace vdbsynth;
using test::replaced;

namespace {

const std::string kHead =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 2\nproperty float x\nproperty int64 id\nelement "
    "face "
    "1\nproperty list uint8_t INT32 vertex_indices\nend_header\n";

// All numbers of the body, in their order.
std::vector<double> numbersOf(const std::string& content, std::int64_t* longLines = nullptr) {
    const std::string path = "a.ply";
    const PlyHeader header = readPlyHeader(path, content);
    PlyBody body(path, content, header);
    std::vector<double> numbers;
    for (const PlyElement& element : header.elements)
        for (std::int64_t i = 0; i < element.count; ++i) {
            body.begin(element);
            for (const PlyProperty& property : element.properties) {
                const std::int64_t values = property.list ? body.listLength(property) : 1;
                for (std::int64_t k = 0; k < values; ++k) numbers.push_back(body.number(property.value));
            }
            body.end();
        }
    if (longLines) *longLines = body.longLines();
    CHECK(body.bytesLeft() == 0);
    return numbers;
}

}  // namespace

TEST_CASE("readPlyHeader: elements, types and line ends", "[io][oracle]") {
    for (const char* end : {"\n", "\r\n", "\r", "  \n", "   \r"}) {
        const std::string content = replaced(kHead, "\n", end) + "0.5 7";
        CAPTURE(content);
        const PlyHeader header = readPlyHeader("a", content);
        REQUIRE(header.elements.size() == 2);
        CHECK(header.elements[0].name == "vertex");
        CHECK(header.elements[0].properties[1].value == PlyType::Int64);
        CHECK(header.elements[1].name == "face");
        CHECK(header.elements[1].properties[0].list);
        CHECK(header.elements[1].properties[0].isWhole());
        CHECK(content.substr(header.bytes) == "0.5 7");
    }
    CHECK(readPlyHeader("a", "\xEF\xBB\xBFPLY\nformat ASCII 1.0\nend_header").elements.empty());
    const auto names = [](const std::string& first, const std::string& second) {
        const PlyHeader header = readPlyHeader(
            "a", "ply\nformat ascii 1.0\nelement " + first + " 1\nelement " + second + " 1\nend_header\n");
        return header.elements[0].name + " " + header.elements[1].name;
    };
    CHECK(names("points", "Polygons") == "vertex face");
    CHECK(names("point", "vertex") == "point vertex");
    CHECK(names("facet", "Faces") == "facet face");
}

TEST_CASE("readPlyHeader: a body whose first byte is a line end is not cut", "[io][degenerate]") {
    const std::string head =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nend_header\n";
    for (const char* end : {"\n", "\r\n", "\r"})
        for (const char first : {'\n', '\r', ' '}) {
            const std::string content = replaced(head, "\n", end) + first;
            const PlyHeader header = readPlyHeader("a", content);
            CHECK(header.bytes == content.size() - 1);
        }
}

TEST_CASE("readPlyHeader: errors", "[io][error]") {
    const std::pair<std::string, std::string> all[] = {
        {"plz\n", "not a PLY file"},
        {"ply\nformat ascii 1.0\n", "no end_header"},
        {"ply\nend_header\n", "names no format"},
        {"ply\nformat binary 1.0\n", "unknown format \"binary\"; known are"},
        {"ply\nproperty float x\n", "a property before any element"},
        {"ply\nelement vertex -1\n", "negative"},
        {"ply\nelement vertex\n", "is truncated"},
        {"ply\nelement vertex 1\nproperty half x\n", "unknown property type \"half\""},
        {"ply\nelement vertex 1\nproperty \x1B\xFF x\n", "\"?\?\""},
        {"ply\nelement vertex 1\nproperty list text int x\n", "unknown type of a list's length"},
    };
    for (const auto& [content, says] : all) {
        const test::Thrown thrown =
            test::thrownBy([&, &content = content] { readPlyHeader("a.ply", content); });
        CAPTURE(thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, says));
    }
}

TEST_CASE("PlyBody: text by lines, or wherever lines end", "[io][oracle]") {
    std::int64_t longLines = 0;
    const char* const bodies[] = {"0.5 7\n1.5 8\n2 0 1\n",   "0.5 7\r1.5 8\r2 0 1\r",
                                  "0.5 7\n\n\n1.5 8\n2 0 1", "0.5\n7\n1.5\n8\n2\n0\n1\n",
                                  "0.5 7 1.5 8 2 0 1",       "0.5 7 1.5 8\n2 0 1\n",
                                  "0.5 7\n1.5 8\n2\n0\n1\n", "0.5 7.0\n+1.5 8\n 2 0 1.0 \n\n"};
    for (const char* body : bodies) {
        CAPTURE(body);
        std::vector<double> numbers = numbersOf(kHead + body, &longLines);
        REQUIRE(numbers.size() == 6);
        CHECK(numbers == std::vector<double>{0.5, 7, 1.5, 8, 0, 1});
        CHECK(longLines == 0);
    }
    CHECK(numbersOf(kHead + "0.5 7 9 9\n1.5 8\n2 0 1 6 0.1 0.2\n", &longLines) ==
          std::vector<double>{0.5, 7, 1.5, 8, 0, 1});
    CHECK(longLines == 2);
}

TEST_CASE("PlyBody: bytes of every type in both orders", "[io][oracle]") {
    const char* const types[] = {"char", "uchar", "short",  "ushort", "int",
                                 "uint", "int64", "uint64", "float",  "double"};
    for (const bool big : {false, true}) {
        std::string head = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                           "_endian 1.0\nelement v 1\n",
                    body;
        const auto add = [&](auto value) { body += test::stlNumber(&value, sizeof value, big); };
        for (const char* type : types) head += std::string("property ") + type + " a\n";
        add(std::int8_t(-3));
        add(std::uint8_t(200));
        add(std::int16_t(-300));
        add(std::uint16_t(60000));
        add(std::int32_t(-70000));
        add(std::uint32_t(4000000000u));
        add(std::int64_t(-5000000000));
        add(std::uint64_t(6000000000));
        add(0.25f);
        add(-1e-200);
        CHECK(numbersOf(head + "end_header\n" + body) ==
              std::vector<double>{-3, 200, -300, 60000, -70000, 4e9, -5e9, 6e9, 0.25, -1e-200});
    }
}

TEST_CASE("PlyBody: errors say how much is there", "[io][error]") {
    const std::string binary = replaced(kHead, "ascii", "binary_little_endian");
    const std::pair<std::string, std::string> all[] = {
        {kHead + "0.5 7\n1.5", "a.ply: truncated: 1 of 2 of \"vertex\" are there"},
        {kHead + "0.5 7 9\n1.5 8 9\n2 0", "truncated: 0 of 1 of \"face\" are there"},
        {kHead + "0.5 7 9\n1.5\n2 0 1\n\n", "fewer words than the header declares"},
        {kHead + "0.5 7\n1.5\n2 0 1\n\n", "a line of \"vertex\" has fewer words"},
        {kHead + "0.5 seven\n1.5 8\n2 0 1\n", "\"seven\" is not a number"},
        {kHead + "0.5 nan\n1.5 8\n2 0 1\n", "\"nan\" is not a number"},
        {kHead + "0.5 7\n1.5 8\n-2 0 1\n", "a list longer than the file"},
        {kHead + "0.5 7\n1.5 8\n2.5 0 1\n", "of no whole length"},
        {kHead + "0.5 7\n1.5 8\n9000 0 1\n", "a list longer than the file"},
        {kHead, "claims 2 of \"vertex\", more than the file can hold"},
        {binary + std::string(20, '\0'), "claims 2 of \"vertex\", more than the file can hold"},
        {binary + std::string(24, '\0') + "\5", "truncated: 0 of 1 of \"face\" are there"},
    };
    for (const auto& [content, says] : all) {
        const test::Thrown thrown = test::thrownBy([&, &content = content] { numbersOf(content); });
        CAPTURE(thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, says));
    }
}

TEST_CASE("plyCommentsIn: the header's, in order, whatever ends its lines", "[io]") {
    const std::vector<std::string> two{"vdb_synth", "a b"};
    for (const char* end : {"\n", "\r\n", "\r", "  \n"}) {
        const auto lines = [&](std::initializer_list<const char*> texts) {
            std::string content;
            for (const char* text : texts) content += std::string(text) + end;
            return content;
        };
        CHECK(plyCommentsIn(lines({"ply", "comment vdb_synth", "format ascii 1.0", "comment a b",
                                   "obj_info comment no", "end_header", "comment data"})) == two);
    }
    CHECK(plyCommentsIn("").empty());
    CHECK(plyCommentsIn("comment " + std::string(5000, 'x')).front().size() == 4096 - 8);
}
