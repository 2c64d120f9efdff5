#include "tools/vdb_synth/batch/job_text.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"

using namespace vdbsynth;
using namespace vdbsynth::cli::batch;

namespace {

std::string refusalOf(const std::string& text, bool yaml) {
    const test::Thrown thrown = test::thrownBy([&] { parseJobText("j", text, yaml); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    return thrown.message;
}

}  // namespace

TEST_CASE("parseJobText: JSON and YAML of the same content", "[tools]") {
    const Json json = parseJobText("j", R"({"b": ["1", "2x,2x", true, null], "a": {"c": "off"}})", false);
    CHECK(parseJobText("j", "b: [1, '2x,2x', true, ~]\na:\n  c: off\n", true) == json);
    CHECK(json.begin().key() == "b");  // the order of the file
    CHECK(parseJobText("j", "a: \"true\"\nb: 0.10\nc: 0x10\n", true) ==
          Json({{"a", "true"}, {"b", "0.10"}, {"c", "0x10"}}));
    CHECK(parseJobText("j", "a: &x [1]\nb: *x\n", true)["b"] == Json::array({"1"}));
}

TEST_CASE("parseJobText: what is refused", "[tools][error]") {
    CHECK(test::contains(refusalOf("{\"a\": 1,\n \"b\": }", false), "j: no valid JSON: at line 2"));
    CHECK(test::contains(refusalOf("{\"a\": {\"b\": 1, \"b\": 2}}", false), "\"b\" stands twice"));
    CHECK(test::contains(refusalOf(std::string(100000, '['), false), "nested too deeply"));
    CHECK(test::contains(refusalOf("a: [1\nb: 2", true), "j: no valid YAML: at line"));
    CHECK(test::contains(refusalOf("a: 1\na: 2", true), "line 2: \"a\" stands twice"));
    CHECK(test::contains(refusalOf("a: 1\n---\nb: 2", true), "several documents"));
    CHECK(test::contains(refusalOf("a: &x {b: 1}\nc:\n  <<: *x", true), "merged keys"));
    CHECK(test::contains(refusalOf("[a, b]: 1", true), "a key must be a word"));
    CHECK_FALSE(refusalOf(std::string(5000, '['), true).empty());
    CHECK_FALSE(refusalOf("a: *x", true).empty());
    CHECK(test::contains(refusalOf("a: \xFF\n", true), "is not UTF-8"));
    CHECK(test::contains(refusalOf(",", true),
                         "a comma or bracket too many"));  // yaml-cpp: documents without end
    CHECK(test::contains(refusalOf("", true), "holds nothing"));
    std::string deep;
    for (int n = 0; n < 70; ++n) deep += "[";
    CHECK(test::contains(refusalOf(deep + std::string(70, ']'), true), "nested too deeply"));
    std::string bomb = "a0: &a0 [x,x,x,x,x,x,x,x,x,x]\n";
    for (int n = 1; n < 8; ++n) {
        const std::string alias = "*a" + std::to_string(n - 1);
        bomb += "a" + std::to_string(n) + ": &a" + std::to_string(n) + " [";
        for (int k = 0; k < 10; ++k) bomb += (k ? "," : "") + alias;
        bomb += "]\n";
    }
    CHECK(test::contains(refusalOf(bomb, true), "more than a million values"));
}
