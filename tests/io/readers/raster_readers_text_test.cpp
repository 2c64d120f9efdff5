// GSLIB in the dialects of its writers, and INRIMAGE.
#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/raster_reading.h"

using namespace vdbsynth;

namespace {

using Floats = std::vector<float>;

using Read = test::RasterReading;

Read gslib(const std::string& content, const std::string& name = "") {
    return test::readRasterBy(readGslib, "a", content, name);
}

Read inr(const std::string& fields, const std::string& data, const std::string& name = "",
         const std::string& end = "##}\n") {
    return test::readRasterBy(readInr, "a", "#INRIMAGE-4#{\n" + fields + end + data, name);
}

const std::string kBytes = "TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\n";

}  // namespace

TEST_CASE("readGslib: of several variables the first or the named one", "[io][oracle]") {
    const std::string content =
        "3 1 2\r\n2\r\n facies \r\nporosity (%)\r\n0 9\r\n1 8\r\n2 7\r\n3 6\r\n4 5\r\n5 4\r\n";
    Read read = gslib(content);
    CHECK(read.raster.values == Floats{0, 1, 2, 3, 4, 5});
    CHECK(read.raster.arrays == std::vector<std::string>{"facies", "porosity (%)"});
    CHECK(test::contains(read.said, "facies is read; `grid` chooses another"));
    CHECK_FALSE(read.raster.knownSpacing);
    CHECK(gslib(content, "porosity (%)").raster.values == Floats{9, 8, 7, 6, 5, 4});
    CHECK(test::contains(gslib(content, "x").thrown.message, "`grid` x: not in a"));
}

TEST_CASE("readGslib: SGeMS's title holds the sizes, and its mark of no data is none", "[io][oracle]") {
    const Read read = gslib("grid 1 (2x1x2)\n1\nv\n0.5\n-9966699\nnan\n2\n");
    CHECK(read.raster.size == Index3{2, 1, 2});
    CHECK(std::isnan(read.raster.values[1]));
    CHECK(std::isnan(read.raster.values[2]));
    CHECK(test::contains(read.said, "1 cells hold -9966699"));
}

TEST_CASE("readGslib: spacing and origin behind the sizes, in either order, are used and said",
          "[io][oracle]") {
    for (const char* line : {"2 1 2 10 20 4 -5 0 100", "2 1 2 -5 0 100 10 20 4"}) {
        const Read read = gslib(std::string(line) + "\n1\nv\n0\n1\n2\n3\n");
        CHECK(read.raster.knownSpacing);
        CHECK(read.raster.spacing.y == 20);
        CHECK(read.raster.origin.x == 0);  // the centre of a cell
        CHECK(read.raster.origin.z == 102);
        CHECK(test::contains(read.said, "a spacing of 10 20 4 and an origin of -5 0 100"));
    }
    CHECK(gslib("2 1 2 1 1 2\n1\nv\n0\n1\n2\n3\n").raster.origin.z == 1);
    CHECK(test::contains(gslib("2 1 2 100\n1\nv\n0\n1\n2\n3\n").said, "1 numbers behind its sizes"));
    CHECK(test::contains(gslib("2 1 2 0 1 1 0 0 0\n1\nv\n0\n1\n2\n3\n").thrown.message, "not above 0"));
}

TEST_CASE("readGslib: more values than the sizes say are a warning, fewer an error", "[io][error]") {
    CHECK(test::contains(gslib("2 1 1\n1\nv\n0\n1\n2\n3\n").said, "more values"));
    for (const auto& [content, words] : {std::pair{"3 1 1\n1\nv\n0\n1\n", "truncated"},
                                         {"title\n1\nv\n0\n", "NX NY NZ"},
                                         {"title (2x)\n1\nv\n0\n", "NX NY NZ"},
                                         {"t (2x2x9999999999999999999)\n1\nv\n0\n", "NX NY NZ"},
                                         {"t (4294967296x4294967296x2)\n1\nv\n0\n", "truncated"},
                                         {"2 1 1\n0\nv\n0\n1\n", "number of variables"},
                                         {"2 1 1\n1\nv\n0\nx\x01\n", "\"x?\" is not a number"}}) {
        const test::Thrown thrown = gslib(content).thrown;
        CAPTURE(words, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, words));
    }
}

TEST_CASE("readInr: origin, components, line ends, what is left out is said", "[io][oracle]") {
    const std::string sides = "XDIM=2\nYDIM=1\nZDIM=1\n" + kBytes;
    Read read = inr(sides + "VX=0.5\nVY=2\nVZ=2\nTX=-10.25\nTZ=7\nRX=0\n", "\3\4");
    CHECK(read.raster.values == Floats{3, 4});
    CHECK(read.raster.spacing.x == 0.5);
    CHECK(read.raster.origin.x == -10.25);
    CHECK(read.raster.origin.z == 7);
    CHECK(read.said.empty());
    CHECK(test::contains(inr(sides + "RZ=90\n", "\3\4").said, "rotation"));
    CHECK(test::contains(inr(sides + "SCALE=2**-8\n", "\3\4").said, "SCALE"));
    const std::string crlf = "XDIM=2\r\nYDIM = 1\r\nZDIM=1\r\nTYPE=unsigned fixed\r\nPIXSIZE=8 bits\r\n";
    CHECK(inr(crlf, "\3\4", "", "##}\r\n").raster.values == Floats{3, 4});
    read = inr(sides + "VDIM=2\n", "\1\2\3\4");
    CHECK(read.raster.values == Floats{1, 3});
    CHECK(test::contains(read.said, "component1 is read"));
    CHECK(inr(sides + "VDIM=2\n", "\1\2\3\4", "component2").raster.values == Floats{2, 4});
    CHECK(test::contains(inr(sides + "VDIM=2000\n", "\1\2").thrown.message, "1 to 1000"));
    CHECK(test::contains(inr(sides + "VDIM=3\n", "\1\2\3\4").thrown.message, "truncated"));
    CHECK(test::contains(inr("XDIM=2\nTYPE=\x01\x02\n", "\1").thrown.message, "type ?? of"));
}
