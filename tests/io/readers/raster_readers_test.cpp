#include "libvdbsynth/io/readers/raster_readers.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <map>

#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/volume_dialects.h"
#include "tests/support/whole_files.h"

using namespace vdbsynth;

namespace {

using Reader = Raster (*)(const std::string&, const std::string&, const RasterReadOptions&,
                          const RunContext&);

const std::map<std::string, Reader> kReaders{
    {"png", readPng}, {"jpg", readJpeg}, {"pgm", readPnm},   {"tif", readTiff},    {"exr", readExr},
    {"npy", readNpy}, {"vti", readVti},  {"nii", readNifti}, {"sgems", readGslib}, {"inr", readInr}};

// Numbers as floats, in the machine's byte order and in the other.
template <typename T>
void check(SampleType type, const std::vector<T>& values) {
    REQUIRE(bytesOf(type) == sizeof(T));
    const std::string bytes = test::raw(values);
    std::string turned;
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(T))
        for (std::size_t b = sizeof(T); b-- > 0;) turned += bytes[i + b];
    std::vector<float> straight(values.size()), swapped(values.size());
    toFloats(bytes.data(), values.size(), type, false, straight.data());
    toFloats(turned.data(), values.size(), type, true, swapped.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
        CHECK(straight[i] == float(values[i]));
        CHECK(swapped[i] == float(values[i]));
    }
}

float halfOf(std::uint16_t bits) {
    float value = 0;
    toFloats(reinterpret_cast<const char*>(&bits), 1, SampleType::F16, false, &value);
    return value;
}

}  // namespace

TEST_CASE("toFloats: every type, in either byte order", "[io][oracle]") {
    check<std::uint8_t>(SampleType::U8, {0, 1, 127, 255});
    check<std::int8_t>(SampleType::I8, {0, -1, 127, -128});
    check<std::uint16_t>(SampleType::U16, {0, 1, 256, 65535});
    check<std::int16_t>(SampleType::I16, {0, -1, 258, -32768});
    check<std::uint32_t>(SampleType::U32, {0, 1, 66051, 4294967295u});
    check<std::int32_t>(SampleType::I32, {0, -1, 66051, std::numeric_limits<std::int32_t>::min()});
    check<std::uint64_t>(SampleType::U64, {0, 1, 16909060, std::numeric_limits<std::uint64_t>::max()});
    check<std::int64_t>(SampleType::I64, {0, -1, 16909060, std::numeric_limits<std::int64_t>::min()});
    check<float>(SampleType::F32, {0, -1.5f, 1e30f, INFINITY});
    check<double>(SampleType::F64, {0, -1.5, 0.1, 1e30});
}

TEST_CASE("toFloats: halves of every size, infinite and none", "[io][oracle]") {
    CHECK(halfOf(0x3c00) == 1);
    CHECK(halfOf(0xc500) == -5);
    CHECK(halfOf(0x7bff) == 65504);
    CHECK(halfOf(0x0001) == std::ldexp(1.f, -24));
    CHECK(halfOf(0x0400) == std::ldexp(1.f, -14));
    CHECK(halfOf(0x03ff) == std::ldexp(1023.f, -24));
    CHECK(std::signbit(halfOf(0x8000)));
    CHECK(halfOf(0x7c00) == INFINITY);
    CHECK(halfOf(0xfc00) == -INFINITY);
    CHECK(std::isnan(halfOf(0x7e00)));
    float before = -1;
    for (std::uint16_t bits = 0; bits <= 0x7c00; ++bits) {
        const float value = halfOf(bits);
        REQUIRE(value > before);
        REQUIRE(halfOf(std::uint16_t(bits | 0x8000)) == -value);
        before = value;
    }
    CHECK(bytesOf(SampleType::F16) == 2);
}

TEST_CASE("whiteOf: of bytes and of pairs of them, none of other types", "[io][oracle]") {
    CHECK(whiteOf(SampleType::U8) == 255);
    CHECK(whiteOf(SampleType::U16) == 65535);
    for (const SampleType type : {SampleType::I8, SampleType::I16, SampleType::I32, SampleType::I64,
                                  SampleType::F16, SampleType::F32, SampleType::F64})
        CHECK(whiteOf(type) == 0);
}

TEST_CASE("makeRaster: room for all samples, sides and memory within limits", "[io][error]") {
    const Raster raster = makeRaster("a", 4, 3, 2, 3, {});
    CHECK(raster.size == Index3{4, 3, 2});
    CHECK(raster.channels == 3);
    CHECK(raster.values.size() == 4 * 3 * 2 * 3);
    const auto making = [](std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t memory = 0) {
        RunContext ctx;
        ctx.maxMemory = memory;
        return test::thrownBy([&] { makeRaster("a.raw", x, y, z, 1, ctx); });
    };
    const std::int64_t most = std::int64_t(1) << 24, huge = std::numeric_limits<std::int64_t>::max();
    CHECK(making(most, 1, 1, 1).code == int(ErrorCode::Memory));  // the side itself is fine
    for (const auto& sides : {Index3{0, 1, 1}, Index3{1, -1, 1}, Index3{1, 1, (1 << 24) + 1}})
        CHECK(making(sides.x, sides.y, sides.z).code == int(ErrorCode::BadData));
    CHECK(making(huge, huge, huge).code == int(ErrorCode::BadData));
    CHECK(test::contains(making(1, huge, 1).message, "a.raw"));
    CHECK(making(1000, 1000, 1, 3999999).code == int(ErrorCode::Memory));
    CHECK(making(1000, 1000, 1, 4000000).code == -1);
    CHECK(making(most, most, most, 1000000000).code == int(ErrorCode::Memory));
}

TEST_CASE("readers of rasters: nothing, nonsense and half a file are refused by name", "[io][error]") {
    const test::TemporaryFolder folder;
    const std::map<std::string, std::string> files = test::wholeFiles(folder);
    RunContext ctx;
    ctx.maxMemory = 1000000000;
    for (const auto& [kind, reader] : kReaders) {
        const std::string name = "a." + kind;
        std::vector<std::string> contents{"", "x", std::string(600, '\0'), std::string(600, 'x')};
        const auto whole = files.find(name);
        if (whole != files.end() && kind != "tif" && kind != "jpg")  // viewers show half a jpg
            contents.push_back(whole->second.substr(0, whole->second.size() / 2));
        for (const std::string& content : contents) {
            const test::Thrown thrown = test::thrownBy([&, read = reader] { read(name, content, {}, ctx); });
            CAPTURE(name, content.size(), thrown.message);
            CHECK(thrown.code == int(ErrorCode::BadData));
            CHECK(test::contains(thrown.message, name));
        }
    }
}

TEST_CASE("readTiff: of a stack that is cut short no pages are lost in silence", "[io][error]") {
    const std::string whole = test::tiff(2, 1, 8, 1, {"ab", "cd", "ef"});
    const Raster all = readTiff("a.tif", whole, {}, {});
    REQUIRE(all.size == Index3{2, 1, 3});
    std::size_t lost = 0, refused = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        Raster read;
        const test::Thrown thrown =
            test::thrownBy([&] { read = readTiff("a.tif", whole.substr(0, length), {}, {}); });
        refused += thrown.code == int(ErrorCode::BadData) ? 1 : 0;
        lost += thrown.code == -1 && read.values != all.values ? 1 : 0;
    }
    CHECK(refused > whole.size() / 4);
    CHECK(lost <= 2 * 4);  // within the four bytes of a link to the next page libtiff sees the last one
}

TEST_CASE("readers of rasters: give what readRaster gives, and ask for memory", "[io][property]") {
    const test::TemporaryFolder folder;
    std::size_t kinds = 0;
    for (const auto& [name, content] : test::wholeFiles(folder)) {
        const auto reader = kReaders.find(name.substr(2));
        if (reader == kReaders.end()) continue;
        const Raster own = reader->second(name, content, {}, {}),
                     other = readRaster(folder.write(name, content));
        CAPTURE(name);
        CHECK(own.size == other.size);
        CHECK(own.channels == other.channels);
        CHECK(test::raw(own.values) == test::raw(other.values));
        CHECK(own.values.size() == own.sampleCount() * std::size_t(own.channels));
        RunContext small;
        small.maxMemory = 1;
        CHECK(test::thrownBy([&, read = reader->second, bytes = content] {
                  read("a", bytes, {}, small);
              }).code == int(ErrorCode::Memory));
        ++kinds;
    }
    CHECK(kinds >= 9);  // jpg only where samples are
}

TEST_CASE("chosenArray: the named one, else the standard one with a note, unknown names are errors",
          "[io][error]") {
    std::vector<std::string> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said.push_back(text); };
    const std::vector<std::string> names{"velocity", "pressure"};
    CHECK(chosenArray("a", names, 1, {"velocity"}, ctx) == 0);
    CHECK(chosenArray("a", {"only"}, 0, {}, ctx) == 0);
    CHECK(said.empty());
    CHECK(chosenArray("a", names, 1, {}, ctx) == 1);
    REQUIRE(said.size() == 1);
    CHECK(said[0] == "a: holds velocity, pressure; pressure is read; `grid` chooses another");
    const test::Thrown thrown = test::thrownBy([&] { chosenArray("a", names, 1, {"speed"}, ctx); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(thrown.message == "`grid` speed: not in a, which has velocity, pressure");
    const std::vector<std::string> many(1000, "n");
    CHECK(test::thrownBy([&] { chosenArray("a", many, 0, {"x"}, ctx); }).message.size() < 200);
    CHECK(test::thrownBy([&] { chosenArray("a", {}, 0, {"x"}, ctx); }).code == int(ErrorCode::BadData));
}

TEST_CASE("readers of volumes: dialects cut short or with bytes changed give a result or an Error",
          "[io][property]") {
    RunContext ctx;
    ctx.maxMemory = 100000000;
    std::size_t refusals = 0, number = 0;
    for (const auto& [kind, whole] : test::volumeDialects()) {
        const Reader reader = kReaders.at(kind);
        CAPTURE(kind, number);
        CHECK(test::thrownBy([&, content = whole] { reader("a", content, {}, ctx); }).message == "");
        Random random(7, number++);
        for (int round = 0; round < 300; ++round) {
            std::string content = whole;
            if (round % 3 == 0) content.resize(std::size_t(random.uniform(0, double(content.size()))));
            for (int i = 0; i < round % 8 && !content.empty(); ++i)
                content[std::size_t(random.uniform(0, double(content.size())))] =
                    char(random.uniform(0, 256));
            const test::Thrown thrown = test::thrownBy([&] { reader("a", content, {}, ctx); });
            refusals += thrown.code >= 0 ? 1 : 0;
            for (const char c : thrown.message) REQUIRE((c >= ' ' || c < 0));
        }
    }
    CHECK(refusals > 500);
}
