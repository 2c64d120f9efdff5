#include "libvdbsynth/vdb/read/vdb_layout.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include <chrono>
#include <cstring>
#include <sstream>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"
#include "tests/vdb/read/fields.h"

using namespace vdbsynth;

namespace {

std::string goodFile(const test::TemporaryFolder& folder) {
    const auto grid = test::bandGrid(test::ballField(6), 10, 0.1);
    const auto other = openvdb::BoolGrid::create();
    other->setName("field");
    other->tree().setValueOn({1, 2, 3});
    writeVdb(folder.path("good.vdb"), {grid, other}, {{"from", "a test"}});
    return test::contentOf(folder.path("good.vdb"));
}

std::vector<VdbEntry> layoutOf(const std::string& bytes) {
    std::istringstream stream(bytes);
    return vdbLayout("a.vdb", stream, bytes.size());
}

std::string refusal(const std::string& bytes) {
    const test::Thrown thrown = test::thrownBy([&] { layoutOf(bytes); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    return thrown.message;
}

// 32 bits at a place of the head: 20 bytes of versions and a flag, 36 of an id.
std::string with(std::string bytes, std::size_t at, std::uint32_t number) {
    std::memcpy(&bytes[at], &number, sizeof number);
    return bytes;
}

}  // namespace

TEST_CASE("vdbLayout: names and types of a file's grids", "[vdb][fast]") {
    const test::TemporaryFolder folder;
    const std::vector<VdbEntry> entries = layoutOf(goodFile(folder));
    REQUIRE(entries.size() == 2);
    CHECK(entries[0].type == "Tree_float_5_4_3");
    CHECK(entries[1].type == "Tree_bool_5_4_3");
    CHECK(entries[0].name.substr(0, 5) == "field");
}

TEST_CASE("vdbLayout: what is wrong is named", "[vdb][error]") {
    const test::TemporaryFolder folder;
    const std::string good = goodFile(folder);
    CHECK(test::contains(refusal(good.substr(0, 30)), "ends at byte 30"));
    CHECK(test::contains(refusal(good.substr(0, good.size() / 2)), "in grid \"field\""));
    CHECK(test::contains(refusal(good.substr(0, good.size() - 1)), "truncated"));
    CHECK(test::contains(refusal("solid of something else"), "not a VDB file"));
    CHECK(test::contains(refusal(with(good, 8, 99)), "version 99"));
    CHECK(test::contains(refusal(with(good, 8, 4000000000u)), "version 4000000000"));
    CHECK(test::contains(refusal(with(good, 57, 0xFFFFFFFFu)), "corrupt"));  // number of metadata
    CHECK(test::contains(refusal(""), "truncated"));
    std::string name = good;
    const std::size_t at = name.find("field");
    name[at] = '\x01';
    CHECK_FALSE(test::contains(refusal(name.substr(0, name.size() - 1)), std::string(1, '\x01')));
}

TEST_CASE("plainText: no raw bytes, no end", "[vdb][fast]") {
    CHECK(plainText("abc def") == "abc def");
    CHECK(plainText("a\n\xC3\xA4\x7F") == "a????");
    CHECK(plainText(std::string(1000, 'x')).size() == 83);
    CHECK(plainText("").empty());
}

// Behind the lists OpenVDB itself does not check lengths: tests/cli/reported_vdb_test.py damages those, in a
// program of its own.
TEST_CASE("readVdb: cut off anywhere or damaged in its lists, it answers at once and in one plain line",
          "[vdb][hostile]") {
    const test::TemporaryFolder folder;
    const std::string good = goodFile(folder);
    const auto began = std::chrono::steady_clock::now();
    const auto answers = [&](const std::string& bytes) {
        const std::string path = folder.write("x.vdb", bytes);
        const test::Thrown thrown = test::thrownBy([&] { readVdb(path); });
        if (thrown.code < 0) return;
        INFO(thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        for (const char c : thrown.message) CHECK((c >= ' ' && c <= '~'));
    };
    for (std::size_t n = 1; n < good.size(); n += 1 + good.size() / 200) answers(good.substr(0, n));
    const std::size_t lists = good.find("UniformScaleMap");
    REQUIRE(lists != std::string::npos);
    for (std::uint64_t i = 0; i < 300; ++i) {
        Random random(5, i);
        std::string bytes = good;
        const auto at = std::size_t(random.uniform(0, double(lists - 4)));
        for (std::size_t k = at; k < at + (i % 3 ? 1 : 4); ++k)
            bytes[k] = char(i % 5 ? int(random.uniform(0, 256)) : 255);
        answers(bytes);
    }
    CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(60));
}
