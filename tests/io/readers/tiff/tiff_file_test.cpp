#include "libvdbsynth/io/readers/tiff/tiff_file.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;
using Page = test::TiffMaker::Page;

TEST_CASE("TiffFile: what tags say of a page, in either byte order", "[io][oracle]") {
    for (const bool bigEndian : {false, true})
        for (const bool tagsFirst : {false, true}) {
            test::TiffMaker maker{bigEndian, tagsFirst};
            Page page{3, 2, 16, maker.number(1, 2) + maker.number(515, 2) + std::string(8, '\0')};
            page.fields = {maker.shorts(274, {6}),
                           maker.rational(282, 1, 10),
                           maker.rational(283, 1, 20),
                           maker.shorts(296, {3}),
                           test::TiffMaker::text(270, "words"),
                           maker.doubles(33550, {1.5, 2.5, 0}),
                           maker.shorts(34735, {1, 1, 0, 1, 1024, 0, 1, 2}),
                           test::TiffMaker::text(42113, "-1")};
            const std::string content = maker.file({page, page});
            TiffFile file("a", content);
            REQUIRE(file.pages().size() == 2);
            CHECK(file.fileBytes() == content.size());
            CHECK(file.bigEndian() == bigEndian);
            const TiffPage& first = file.pages()[0];
            CHECK(first.width == 3);
            CHECK(first.height == 2);
            CHECK(first.bits == 16);
            CHECK(first.samples == 1);
            CHECK(first.orientation == 6);
            CHECK(first.resolution[0] == Approx(0.1));
            CHECK(first.resolution[1] == Approx(0.05));
            CHECK(first.resolutionUnit == 3);
            CHECK_FALSE(first.compressed);
            CHECK((first.directoryOffset < first.dataOffset) == tagsFirst);
            CHECK(content.compare(first.dataOffset, page.pixels.size(), page.pixels) == 0);
            CHECK(first.matches(file.pages()[1]));
            for (const std::size_t number : {1, 0, 1}) {
                file.select(number);
                CHECK(file.text(TiffTag::Description) == "words");
                CHECK(file.text(TiffTag::NoData) == "-1");
                CHECK(file.reals(TiffTag::PixelScale) == std::vector<double>{1.5, 2.5, 0});
                CHECK(file.reals(TiffTag::TiePoint).empty());
                CHECK(file.shorts(TiffTag::GeoKeys).size() == 8);
                CHECK(file.shorts(TiffTag::PixelScale).empty());  // of another type
                CHECK(file.pieceBytes() == 12);
                std::uint16_t values[6] = {};
                CHECK(file.readPiece(0, reinterpret_cast<char*>(values), sizeof values) == 12);
                CHECK(values[0] == 1);
                CHECK(values[1] == 515);
            }
        }
}

TEST_CASE("TiffFile: previews, masks, opacity and planes", "[io][oracle]") {
    test::TiffMaker maker;
    const Page plain{1, 1, 8, "a"};
    Page preview = plain, mask = plain, alpha{1, 1, 8, "abcd"};
    preview.fields = {maker.longs(254, {1})};
    mask.fields = {maker.longs(254, {4})};
    alpha.samples = 4;
    alpha.photometric = 2;
    alpha.fields = {maker.shorts(338, {2})};
    const std::string content = maker.file({plain, preview, mask, alpha});
    const TiffFile file("a", content);
    REQUIRE(file.pages().size() == 4);
    CHECK_FALSE(file.pages()[0].reduced);
    CHECK(file.pages()[1].reduced);
    CHECK(file.pages()[2].mask);
    CHECK(file.pages()[3].alpha);
    CHECK(file.pages()[3].colour == TiffColour::Rgb);
    CHECK_FALSE(file.pages()[3].matches(file.pages()[0]));
}

TEST_CASE("TiffFile: nonsense is refused in printable words", "[io][error]") {
    for (const std::string& content :
         {std::string(), std::string("II*"), std::string(50, '\xff'), std::string("II*\0\xff\xff\xff\xff", 8),
          std::string("MM\0*\0\0\0\x08\0", 9)}) {
        const test::Thrown thrown = test::thrownBy([&] { TiffFile("a.tif", content); });
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.tif: not a TIFF image"));
        for (const char c : thrown.message) CHECK((c >= ' ' && c <= '~'));
    }
    test::TiffMaker maker;
    const std::string two = maker.file({{1, 1, 8, "a"}, {1, 1, 8, "b"}});
    const test::Thrown thrown = test::thrownBy([&] { TiffFile("a.tif", two.substr(0, two.size() - 30)); });
    CHECK(test::contains(thrown.message, "truncated after page 1"));
}
