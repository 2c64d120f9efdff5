#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;
using Page = test::TiffMaker::Page;

namespace {

Raster read(const std::string& content, const RunContext& ctx = {}, const std::string& array = "") {
    return readTiff("a.tif", content, {array}, ctx);
}

Raster read(const std::vector<Page>& pages, const RunContext& ctx = {}, const std::string& array = "") {
    test::TiffMaker maker;
    return read(maker.file(pages), ctx, array);
}

const std::string kStack = "ImageJ=1.53\nimages=4\nchannels=2\nslices=2\nspacing=30\nunit=um\n";

// Pages of two pixels: 1 1, 2 2, and so on.
std::vector<Page> pages(int count, const std::string& description, std::uint32_t above = 1,
                        std::uint32_t below = 10) {
    test::TiffMaker maker;
    std::vector<Page> made;
    for (int i = 1; i <= count; ++i) made.push_back({2, 1, 8, std::string(2, char(i))});
    made[0].fields = {test::TiffMaker::text(270, description), maker.rational(282, above, below),
                      maker.rational(283, above, below), maker.shorts(296, {1})};
    return made;
}

}  // namespace

TEST_CASE("readTiff: every orientation, of 1, 8, 12, 16 and 32 bits, images and stacks", "[io][oracle]") {
    // Stored 0 1 1 / 0 0 1.
    const std::vector<std::vector<float>> upright{{0, 1, 1, 0, 0, 1}, {1, 1, 0, 1, 0, 0}, {1, 0, 0, 1, 1, 0},
                                                  {0, 0, 1, 0, 1, 1}, {0, 0, 1, 0, 1, 1}, {0, 0, 0, 1, 1, 1},
                                                  {1, 1, 0, 1, 0, 0}, {1, 1, 1, 0, 0, 0}};
    test::TiffMaker maker;
    for (const int bits : {1, 8, 12, 16, 32})
        for (int orientation = 1; orientation <= 8; ++orientation)
            for (const std::size_t count : {1, 2}) {
                Page page{3, 2, bits,
                          bits == 1    ? "\x60\x20"
                          : bits == 12 ? std::string("\0\0\1\0\x10\0\0\0\0\1", 10)
                                       : ""};
                if (bits == 12) page.pixels = std::string("\0\0\1\0\x10", 5) + std::string("\0\0\0\0\x10", 5);
                for (const int value : {0, 1, 1, 0, 0, 1})
                    if (bits % 8 == 0)
                        page.pixels += maker.number(std::uint64_t(value), std::size_t(bits / 8));
                page.fields = {maker.shorts(274, {orientation})};
                test::Said said;
                const Raster raster = read(std::vector<Page>(count, page), said.ctx);
                CAPTURE(bits, orientation, count);
                const bool turned = orientation > 4;
                CHECK(raster.size == Index3{turned ? 2 : 3, turned ? 3 : 2, int(count)});
                const std::vector<float>& right = upright[std::size_t(orientation - 1)];
                for (std::size_t i = 0; i < raster.values.size(); ++i)
                    CHECK(raster.values[i] == right[i % 6]);
                CHECK(said.notes.size() == (orientation == 1 ? 0 : 1));
            }
}

TEST_CASE("readTiff: a palette image is turned too, which libtiff converts", "[io][regression]") {
    test::TiffMaker maker;
    std::vector<int> colours(3 * 256, 0);
    for (std::size_t i = 0; i < colours.size(); ++i) colours[i] = int(i % 256) * 257;
    for (int orientation = 1; orientation <= 8; ++orientation) {
        Page page{2, 1, 8, std::string("\x05\x09", 2)};
        page.photometric = 3;
        page.fields = {maker.shorts(274, {orientation}), maker.shorts(320, colours)};
        const Raster raster = read({page});
        const bool swapped = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
        CAPTURE(orientation);
        REQUIRE(raster.channels == 3);
        CHECK(raster.size == (orientation > 4 ? Index3{1, 2, 1} : Index3{2, 1, 1}));
        CHECK(raster.values[0] == (swapped ? 9 : 5));
    }
}

TEST_CASE("readTiff: the size of cells by ImageJ", "[io][oracle]") {
    test::Said said;
    const Raster raster =
        read(pages(2, "ImageJ=1.53\nimages=2\nslices=2\nspacing=30\nunit=\\u00B5m\n"), said.ctx);
    CHECK(raster.size == Index3{2, 1, 2});
    CHECK(raster.knownSpacing);
    CHECK(raster.spacing.x == Approx(10));
    CHECK(raster.spacing.y == Approx(10));
    CHECK(raster.spacing.z == 30);
    CHECK(raster.unit == "um");
    CHECK(test::contains(said.all(), "cells of 10 x 10 x 30 um by its ImageJ description"));
    // No distance of slices.
    test::Said guess;
    CHECK(read(pages(2, "ImageJ=1\nimages=2\nunit=um\n"), guess.ctx).spacing.z == 1);
    CHECK(test::contains(guess.all(), "1 is taken"));
    // Nothing but pixels.
    test::Said none;
    CHECK_FALSE(read(pages(2, "ImageJ=1\nimages=2\n", 1, 1), none.ctx).knownSpacing);
    CHECK(none.all().empty());
    // No ImageJ: a resolution for print is no size.
    CHECK_FALSE(read(pages(2, "words")).knownSpacing);
    for (const std::uint32_t below : {0u, 1u}) {
        const Raster odd = read(pages(2, "ImageJ=1\nimages=2\nspacing=2\n", 0, below));
        CHECK(odd.spacing.x == 1);
        CHECK(odd.spacing.z == 2);
    }
}

TEST_CASE("readTiff: the size of cells by OME", "[io][oracle]") {
    const std::string text =
        "<OME><Pixels DimensionOrder=\"XYZCT\" SizeC=\"1\" SizeZ=\"2\" SizeT=\"1\" PhysicalSizeX=\"0.5\" "
        "PhysicalSizeY=\"0.25\"";
    const Raster raster = read(pages(2, text + " PhysicalSizeZ=\"2\"/></OME>"));
    CHECK(raster.spacing.x == 0.5);
    CHECK(raster.spacing.y == 0.25);
    CHECK(raster.spacing.z == 2);
    CHECK(raster.unit == "um");
    test::Said said;
    CHECK(read(pages(2, text + "/></OME>"), said.ctx).spacing.z == 0.5);
    CHECK(test::contains(said.all(), "that of columns is taken"));
}

TEST_CASE("readTiff: a channel by name, the first one by default", "[io][oracle]") {
    test::Said said;
    const Raster first = read(pages(4, kStack), said.ctx);
    CHECK(first.values == std::vector<float>{1, 1, 3, 3});
    CHECK(first.arrays == std::vector<std::string>{"channel1", "channel2"});
    CHECK(test::contains(said.all(), "holds channel1, channel2; channel1 is read; `grid` chooses another"));
    test::Said quiet;
    CHECK(read(pages(4, kStack), quiet.ctx, "channel2").values == std::vector<float>{2, 2, 4, 4});
    CHECK_FALSE(test::contains(quiet.all(), "is read"));
    const test::Thrown thrown = test::thrownBy([] { read(pages(4, kStack), {}, "channel3"); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "channel1, channel2"));
    // Channels and frames: one of the two names is enough.
    const std::string both = "ImageJ=1\nimages=8\nchannels=2\nslices=2\nframes=2\n";
    CHECK(read(pages(8, both), {}, "channel2-frame2").values == std::vector<float>{6, 6, 8, 8});
    CHECK(read(pages(8, both), {}, "channel2").values == std::vector<float>{2, 2, 4, 4});
    CHECK(read(pages(8, both), {}, "frame2").values == std::vector<float>{5, 5, 7, 7});
    // A channel of an image is an image.
    const Raster image = read(pages(2, "ImageJ=1\nimages=2\nchannels=2\n"));
    CHECK_FALSE(image.stack);
    CHECK(image.rowsFromTop);
    CHECK(read(pages(2, "ImageJ=1\nimages=2\nframes=2\n"), {}, "frame2").values == std::vector<float>{2, 2});
}

TEST_CASE("readTiff: pages of other sizes, by name", "[io][oracle]") {
    const std::vector<Page> made{{2, 2, 8, "abcd"}, {1, 1, 8, "e"}, {3, 1, 8, "fgh"}};
    CHECK(read(made).size == Index3{2, 2, 1});
    CHECK(read(made, {}, "page3").values == std::vector<float>{'f', 'g', 'h'});
    CHECK(read(made).arrays == std::vector<std::string>{"page1", "page2", "page3"});
    CHECK(test::contains(test::thrownBy([&] { read(made, {}, "page4"); }).message, "page1, page2, page3"));
}

TEST_CASE("readTiff: white is zero is undone, but for ImageJ", "[io][regression]") {
    Page page{2, 1, 8, std::string("\x00\x32", 2)};
    page.photometric = 0;
    CHECK(read({page, page}).values == std::vector<float>{255, 205, 255, 205});
    Page bits{2, 1, 1, "\x40"};
    bits.photometric = 0;
    CHECK(read({bits}).values == std::vector<float>{1, 0});
    page.fields = {test::TiffMaker::text(270, "ImageJ=1\nimages=2\n")};
    test::Said said;
    CHECK(read({page, page}, said.ctx).values == std::vector<float>{0, 50, 0, 50});
    CHECK(test::contains(said.all(), "inverting table"));
    // The no-data value is a stored one.
    Page holes{2, 1, 8, std::string("\x00\x32", 2)};
    holes.photometric = 0;
    holes.fields = {test::TiffMaker::text(42113, "0")};
    CHECK(std::isnan(read({holes}).values[0]));
    CHECK(read({holes}).values[1] == 205);
    Page real{1, 1, 16, std::string("\x05\x00", 2)};
    real.format = 2;
    real.photometric = 0;
    test::Said other;
    CHECK(read({real}, other.ctx).values == std::vector<float>{5});
    CHECK(test::contains(other.all(), "white is zero"));
}

TEST_CASE("readTiff: ImageJ's calibrated values", "[io][oracle]") {
    test::TiffMaker maker;
    Page page{2, 1, 16, maker.number(32768, 2) + maker.number(33768, 2)};
    page.fields = {test::TiffMaker::text(270, "ImageJ=1\nimages=1\ncf=0\nc0=-32768.0\nc1=1.0\n")};
    test::Said said;
    const Raster raster = read({page}, said.ctx);
    CHECK(raster.values == std::vector<float>{0, 1000});
    CHECK(raster.white == 0);
    CHECK(test::contains(said.all(), "-32768 + 1 times the stored ones"));
}

TEST_CASE("readTiff: a mask page is the opacity of its image", "[io][oracle]") {
    test::TiffMaker maker;
    Page mask{2, 1, 1, "\x40"};
    mask.photometric = 4;
    mask.fields = {maker.longs(254, {4})};
    const Raster raster = read({{2, 1, 8, "ab"}, mask});
    CHECK(std::isnan(raster.values[0]));
    CHECK(raster.values[1] == 'b');
    test::Said said;
    CHECK(read({{2, 1, 8, "ab"}, mask, {2, 1, 8, "cd"}}, said.ctx).size == Index3{2, 1, 2});
    CHECK(test::contains(said.all(), "not applied"));
}

TEST_CASE("readTiff: ImageJ's slices behind one page, in either byte order", "[io][regression]") {
    for (const bool bigEndian : {false, true}) {
        test::TiffMaker maker{bigEndian, /* tagsFirst= */ true};
        Page page{2, 1, 16, maker.number(1, 2) + maker.number(2, 2)};
        page.fields = {test::TiffMaker::text(270, "ImageJ=1\nimages=3\nslices=3\n")};
        std::string content = maker.file({page});
        for (const int value : {3, 4, 5, 600}) content += maker.number(std::uint64_t(value), 2);
        const Raster raster = read(content);
        CHECK(raster.size == Index3{2, 1, 3});
        CHECK(raster.values == std::vector<float>{1, 2, 3, 4, 5, 600});
        for (std::size_t cut = 1; cut < 8; ++cut)
            CHECK(test::thrownBy([&] { read(content.substr(0, content.size() - cut)); }).code ==
                  int(ErrorCode::BadData));
    }
}

TEST_CASE("readTiff: any length and any changed byte gives a raster or an error", "[io][hostile]") {
    test::TiffMaker maker;
    Page page{3, 2, 12, std::string(10, 'x')};
    page.fields = {maker.shorts(274, {6}), test::TiffMaker::text(270, kStack), maker.rational(282, 1, 10)};
    const std::string whole = maker.file({page, page, page, page});
    RunContext ctx;
    ctx.maxMemory = 100000000;
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const int change : {0x01, 0x80, 0xff}) {
            std::string changed = whole;
            changed[at] = char(changed[at] ^ change);
            for (const std::string& bytes : {whole.substr(0, at), changed}) {
                const test::Thrown thrown = test::thrownBy([&] { read(bytes, ctx); });
                const bool good = thrown.code == -1 || thrown.code == int(ErrorCode::BadData) ||
                                  thrown.code == int(ErrorCode::Memory);
                CHECK(good);
                for (const char c : thrown.message) CHECK((c >= ' ' && c <= '~'));
            }
        }
}
