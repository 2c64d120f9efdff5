#include "libvdbsynth/io/points/point_readers.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include "tests/support/makers.h"
#include "tests/support/point_contents.h"
#include "tests/support/raster_files.h"

using namespace vdbsynth;

namespace {

std::string pcdHeader(const std::string& fields, const std::string& sizes, const std::string& types,
                      const std::string& counts, const std::string& rest) {
    return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts +
           "\n" + rest;
}

std::string ply(const std::string& elements, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}
const std::string kVertex = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

using test::equal;

}  // namespace

TEST_CASE("readRows: what three columns mean, and numbers that are none stay", "[io][oracle]") {
    const PointContent plain = readRows("a", "1 2 3\n4;5;nan\n");
    REQUIRE(plain.points.size() == 2);  // readPoints drops the second
    CHECK(std::isnan(plain.points[1].z));
    CHECK(plain.normals.empty());
    // All rows decide: one that is no unit vector makes them colours, one over 255 neither.
    const PointContent colours = readRows("a", "0 0 0 0 0 1\n0 0 0 0 0 2\n");
    CHECK(colours.normals.empty());
    CHECK(colours.attributes.size() == 1);
    const PointContent other = readRows("a", "0 0 0 0 0 1\n0 0 0 0 0 256\n");
    CHECK(other.normals.empty());
    CHECK(other.attributes.empty());
    const PointContent last = readRows("a", "7 8 9 255 0 0 0.6 0.8 0\n");
    REQUIRE(last.normals.size() == 1);
    CHECK(equal(last.normals[0], {0.6f, 0.8f, 0}));
    CHECK(last.attributes.size() == 1);
    CHECK(readRows("a", "# nothing\n\n").points.empty());
}

TEST_CASE("readRows: a count, that many points and that many normals", "[io][oracle]") {
    const PointContent both = readRows("a", "2\n0 0 0\n1 2 3\n0 0 1\n0 1 0\n");
    REQUIRE(both.points.size() == 2);
    CHECK(equal(both.points[1], {1, 2, 3}));
    REQUIRE(both.normals.size() == 2);
    CHECK(equal(both.normals[1], {0, 1, 0}));
    const PointContent points = readRows("a", "2\n0 0 0\n1 2 3\n");
    CHECK(points.points.size() == 2);
    CHECK(points.normals.empty());
    for (const char* content :
         {"2\n0 0 0\n1 2\n", "0\n", "-2\n1 2 3\n", "1.5\n1 2 3\n1 2 3\n", "1e9\n1 2 3\n"}) {
        CAPTURE(content);
        CHECK(test::thrownBy([&] { readRows("a", content); }).code == int(ErrorCode::BadData));
    }
}

TEST_CASE("readRows: decimal commas, and the note that says so", "[io][hand]") {
    for (const char* content :
         {"1,5;2,25;-3\n4;5;6,125\n", "1,5\t2,25\t-3\n4\t5\t6,125\n", "X;Y;Z\n1,5;2,25;-3\n4;5;6,125",
          "\"1,5\",\"2,25\",\"-3\"\r\n\"4\",\"5\",\"6,125\"\r\n"}) {
        CAPTURE(content);
        const test::PointsRead read = test::rowsOf(content);
        REQUIRE(read.cloud.points.size() == 2);
        CHECK(equal(read.cloud.points[0], {1.5, 2.25, -3}));
        CHECK(equal(read.cloud.points[1], {4, 5, 6.125}));
        CHECK(test::contains(read.said, "a.xyz: commas read as decimal points"));
    }
    // Decimal points among decimal commas are of thousands, or of another file.
    std::string mixed;
    for (int i = 0; i < 70; ++i) mixed += "1,5;2,5;3,5\n";
    CHECK(test::contains(test::thrownBy([&] { readRows("a", mixed + "1.5;2;3\n"); }).message,
                         "a:71: \"1.5\" is not a number"));
}

TEST_CASE("readRows: headers name the columns", "[io][hand]") {
    for (const char* head :
         {"//X Y Z R G B Heat", "# x y z r g b Heat", "x,y,z,r,g,b,Heat",
          "\"x\";\"y\";\"z\";\"r\";\"g\";\"b\";\"Heat\"", "Scanned by hand\n\nX Y Z Red Green Blue Heat",
          "//X Y Z R G B Heat\n1", "1\n//X Y Z R G B Heat"}) {
        CAPTURE(head);
        const test::PointsRead read = test::rowsOf(std::string(head) + "\n1 2 3 255 51 0 9.5\n");
        REQUIRE(read.cloud.points.size() == 1);
        CHECK(equal(read.cloud.points[0], {1, 2, 3}));
        CHECK(read.attribute("Cd") == std::vector<float>{1, 0.2f, 0});
        CHECK(read.attribute("Heat") == std::vector<float>{9.5f});
        CHECK(read.said == "");
    }
    const test::PointsRead other =
        test::rowsOf("id,z,y,x,nx,ny,nz,label\n7,3,2,1,0,0,1,tree\n8,6,5,4,0,1,0,house\n");
    CHECK(equal(other.cloud.points[1], {4, 5, 6}));
    CHECK(equal(other.cloud.normals[1], {0, 1, 0}));
    CHECK(other.attribute("id") == std::vector<float>{7, 8});
    CHECK(test::contains(other.said, "column 8 left out, for it holds words in 2 rows"));
    const test::PointsRead unknown = test::rowsOf("lat lon alt\n1 2 3\n");
    CHECK(test::contains(unknown.said, "1 line above its rows skipped"));
    // A comment of prose is no header.
    CHECK(equal(test::rowsOf("# turn x y z into metres\n1 2 3\n").cloud.points[0], {1, 2, 3}));
    CHECK(test::rowsOf("1 2 3 0 0 2\n", "a.xyzn").cloud.normals.size() == 1);
    CHECK(test::rowsOf("1 2 3 0 0 1\n", "a.xyzrgb").attribute("Cd") == std::vector<float>{0, 0, 1});
    CHECK(test::rowsOf(",x,y,z\n0,1,2,3\n1,4,5,6\n").cloud.points[1].z == 6);  // as pandas writes
}

TEST_CASE("readRows: intensities are kept, and the guess is said", "[io][hand]") {
    const test::PointsRead pts = test::rowsOf("2\n1 2 3 -100 255 51 0\n4 5 6 200 0 0 255\n", "a.pts");
    CHECK(pts.attribute("intensity") == std::vector<float>{-100, 200});
    CHECK(pts.attribute("Cd") == std::vector<float>{1, 0.2f, 0, 0, 0, 1});
    CHECK(test::contains(pts.said, "column 4 as intensity, columns 5 to 7 as red, green, blue"));
    CHECK(test::rowsOf("1 2 3 0.5\n").attribute("intensity") == std::vector<float>{0.5f});
    CHECK(test::rowsOf("1 2 3\n").said == "");
}

TEST_CASE("readRows: counts of blocks", "[io][hand]") {
    const test::PointsRead blocks = test::rowsOf("2\n1 2 3 7\n4 5 6 8\n1\n7 8 9 9\n", "a.pts");
    CHECK(blocks.cloud.points.size() == 3);
    CHECK_FALSE(test::contains(blocks.said, "!"));
    const test::PointsRead few = test::rowsOf("3\n1 2 3 7\n4 5 6 8\n", "a.pts");
    CHECK(few.cloud.points.size() == 2);
    CHECK(
        test::contains(few.said, "! a.pts: line 1 counts 3 points, 2 rows are there; the file is truncated"));
    const test::PointsRead more = test::rowsOf("1\n1 2 3\n4 5 6\n7 8 9\n", "a.pts");
    CHECK(more.cloud.points.size() == 3);
    CHECK(test::contains(more.said, "counts 1 point, 3 rows are there; all are read"));
    CHECK(test::rowsOf("1\n1 2 3\n4 5 6\n", "a.pwn").cloud.normals.size() == 1);
    CHECK(test::rowsOf("1\n1 2 3\n4 5 6\n", "a.pts").cloud.points.size() == 2);
    const test::PointsRead cut = test::rowsOf("2\n1 2 3\n4 5 6\n0 0 1\n", "a.pwn");
    CHECK(cut.cloud.points.size() == 2);
    CHECK(cut.cloud.normals.empty());
    CHECK(test::contains(cut.said, "! a.pwn: holds normals of 1 of its 2 points"));
}

TEST_CASE("readRows: rows longer or shorter than the first, and a file cut off", "[io][hand]") {
    const test::PointsRead longer = test::rowsOf("1 2 3\n4 5 6 7\n8 9 10 11 12\n");
    CHECK(longer.cloud.points.size() == 3);
    CHECK(test::contains(longer.said, "! a.xyz: 2 rows have more than the 3 numbers"));
    for (const char* end : {"4 5", "4", "4 5 6e", "4 5 -x"}) {
        CAPTURE(end);
        const test::PointsRead cut = test::rowsOf(std::string("1 2 3\n7 8 9\n") + end);
        CHECK(cut.cloud.points.size() == 2);
        CHECK(test::contains(
            cut.said,
            "! a.xyz: line 3, the last, is cut off and left out; the file is truncated after 2 points"));
        CHECK(test::thrownBy([&] { readRows("a", std::string("1 2 3\n") + end + "\n"); }).code ==
              int(ErrorCode::BadData));
    }
    // Nothing behind the last comma is a missing number.
    const test::PointsRead missing = test::rowsOf("x,y,z,heat\n1,2,3,\n4,5,6,7\n8,9,,1\n");
    CHECK(missing.attribute("heat") == std::vector<float>{0, 7, 1});
    CHECK(std::isnan(missing.cloud.points[2].z));
    CHECK(test::rowsOf("1 2 3\r4 5 6\r").cloud.points.size() == 2);
    CHECK(test::rowsOf("1 2 3 tree\n4 5 6 house\n").attribute("intensity").empty());
}

TEST_CASE("readRows: other formats are named", "[io][error]") {
    const auto refusal = [](const std::string& content) {
        return test::thrownBy([&] { readRows("a.asc", content); }).message;
    };
    CHECK(test::contains(refusal("ncols 4\nnrows 2\nxllcorner 0\n1 2 3 4\n5 6 7 8\n"), "ESRI ASCII grid"));
    CHECK(test::contains(refusal("2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n"), "PTX"));
    CHECK(test::contains(refusal("ply\nformat ascii 1.0\n"), ".ply file"));
    CHECK(test::contains(refusal("# .PCD v0.7\nFIELDS x y z\n"), ".pcd file"));
    CHECK(test::contains(refusal("3\nwater\nO 0 0 0\nH 0 0 1\nH 0 1 0\n"), "molecules"));
    CHECK(test::contains(refusal("Dear all\nthere are no numbers here\n"),
                         "a.asc:1: \"Dear\" is not a number"));
    CHECK(test::contains(refusal("1\n"), "no rows"));
    CHECK(test::contains(refusal("\x01\x02\xff 2\n"), "\"???\""));
    // Long comments, and counts without end, take no long time.
    std::string comments, counts;
    for (int i = 0; i < 200000; ++i) comments += "#\n", counts += "1\n0 0 0\n";
    CHECK(readRows("a", comments + "1 2 3\n").points.size() == 1);
    CHECK(readRows("a", counts).points.size() == 200000);
}

TEST_CASE("readPcd: fields of any type, size, count and order", "[io][oracle]") {
    std::string body;
    for (int point = 0; point < 2; ++point) {
        test::append(body, std::int16_t(-3 - point));  // z
        test::append(body, std::uint8_t(9));           // two of them that nobody wants
        test::append(body, std::uint8_t(9));
        test::append(body, 0.5 + point);                // x
        test::append(body, std::uint32_t(7 + point));   // y
        test::append(body, std::int64_t(100 - point));  // heat
    }
    const PointContent cloud = readPcd("a", pcdHeader("z pad x y heat", "2 1 8 4 8", "I U F U I", "1 2 1 1 1",
                                                      "WIDTH 2\nHEIGHT 1\nDATA binary\n") +
                                                body);
    REQUIRE(cloud.points.size() == 2);  // without POINTS they are the width times the height
    CHECK(equal(cloud.points[0], {0.5f, 7, -3}));
    CHECK(equal(cloud.points[1], {1.5f, 8, -4}));
    REQUIRE(findAttribute(cloud.attributes, "heat"));
    CHECK(findAttribute(cloud.attributes, "heat")->values == std::vector<float>{100, 99});
    const PointContent text =
        readPcd("a", pcdHeader("normal_x normal_y normal_z x y z", "4 4 4 4 4 4", "F F F F F F",
                               "1 1 1 1 1 1", "POINTS 1\nDATA ascii\n0 0 1 4 nan 6\n"));
    REQUIRE(text.normals.size() == 1);
    CHECK(equal(text.normals[0], {0, 0, 1}));
    CHECK(std::isnan(text.points[0].y));
    CHECK(text.points[0].z == 6);
}

TEST_CASE("readPcd: headers that are wrong", "[io][error]") {
    const auto refused = [](const std::string& content) {
        return test::thrownBy([&] { readPcd("a.pcd", content); });
    };
    const std::string xyz = pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", "");
    for (const std::string& content :
         {std::string(), std::string("nonsense"), xyz, xyz + "DATA ascii\n",
          xyz + "POINTS 2\nDATA ascii\n1 2 3\n4 5", xyz + "POINTS 1\nDATA ascii\n1 2 three\n",
          xyz + "POINTS 1\nDATA binary\n12345678901", xyz + "POINTS -1\nWIDTH 1\nHEIGHT -1\nDATA ascii\n",
          pcdHeader("x y z", "4 4 3", "F F F", "1 1 1", "POINTS 1\nDATA ascii\n1 2 3\n"),
          pcdHeader("x y z", "4 4 4 4", "F F F", "1 1 1", "POINTS 1\nDATA ascii\n1 2 3\n"),
          pcdHeader("x y w", "4 4 4", "F F F", "1 1 1", "POINTS 1\nDATA ascii\n1 2 3\n")}) {
        const test::Thrown thrown = refused(content);
        CAPTURE(content, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.pcd"));
    }
}

TEST_CASE("readPlyPoints: vertices before and behind other elements", "[io][oracle]") {
    const std::string extra = "element camera 1\nproperty list uchar int ids\nproperty double angle\n";
    for (const bool before : {false, true}) {
        const PointContent cloud =
            readPlyPoints("a", ply(before ? extra + kVertex : kVertex + extra,
                                   before ? "3 1 2 3 0.5\n1 2 3\n4 5 6\n" : "1 2 3\n4 5 6\n3 1 2 3 0.5\n"));
        REQUIRE(cloud.points.size() == 2);
        CHECK(equal(cloud.points[0], {1, 2, 3}));
        CHECK(equal(cloud.points[1], {4, 5, 6}));
        CHECK(cloud.normals.empty());
    }
    for (const std::string& content : {std::string(), std::string("ply\n"), ply(kVertex, "1 2 3\n4 5\n"),
                                       ply("element vertex 999999999999\nproperty float x\nproperty float "
                                           "y\nproperty float z\n",
                                           "1 2 3\n")})
        CHECK(test::thrownBy([&] { readPlyPoints("a", content); }).code == int(ErrorCode::BadData));
}

TEST_CASE("plyFaceCount: elements of faces and strips that a header claims", "[io][oracle]") {
    const std::string list = "property list uchar int vertex_indices\n";
    CHECK(plyFaceCount("a", ply(kVertex, "")) == 0);
    CHECK(plyFaceCount("a", ply(kVertex + "element face 0\n" + list, "")) == 0);
    CHECK(plyFaceCount("a", ply(kVertex + "element face 12\n" + list, "")) == 1);
    CHECK(plyFaceCount("a", ply(kVertex + "element face 2\n" + list + "element tristrips 3\n" + list, "")) ==
          2);
    CHECK(plyFaceCount("a", ply(kVertex + "element facet 4\n" + list, "")) == 0);
    CHECK(test::thrownBy([] { plyFaceCount("a", "not a ply"); }).code == int(ErrorCode::BadData));
    CHECK(test::thrownBy([] { plyFaceCount("a", "ply\nformat ascii 1.0\nelement face 2\n"); }).code ==
          int(ErrorCode::BadData));
}
