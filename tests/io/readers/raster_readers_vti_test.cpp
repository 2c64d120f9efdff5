// VTK ImageData: directions, cells, pieces, the choice of arrays, what is refused.
#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/raster/raster_alignment.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/raster_reading.h"

using namespace vdbsynth;

namespace {

using Floats = std::vector<float>;
using Names = std::vector<std::string>;

std::string image(const std::string& attributes, const std::string& pieces, const std::string& root = "") {
    return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" " + root +
           "><ImageData " + attributes + ">" + pieces + "</ImageData></VTKFile>";
}

std::string piece(const std::string& extent, const std::string& points, const std::string& cells = "",
                  const std::string& marked = "") {
    return "<Piece Extent=\"" + extent + "\"><PointData " + marked + ">" + points + "</PointData><CellData>" +
           cells + "</CellData></Piece>";
}

std::string array(const std::string& name, const std::string& values, int components = 1,
                  const std::string& type = "Float32") {
    return "<DataArray Name=\"" + name + "\" type=\"" + type + "\" NumberOfComponents=\"" +
           std::to_string(components) + "\" format=\"ascii\">" + values + "</DataArray>";
}

using Read = test::RasterReading;

Read reading(const std::string& content, const std::string& name = "") {
    return test::readRasterBy(readVti, "a.vti", content, name);
}

const std::string kLine = "WholeExtent=\"0 2 0 0 0 0\" ";

}  // namespace

TEST_CASE("readVti: the direction matrix mirrors, exchanges and turns the axes", "[io][oracle]") {
    const std::string data = piece("0 2 0 1 0 0", array("v", "0 1 2 3 4 5"));
    const std::string place = "WholeExtent=\"0 2 0 1 0 0\" Origin=\"100 200 300\" Spacing=\"1 2 3\" ";
    Raster r = reading(image(place + "Direction=\"-1 0 0 0 -1 0 0 0 1\"", data)).raster;
    CHECK(r.values == Floats{5, 4, 3, 2, 1, 0});
    CHECK(r.origin.x == 98);
    CHECK(r.origin.y == 198);
    CHECK(r.origin.z == 300);
    CHECK(r.stack);
    // Row by row: columns run along y, rows along z, slices along x.
    r = reading(image(place + "Direction=\"0 0 1 1 0 0 0 1 0\"", data)).raster;
    CHECK(r.size == Index3{1, 3, 2});
    CHECK(r.spacing.x == 3);
    CHECK(r.spacing.y == 1);
    CHECK(r.spacing.z == 2);
    CHECK(r.values == Floats{0, 1, 2, 3, 4, 5});
    const Read turned = reading(image(place + "Direction=\"0.8 -0.6 0 0.6 0.8 0 0 0 1\"", data));
    CHECK(turned.raster.axes[0].x == Approx(0.8));
    CHECK(turned.raster.axes[0].y == Approx(0.6));
    CHECK(test::contains(turned.said, "turned by 36.9 degrees"));
}

TEST_CASE("readVti: an extent that begins elsewhere moves the samples, in all digits of the origin",
          "[io][oracle]") {
    const Read read =
        reading(image("WholeExtent=\"10 12 -3 -3 4 4\" Origin=\"500000.25 5000000.125 1\" "
                      "Spacing=\"0.5 0.5 0.5\" Direction=\"-1 0 0 0 1 0 0 0 1\"",
                      piece("10 12 -3 -3 4 4", array("v", "7 8 9"))));
    CHECK(read.raster.origin.x == 500000.25 - 6);
    CHECK(read.raster.origin.y == 5000000.125 - 1.5);
    CHECK(read.raster.origin.z == 3);
    CHECK(read.raster.values == Floats{9, 8, 7});
}

TEST_CASE("readVti: values of cells lie between the points, which is said", "[io][oracle]") {
    const Read read = reading(image("WholeExtent=\"0 2 0 1 0 2\" Spacing=\"1 2 4\" Origin=\"0 0 0\"",
                                    piece("0 2 0 1 0 2", "", array("c", "1 2 3 4"))));
    CHECK(read.raster.size == Index3{2, 1, 2});
    CHECK(read.raster.origin.x == 0.5);
    CHECK(read.raster.origin.y == 1);
    CHECK(read.raster.origin.z == 2);
    CHECK(test::contains(read.said, "c holds values of cells"));
    // A flat image has one layer of cells, in its plane; its thickness may be zero.
    const Read flat = reading(
        image("WholeExtent=\"0 2 0 1 0 0\" Spacing=\"1 2 0\"", piece("0 2 0 1 0 0", "", array("c", "1 2"))));
    CHECK(flat.raster.size == Index3{2, 1, 1});
    CHECK(flat.raster.origin.z == 0);
    CHECK(flat.raster.spacing.z == 1);
}

TEST_CASE("readVti: the marked scalars, else the first, of points before cells, or the named array",
          "[io][oracle]") {
    const std::string points = array("velocity", "3 4 0 0 0 1 2 2 1", 3) + array("a", "1 2 3") +
                               array("vtkGhostType", "0 0 0", 1, "UInt8") + array("b", "4 5 6", 1, "Int16");
    const std::string cells = array("a", "8 9") + array("c", "1 2");
    const auto file = [&](const std::string& marked) {
        return image(kLine, piece("0 2 0 0 0 0", points, cells, marked));
    };
    Read read = reading(file(""));
    CHECK(read.raster.values == Floats{1, 2, 3});
    CHECK(read.raster.arrays == Names{"velocity", "a", "vtkGhostType", "b", "cells:a", "c"});
    CHECK(test::contains(read.said, "a is read; `grid` chooses another"));
    CHECK(reading(file("Scalars=\"b\"")).raster.values == Floats{4, 5, 6});
    CHECK(reading(file("Scalars=\"velocity\"")).raster.values == Floats{1, 2, 3});
    CHECK(reading(file(""), "cells:a").raster.values == Floats{8, 9});
    read = reading(file(""), "velocity");
    CHECK(read.raster.values == Floats{5, 1, 3});
    CHECK(test::contains(read.said, "vectors of 3 components; their lengths are read"));
    CHECK(test::contains(reading(file(""), "speed").thrown.message, "`grid` speed: not in a.vti"));
    const std::string ghosts = array("vtkGhostType", "0 0 0", 1, "UInt8");
    CHECK(reading(image(kLine, piece("0 2 0 0 0 0", ghosts, cells))).raster.values == Floats{8, 9});
    const std::string nameless = "<DataArray type=\"Int8\" format=\"ascii\">1 nan -3</DataArray>";
    read = reading(image(kLine, piece("0 2 0 0 0 0", nameless)));
    CHECK(read.raster.arrays == Names{"array1"});
    CHECK(std::isnan(read.raster.values[1]));
}

TEST_CASE("readVti: pieces are put together, gaps are said", "[io][oracle]") {
    const std::string whole = "WholeExtent=\"0 3 0 1 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
    const std::string left = piece("0 1 0 1 0 0", array("v", "0 1 4 5"), array("c", "10")),
                      right = piece("1 3 0 1 0 0", array("v", "1 2 3 5 6 7"), array("c", "11 12"));
    Read read = reading(image(whole, left + right));
    CHECK(read.raster.values == Floats{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(reading(image(whole, right + left)).raster.values == Floats{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(reading(image(whole, left + right), "c").raster.values == Floats{10, 11, 12});
    read = reading(image(whole, left + piece("3 3 0 1 0 0", array("v", "3 7"), array("c", "0"))));
    CHECK(std::isnan(read.raster.at(2, 0, 0)));
    CHECK(test::contains(read.said, "2 samples without data"));
    read = reading(image(whole, left + piece("1 3 0 1 0 0", array("w", "1 2 3 5 6 7"), array("c", "11 12"))));
    CHECK(test::contains(read.thrown.message, "different arrays"));
    read = reading(image(whole, left + piece("3 3 0 1 0 0", array("v", "3 7"), array("c", "0"))), "c");
    CHECK(test::contains(read.thrown.message, "flat beside others"));
    std::string same;
    for (int i = 0; i < 9; ++i) same += left;
    CHECK(test::contains(reading(image(whole, same)).thrown.message, "overlap"));
}

TEST_CASE("readVti: both byte orders, headers of 32 and 64 bits", "[io][oracle]") {
    for (const bool big : {false, true})
        for (const bool wide : {false, true}) {
            std::string bytes;
            const auto add = [&](std::uint64_t value, int size) {
                for (int i = 0; i < size; ++i) bytes += char(value >> 8 * (big ? size - 1 - i : i) & 255);
            };
            add(6, wide ? 8 : 4);
            for (const int value : {1, 256, 65535}) add(std::uint64_t(value), 2);
            const std::string content =
                "<VTKFile type=\"ImageData\" byte_order=\"" + std::string(big ? "Big" : "Little") +
                "Endian\"" + (wide ? " header_type=\"UInt64\"" : "") + "><ImageData " + kLine + ">" +
                piece("0 2 0 0 0 0",
                      "<DataArray type=\"UInt16\" Name=\"v\" format=\"appended\" offset=\"0\"/>") +
                "</ImageData><AppendedData encoding=\"raw\">_" + bytes + "</AppendedData></VTKFile>";
            CHECK(reading(content).raster.values == Floats{1, 256, 65535});
        }
}

TEST_CASE("readVti: what is not read is refused by name, without bytes of the file", "[io][error]") {
    const auto refused = [](const std::string& content, const std::string& words) {
        const test::Thrown thrown = reading(content).thrown;
        CAPTURE(words, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.vti: "));
        CHECK(test::contains(thrown.message, words));
        for (const char c : thrown.message) CHECK(c >= ' ');
    };
    const std::string good = piece("0 2 0 0 0 0", array("v", "1 2 3"));
    for (const char* name : {"vtkLZ4DataCompressor", "vtkLZMADataCompressor"})
        refused(image(kLine, good, "compressor=\"" + std::string(name) + "\""), name);
    refused("<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid/></VTKFile>", "kind UnstructuredGrid");
    refused("<VTKFile type=\"\x01\xff\"/>", "kind ??");
    refused("<VTKFile type=\"ImageData\"/>", "not a VTK image");
    refused(image(kLine, piece("0 2 0 0 0 0", "")), "has no data array");
    refused(image(kLine, piece("0 2 0 0 0 0", array("u", "1 2 3 4 5 6", 2))), "`grid` u reads their lengths");
    refused(image(kLine, piece("0 2 0 0 0 0", array("u", "1", 0))), "0 components");
    refused(image(kLine, piece("0 2 0 0 0 0", array("u", "1", 2000000000))), "components");
    refused(image(kLine, piece("0 2 0 0 0 0", array("s", "a", 1, "String"))), "type String");
    refused(image(kLine, piece("0 2 0 0 0 0", array("v", "1 2 x\x02"))), "\"x?\", which is not a number");
    refused(image(kLine, piece("0 2 0 0 0 0", array("v", "1 2"))), "truncated");
    refused(image(kLine + "Direction=\"1 0 0\"", good), "Direction must be nine");
    refused(image(kLine + "Direction=\"1 0 0 1 0 0 0 0 1\"", good), "singular");
    refused(image(kLine + "Origin=\"nan 0 0\"", good), "Origin must be three");
    refused(image(kLine + "Spacing=\"0 1 1\"", good), "singular");
    refused(image(kLine, piece("0 99999 0 99999 0 99999", array("v", "1"))), "truncated");
    refused(image(kLine, good + piece("1000000 1000000 0 0 1000000 1000000", array("v", "1"))), "truncated");
    std::string many;
    for (int i = 0; i < 5000; ++i) many += good;
    refused(image(kLine, many), "over 4096 pieces");
}
