#include "libvdbsynth/io/readers/tiff/tiff_contents.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;
using Page = test::TiffMaker::Page;

namespace {

using Numbers = std::vector<std::size_t>;

Page grey(int width, int height, const std::string& description = "") {
    Page page{width, height, 8, std::string(std::size_t(width * height), 'a')};
    if (!description.empty()) page.fields = {test::TiffMaker::text(270, description)};
    return page;
}

TiffContents contents(const std::vector<Page>& pages, const RunContext& ctx = {},
                      const std::string& array = "") {
    test::TiffMaker maker;
    const std::string content = maker.file(pages);
    TiffFile file("a.tif", content);
    return contentsOf("a.tif", file, {array}, ctx);
}

std::vector<std::string> namesOf(const TiffContents& all) {
    std::vector<std::string> names;
    for (const TiffChoice& choice : all.choices) names.push_back(choice.name);
    return names;
}

std::vector<Page> stack(std::size_t count, const std::string& description) {
    std::vector<Page> pages(count, grey(4, 3));
    pages[0] = grey(4, 3, description);
    return pages;
}

}  // namespace

TEST_CASE("contentsOf: one page, and a stack of equal ones, without a word", "[io][oracle]") {
    test::Said said;
    CHECK(contents({grey(4, 3)}, said.ctx).choices.size() == 1);
    const TiffContents all = contents(stack(5, ""), said.ctx);
    REQUIRE(all.choices.size() == 1);
    CHECK(all.choices[0].name.empty());
    CHECK(all.choices[0].pages == Numbers{0, 1, 2, 3, 4});
    CHECK(said.all().empty());
}

TEST_CASE("contentsOf: pages that halve are copies, others differ", "[io][oracle]") {
    test::Said said;
    const TiffContents mips =
        contents({grey(70, 80), grey(35, 40), grey(18, 20), grey(9, 10), grey(1, 1)}, said.ctx);
    CHECK(namesOf(mips) == std::vector<std::string>{"page1", "page2", "page3", "page4", "page5"});
    CHECK(mips.described == 1);
    CHECK(said.warnings.empty());
    REQUIRE(said.notes.size() == 1);
    CHECK(test::contains(said.notes[0], "page1 (70 x 80, 8 bits) is read; its smaller copies"));
    for (const auto& pages : {std::vector<Page>{grey(4, 3), grey(8, 6)},
                              {grey(70, 80), grey(30, 10)},
                              {grey(4, 3), grey(4, 3), grey(2, 2)}}) {
        test::Said differ;
        CHECK(contents(pages, differ.ctx).choices.back().name == "page" + std::to_string(pages.size()));
        REQUIRE(differ.warnings.size() == 1);
        CHECK(test::contains(differ.warnings[0], "its pages differ in size or kind"));
    }
    // A page chosen by name needs no word of the others.
    test::Said quiet;
    contents({grey(4, 3), grey(8, 6)}, quiet.ctx, "page2");
    CHECK(quiet.all().empty());
}

TEST_CASE("contentsOf: previews and masks are no slices", "[io][oracle]") {
    test::TiffMaker maker;
    Page preview = grey(4, 3), mask = grey(4, 3);
    preview.fields = {maker.longs(254, {1})};
    mask.fields = {maker.longs(254, {4})};
    test::Said said;
    const TiffContents all = contents({preview, grey(4, 3), mask, grey(4, 3)}, said.ctx);
    REQUIRE(all.choices.size() == 1);
    CHECK(all.choices[0].pages == Numbers{1, 3});
    CHECK(all.masks == Numbers{2});
    CHECK(test::contains(said.all(), "1 reduced page"));
    CHECK(contents({preview}).choices[0].pages == Numbers{0});  // better than nothing
}

TEST_CASE("contentsOf: channels and frames of ImageJ, OME and tifffile", "[io][oracle]") {
    const std::string ome =
        "<OME><Image><Pixels DimensionOrder=\"XYCZT\" SizeC=\"2\" SizeZ=\"3\" "
        "SizeT=\"1\"></Pixels></Image></OME>";
    for (const std::string& description : {std::string("ImageJ=1\nimages=6\nchannels=2\nslices=3\n"), ome,
                                           std::string("{\"shape\": [3, 2, 3, 4], \"axes\": \"ZCYX\"}")}) {
        test::Said said;
        const TiffContents all = contents(stack(6, description), said.ctx);
        CHECK(namesOf(all) == std::vector<std::string>{"channel1", "channel2"});
        CHECK(all.choices[0].pages == Numbers{0, 2, 4});
        CHECK(all.choices[1].pages == Numbers{1, 3, 5});
        CHECK(said.all().empty());  // which is read is said where it is read
    }
    const TiffContents all = contents(stack(8, "ImageJ=1\nimages=8\nchannels=2\nslices=2\nframes=2\n"));
    CHECK(namesOf(all) == std::vector<std::string>{"channel1-frame1", "channel2-frame1", "channel1-frame2",
                                                   "channel2-frame2"});
    CHECK(all.choices[2].pages == Numbers{4, 6});
}

TEST_CASE("contentsOf: frames of one slice are slices, each by name too", "[io][oracle]") {
    test::Said said;
    const TiffContents all = contents(stack(3, "ImageJ=1\nimages=3\nframes=3\n"), said.ctx);
    CHECK(namesOf(all) == std::vector<std::string>{"frames", "frame1", "frame2", "frame3"});
    CHECK(all.choices[0].pages == Numbers{0, 1, 2});
    CHECK(all.choices[2].pages == Numbers{1});
    CHECK(test::contains(said.all(), "the frames are read as slices"));
    const TiffContents colours = contents(stack(4, "ImageJ=1\nimages=4\nchannels=2\nframes=2\n"));
    CHECK(namesOf(colours) == std::vector<std::string>{"channel1", "channel2"});
    CHECK(colours.choices[1].pages == Numbers{1, 3});
}

TEST_CASE("contentsOf: a description that does not fit is said, and one stack read", "[io][error]") {
    for (const std::string& description :
         {std::string("ImageJ=1\nimages=9\nchannels=3\nslices=3\n"),
          std::string("<OME><Pixels SizeC=\"1\" SizeZ=\"9\" SizeT=\"1\"/></OME>")}) {
        test::Said said;
        const TiffContents all = contents(stack(4, description), said.ctx);
        REQUIRE(all.choices.size() == 1);
        CHECK(all.choices[0].pages.size() == 4);
        REQUIRE(said.warnings.size() == 1);
        CHECK(test::contains(said.warnings[0], "which its 4 pages are not"));
    }
    // One page of an image in several files.
    test::Said said;
    CHECK(contents({grey(4, 3, "<OME><Pixels SizeC=\"1\" SizeZ=\"9\" SizeT=\"1\"/></OME>")}, said.ctx)
              .choices.size() == 1);
    CHECK(said.warnings.size() == 1);
}

TEST_CASE("contentsOf: samples that are no colours are channels", "[io][oracle]") {
    Page bands = grey(2, 1);
    bands.samples = 5;
    bands.pixels = "abcdefghij";
    const TiffContents five = contents({bands});
    REQUIRE(five.choices.size() == 5);
    CHECK(five.choices[4].name == "channel5");
    CHECK(five.choices[4].samples.first == 4);
    bands.photometric = 2;
    CHECK(namesOf(contents({bands}))[0] == "colour");
    CHECK(contents({bands}).choices.size() == 6);
    test::TiffMaker maker;
    bands.samples = 4;
    bands.pixels.resize(8);
    bands.fields = {maker.shorts(338, {2})};
    CHECK(contents({bands}).choices.size() == 1);  // opacity is no channel
}

TEST_CASE("contentsOf: ImageJ's slices behind one page", "[io][regression]") {
    test::TiffMaker maker;
    maker.tagsFirst = true;
    const std::string content = maker.file({grey(2, 2, "ImageJ=1\nimages=3\nslices=3\n")}) + "bbbbcccc";
    TiffFile file("a.tif", content);
    const TiffContents all = contentsOf("a.tif", file, {}, {});
    CHECK(all.raw);
    CHECK(all.choices[0].pages == Numbers{0, 1, 2});
    const std::string shorter = content.substr(0, content.size() - 1);
    TiffFile less("a.tif", shorter);
    const test::Thrown thrown = test::thrownBy([&] { contentsOf("a.tif", less, {}, {}); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "truncated"));
    test::Said said;
    CHECK_FALSE(contents({grey(2, 2, "ImageJ=1\nimages=16000000\n")}, said.ctx).raw);
    CHECK(test::contains(said.all(), "one page, which is read alone"));
}
