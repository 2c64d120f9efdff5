#include <catch2/catch.hpp>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/said.h"

using namespace vdbsynth;

namespace {

// An image of two pixels a channel of floats: the channel's number, and that plus a half.
std::string exr(const std::vector<std::string>& channels) {
    std::string bytes = "\x76\x2f\x31\x01";
    test::append<std::uint32_t>(bytes, 2);
    const auto attribute = [&](const std::string& name, const std::string& type, const std::string& value) {
        bytes += name + '\0' + type + '\0';
        test::append(bytes, std::uint32_t(value.size()));
        bytes += value;
    };
    std::string list;
    for (const std::string& name : channels) list += name + '\0' + test::raw<std::uint32_t>({2, 0, 1, 1});
    const std::string window = test::raw<std::int32_t>({0, 0, 1, 0});
    attribute("channels", "chlist", list + '\0');
    attribute("compression", "compression", std::string(1, '\0'));
    attribute("dataWindow", "box2i", window);
    attribute("displayWindow", "box2i", window);
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", test::raw<float>({1}));
    attribute("screenWindowCenter", "v2f", test::raw<float>({0, 0}));
    attribute("screenWindowWidth", "float", test::raw<float>({1}));
    bytes += '\0';
    test::append(bytes, std::uint64_t(bytes.size() + 8));
    test::append<std::uint32_t>(bytes, 0);
    test::append(bytes, std::uint32_t(channels.size() * 8));
    for (std::size_t i = 0; i < channels.size(); ++i) bytes += test::raw<float>({float(i), float(i) + 0.5f});
    return bytes;
}

}  // namespace

TEST_CASE("readExr: colour by default, depth and other channels by name", "[io][oracle]") {
    const std::string content = exr({"A", "B", "G", "R", "Z", "mask\x01"});
    test::Said said;
    const Raster colour = readExr("a.exr", content, {}, said.ctx);
    CHECK(colour.channels == 3);
    CHECK(colour.arrays == std::vector<std::string>{"RGB", "Z", "mask?"});
    CHECK(said.all() == "a.exr: holds RGB, Z, mask?; RGB is read; `grid` chooses another\n");
    CHECK(colour.values[3] == 3.5f);
    CHECK(readExr("a.exr", content, {"Z"}, {}).values[1] == 4.5f);
    CHECK(readExr("a.exr", content, {"mask?"}, {}).values[1] == 5.5f);
    CHECK(test::contains(test::thrownBy([&] { readExr("a.exr", content, {"X"}, {}); }).message,
                         "RGB, Z, mask?"));
}

TEST_CASE("readExr: one thing to read needs no word", "[io][oracle]") {
    for (const std::vector<std::string>& channels :
         {std::vector<std::string>{"Y"}, {"A", "Y"}, {"A", "B", "G", "R"}, {"depth"}}) {
        test::Said said;
        CHECK(readExr("a.exr", exr(channels), {}, said.ctx).arrays.empty());
        CHECK(said.all().empty());
    }
    CHECK(test::contains(test::thrownBy([] { readExr("a.exr", exr({"A"}), {}, {}); }).message, "no channel"));
}
