#include "libvdbsynth/io/readers/tiff/tiff_pages.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/makers.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;
using Page = test::TiffMaker::Page;

namespace {

// Numbers packed from the highest bit on, each row begun at a byte.
std::string packed(const std::vector<std::uint32_t>& values, int columns, int bits) {
    std::string bytes;
    for (std::size_t row = 0; row < values.size(); row += std::size_t(columns)) {
        std::vector<bool> digits;
        for (std::size_t i = row; i < row + std::size_t(columns); ++i)
            for (int bit = bits - 1; bit >= 0; --bit) digits.push_back((values[i] >> bit & 1) != 0);
        for (std::size_t at = 0; at < digits.size(); at += 8) {
            int byte = 0;
            for (std::size_t i = 0; i < 8; ++i)
                byte = byte * 2 + (at + i < digits.size() && digits[at + i] ? 1 : 0);
            bytes += char(byte);
        }
    }
    return bytes;
}

std::vector<float> read(const std::string& content, const TiffSamples& samples = {}, bool stack = false) {
    TiffFile file("a.tif", content);
    const TiffPage page = file.pages()[0];
    std::vector<float> values(std::size_t(page.width) * page.height * std::size_t(samples.channels));
    file.select(0);
    readTiffPage("a.tif", file, page, samples, stack, {}, values.data());
    return values;
}

}  // namespace

TEST_CASE("unpackBits: by hand", "[io][oracle]") {
    float out[4] = {};
    unpackBits("\xab\xcd\xef", 2, 12, false, out);
    CHECK(out[0] == 0xabc);
    CHECK(out[1] == 0xdef);
    unpackBits("\xab\xcd\xef", 2, 12, true, out);
    CHECK(out[0] == 0xabc - 4096);
    unpackBits("\xa0", 4, 1, false, out);
    CHECK((out[0] == 1 && out[1] == 0 && out[2] == 1 && out[3] == 0));
    unpackBits("\x01\x02\x03\xff\xff\xff", 2, 24, true, out);
    CHECK(out[0] == 0x030201);
    CHECK(out[1] == -1);
    unpackBits("\xff\xff\xff\xff\xff\xff\xff\xff", 2, 31, false, out);
    CHECK(out[1] == 2147483647.f);
}

TEST_CASE("readTiffPage: whole numbers of 1 to 32 bits, in rows that end within a byte", "[io][oracle]") {
    for (int bits = 1; bits <= 32; ++bits) {
        const std::uint32_t most = bits == 32 ? 0xffffffffu : (1u << bits) - 1;
        std::vector<std::uint32_t> values;
        for (std::uint32_t i = 0; i < 15; ++i) values.push_back(i == 0 ? most : i * 2654435761u & most);
        for (const bool bigEndian : {false, true})
            for (const int format : {1, 2}) {
                if (format == 2 && bits == 1) continue;
                test::TiffMaker maker{bigEndian};
                Page page{5, 3, bits, packed(values, 5, bits)};
                if (bits % 8 == 0) {  // whole bytes are in the file's order
                    page.pixels.clear();
                    for (std::uint32_t value : values)
                        page.pixels += maker.number(value, std::size_t(bits / 8));
                }
                page.format = format;
                std::vector<float> right;
                for (std::uint32_t value : values) {
                    const double half = std::ldexp(1.0, bits - 1);
                    right.push_back(
                        float(format == 2 && value >= half ? double(value) - 2 * half : double(value)));
                }
                CAPTURE(bits, bigEndian, format);
                CHECK(read(maker.file({page})) == right);
            }
    }
}

TEST_CASE("readTiffPage: one sample of several, interleaved and in planes", "[io][oracle]") {
    test::TiffMaker maker;
    Page page{2, 1, 12, packed({1, 2, 3, 4, 5, 6}, 6, 12)};
    page.samples = 3;
    page.photometric = 1;
    page.fields = {maker.shorts(338, {0, 0})};
    for (std::size_t first = 0; first < 3; ++first)
        CHECK(read(maker.file({page}), {first, 1}) == std::vector<float>{float(first + 1), float(first + 4)});
    CHECK(read(maker.file({page}), {0, 3}) == std::vector<float>{1, 2, 3, 4, 5, 6});
    Page planes{2, 1, 8, "adbecf"};
    planes.samples = 3;
    const std::vector<std::uint32_t> begins{8, 10, 12};
    planes.fields = {maker.shorts(284, {2}), maker.longs(273, begins), maker.longs(279, {2, 2, 2}),
                     maker.shorts(338, {0, 0})};
    CHECK(read(maker.file({planes}), {1, 1}) == std::vector<float>{'b', 'e'});
    CHECK(read(maker.file({planes}), {0, 3}) == std::vector<float>{'a', 'b', 'c', 'd', 'e', 'f'});
    // The last is opacity: 'c' and nothing.
    planes.pixels.back() = '\0';
    planes.fields[3] = maker.shorts(338, {0, 2});
    const std::vector<float> shown = read(maker.file({planes}), {0, 1});
    CHECK(shown[0] == 'a');
    CHECK(std::isnan(shown[1]));
}

TEST_CASE("isStored, dataSamples and whiteOf: of every kind", "[io][oracle]") {
    TiffPage page;
    page.bits = 12;
    CHECK(isStored(page, false));
    CHECK(whiteOf(page, false) == 4095);
    page.number = TiffNumber::Signed;
    CHECK(whiteOf(page, false) == 0);
    page.number = TiffNumber::Real;
    CHECK_FALSE(isStored(page, false));
    page.bits = 32;
    CHECK(isStored(page, false));
    CHECK(whiteOf(page, false) == 0);
    page.number = TiffNumber::Unsigned;
    for (const int bits : {33, 48, 63, 65, 128, 0}) {
        page.bits = std::uint16_t(bits);
        CHECK_FALSE(isStored(page, false));
    }
    page.bits = 17;
    CHECK(whiteOf(page, false) == 0);
    page.bits = 8;
    page.colour = TiffColour::Palette;
    CHECK_FALSE(isStored(page, false));
    CHECK(isStored(page, true));
    CHECK(whiteOf(page, false) == 255);
    page.number = TiffNumber(5);  // complex
    CHECK_FALSE(isStored(page, true));
    page.samples = 4;
    page.alpha = true;
    CHECK(dataSamples(page) == 3);
}

TEST_CASE("readRawPage: slices without tags, in either byte order", "[io][oracle]") {
    for (const bool bigEndian : {false, true}) {
        test::TiffMaker maker{bigEndian};
        std::string content = maker.file({{2, 1, 16, maker.number(7, 2) + maker.number(300, 2)}});
        const std::size_t behind = content.size();
        content += maker.number(8, 2) + maker.number(301, 2);
        const TiffFile file("a.tif", content);
        float out[2] = {};
        readRawPage("a.tif", file, file.pages()[0], {}, content, behind, out);
        CHECK(out[0] == 8);
        CHECK(out[1] == 301);
        for (const std::size_t at : {behind + 1, behind + 4, behind + 1000})
            CHECK(test::thrownBy([&] {
                      readRawPage("a.tif", file, file.pages()[0], {}, content, at, out);
                  }).code == int(ErrorCode::BadData));
    }
}
