#include "libvdbsynth/io/readers/tiff/stack_description.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

using Kind = StackDescription::Kind;
using Pages = std::vector<std::size_t>;

StackDescription parse(const std::string& text) {
    return parseStackDescription(text, 60, 40);
}

std::string ome(const std::string& attributes, const std::string& inside = "") {
    return "<?xml version=\"1.0\"?><OME xmlns=\"x\" UUID=\"urn:uuid:1\"><Image ID=\"0\"><Pixels ID=\"0\" " +
           attributes + ">" + inside + "</Pixels></Image></OME>";
}

}  // namespace

TEST_CASE("parseStackDescription: ImageJ's lines", "[io][oracle]") {
    const StackDescription d = parse(
        "ImageJ=1.53c\nimages=24\nchannels=2\nslices=4\nframes=3\nhyperstack=true\nspacing=-30.5\nunit="
        "micron\n"
        "cf=0\nc0=-32768.0\nc1=2.5\nvunit=gray value\n");
    CHECK(d.kind == Kind::ImageJ);
    CHECK(d.images == 24);
    CHECK(d.channels == 2);
    CHECK(d.slices == 4);
    CHECK(d.frames == 3);
    CHECK(d.order == "CZT");
    CHECK(d.spacing[2] == 30.5);
    CHECK(d.unit == "um");
    CHECK(d.calibrated);
    CHECK(d.calibrationOffset == -32768);
    CHECK(d.calibrationFactor == 2.5);
    const StackDescription plain = parse("ImageJ=1.11a\r\nimages=7\r\n");
    CHECK(plain.images == 7);
    CHECK(plain.slices == 7);
    CHECK_FALSE(plain.calibrated);
    // A curve of densities is no straight line.
    CHECK_FALSE(parse("ImageJ=1\ncf=20\nc0=3\nc1=4\n").calibrated);
}

TEST_CASE("parseStackDescription: units in the ways that files write them", "[io][oracle]") {
    for (const char* unit :
         {"um", "micron", "microns", "\\u00B5m", "\\u00b5m", "\xc2\xb5m", "\xce\xbcm", "\xb5m", "&#181;m"})
        CHECK(parse(std::string("ImageJ=1\nunit=") + unit).unit == "um");
    CHECK(parse("ImageJ=1\nunit=mm").unit == "mm");
    CHECK(parse("ImageJ=1\nunit=inch").unit == "in");
    for (const char* unit : {"pixel", "pixels", "", " ", "\x01\x02", "aVeryLongWordThatIsNoUnit"})
        CHECK(parse(std::string("ImageJ=1\nunit=") + unit).unit.empty());
}

TEST_CASE("parseStackDescription: OME's attributes, with and without a namespace", "[io][oracle]") {
    const std::string attributes =
        "DimensionOrder=\"XYZCT\" SizeX=\"60\" SizeY=\"40\" SizeC=\"2\" SizeZ=\"16\" SizeT=\"3\" "
        "PhysicalSizeX=\"0.5\" PhysicalSizeY = '0.25' PhysicalSizeZ=\"2\" PhysicalSizeXUnit=\"nm\"";
    for (const std::string& text :
         {ome(attributes), "<ome:OME xmlns:ome=\"x\"><ome:Pixels " + attributes + "/></ome:OME>"}) {
        const StackDescription d = parse(text);
        CHECK(d.kind == Kind::Ome);
        CHECK(d.order == "ZCT");
        CHECK(d.channels == 2);
        CHECK(d.slices == 16);
        CHECK(d.frames == 3);
        CHECK(d.spacing[0] == 0.5);
        CHECK(d.spacing[1] == 0.25);
        CHECK(d.spacing[2] == 2);
        CHECK(d.unit == "nm");
    }
    CHECK(parse(ome("PhysicalSizeX=\"1\"")).unit == "um");  // OME's default
    CHECK(parse(ome("SizeC=\"1\"")).unit.empty());
    CHECK(parse("<OME></OME>").kind == Kind::None);
}

TEST_CASE("parseStackDescription: where OME says that planes are", "[io][oracle]") {
    const StackDescription d =
        parse(ome("SizeC=\"2\" SizeZ=\"2\" SizeT=\"1\" DimensionOrder=\"XYCZT\"",
                  "<TiffData IFD=\"3\" FirstC=\"0\" FirstZ=\"0\" FirstT=\"0\"/>"
                  "<TiffData IFD=\"2\" FirstC=\"1\"><UUID FileName=\"a\">u</UUID></TiffData>"
                  "<TiffData IFD=\"0\" FirstZ=\"1\" PlaneCount=\"2\"/>"));
    REQUIRE(d.blocks.size() == 3);
    CHECK_FALSE(d.severalFiles);
    CHECK(planePages(d, 4, 1) == Pages{3, 0, 2, 1});
    const std::string two =
        "<TiffData><UUID FileName=\"a\"/></TiffData><TiffData><UUID FileName=\"b\"/></TiffData>";
    CHECK(parse(ome("SizeZ=\"2\"", two)).severalFiles);
    CHECK(planePages(parse(ome("SizeZ=\"2\"", two)), 2, 1).empty());
}

TEST_CASE("parseStackDescription: tifffile's shape", "[io][oracle]") {
    CHECK(parse("{\"shape\": [40, 60]}").kind == Kind::None);
    CHECK(parse("{\"shape\": [40, 60, 3]}").kind == Kind::None);
    const StackDescription d = parse("{\"shape\": [2, 16, 40, 60]}");
    CHECK(d.kind == Kind::Shape);
    CHECK(d.channels == 2);
    CHECK(d.slices == 16);
    CHECK(d.order == "ZCT");
    const StackDescription named = parse("{\"shape\": [5, 16, 2, 40, 60], \"axes\": \"TZCYX\"}");
    CHECK(named.channels == 2);
    CHECK(named.slices == 16);
    CHECK(named.frames == 5);
    CHECK(named.order == "CZT");
    CHECK(parse("{\"shape\": [1, 7, 1, 40, 60]}").channels * parse("{\"shape\": [1, 7, 40, 60]}").slices ==
          7);
    CHECK(parse("{\"shape\": [2, 2, 2, 2, 40, 60]}").kind == Kind::None);
    for (const char* text :
         {"{", "{\"shape\"", "{\"shape\": [", "{\"shape\": ]3[", "{\"shape\": [a, 40, 60]}"})
        CHECK(parse(text).kind == Kind::None);
}

TEST_CASE("planePages: by hand, in every order", "[io][oracle]") {
    StackDescription d;
    d.kind = Kind::ImageJ;
    d.channels = 2;
    d.slices = 2;
    d.frames = 1;
    CHECK(planePages(d, 4, 1) == Pages{0, 2, 1, 3});
    d.order = "ZCT";
    CHECK(planePages(d, 4, 1) == Pages{0, 1, 2, 3});
    d.frames = 2;
    d.order = "TCZ";
    CHECK(planePages(d, 8, 1) == Pages{0, 4, 2, 6, 1, 5, 3, 7});
    d.order = "CZT";
    d.frames = 1;
    d.channels = 6;  // three samples a page
    CHECK(planePages(d, 4, 3) == Pages{0, 2, 1, 3});
}

TEST_CASE("planePages: what does not fit the pages gives none", "[io][error]") {
    StackDescription d;
    CHECK(planePages(d, 1, 1).empty());
    d.kind = Kind::Ome;
    d.slices = 3;
    CHECK(planePages(d, 2, 1).empty());
    CHECK(planePages(d, 4, 1).empty());
    CHECK(planePages(d, 3, 0).empty());
    d.order = "ZZT";
    CHECK(planePages(d, 3, 1).empty());
    d.order = "CZT";
    d.blocks.push_back({1, 0, 0, 0, 0});
    CHECK(planePages(d, 3, 1).empty());  // the last plane is not in the file
    d.blocks = {{0, 1 << 24, 1 << 24, 1 << 24, 1 << 24}};
    CHECK(planePages(d, 3, 1).empty());
    d.blocks.clear();
    d.channels = d.slices = d.frames = 1 << 24;
    CHECK(planePages(d, 1000, 1).empty());
    d.channels = 0;
    CHECK(planePages(d, 0, 1).empty());
}

TEST_CASE("parseStackDescription: hostile texts take time in proportion to their length", "[io][hostile]") {
    std::string names = "<OME ", elements = "<OME><Pixels ", deep = "<OME><Pixels SizeC=\"1\">";
    for (int i = 0; i < 200000; ++i) {
        names += "a:Pixels ";
        elements += "SizeC ";
        deep += "<TiffData IFD=\"1\"/>";
    }
    CHECK(parse(names).kind == Kind::None);
    CHECK(parse(elements).channels == 1);
    CHECK(planePages(parse(deep), 2, 1) == Pages{1});
    for (const char* text :
         {"ImageJ=", "ImageJ=\n\n=\n=5\nimages=", "ImageJ=1\nimages=-4\nchannels=99999999999999\nspacing=nan",
          "<OME><Pixels SizeC=\"", "<OME><Pixels SizeC=", "<OME><Pixels",
          "<OME><Pixels SizeC=\"-1\" SizeZ=\"x\">"}) {
        const StackDescription d = parse(text);
        CHECK(d.channels == 1);
        CHECK(d.spacing[2] == 0);
    }
}
