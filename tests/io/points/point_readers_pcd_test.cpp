#include "libvdbsynth/io/points/point_readers_steps.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include "tests/support/makers.h"
#include "tests/support/point_contents.h"
#include "tests/support/raster_files.h"

using namespace vdbsynth;

namespace {

test::PointsRead pcdOf(const std::string& content) {
    return test::readBy(readPcd, content, "a.pcd");
}

std::string floats(std::initializer_list<float> values) {
    std::string bytes;
    for (const float value : values) test::append(bytes, value);
    return bytes;
}

test::Thrown refusal(const std::string& content) {
    return test::thrownBy([&] { readPcd("a.pcd", content); });
}

}  // namespace

TEST_CASE("readPcd: headers of old versions and of other writers", "[io][hand]") {
    const std::string body = floats({1, 2, 3, 4, 5, 6});
    for (const std::string header :
         {"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE f f f\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n",
          "# .PCD v.6\nVERSION .6\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA binary\n",
          "version 0.7\nfields x y z\nsize 4 4 4\ntype F F F\ncount 1 1 1\npoints 2\ndata Binary\n",
          "VERSION 0.7\r\nFIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nPOINTS 2\r\nDATA binary\r\n",
          "FIELDS X Y Z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 2\nDATA binary\n"}) {
        CAPTURE(header);
        const test::PointsRead read = pcdOf(header + body);
        REQUIRE(read.cloud.points.size() == 2);
        CHECK(test::equal(read.cloud.points[1], {4, 5, 6}));
        CHECK(read.said == "");
    }
    // A version without sizes and types: what is assumed is said.
    const test::PointsRead read = pcdOf("COLUMNS x y z\nPOINTS 2\nDATA binary\n" + body);
    CHECK(test::equal(read.cloud.points[1], {4, 5, 6}));
    CHECK(test::contains(read.said, "type F and size 4"));
}

TEST_CASE("readPcd: padding, normals by other names, colours in fields, doubles", "[io][hand]") {
    std::string body;
    for (const double value : {5648340.001, 2.0, 3.0}) test::append(body, value);
    body += floats({0, 0, 1}) + std::string("\xff\x33\x00", 3) + std::string(5, 'p') + floats({7, 8});
    const test::PointsRead read = pcdOf(
        "FIELDS x y z nx ny nz r g b _ intensity histogram\nSIZE 8 8 8 4 4 4 1 1 1 1 4 4\nTYPE F F F F F F U "
        "U U U F F\nCOUNT 1 1 1 1 1 1 1 1 1 5 1 1\nPOINTS 1\nDATA binary\n" +
        body);
    CHECK(read.cloud.points[0].x == 5648340.001);
    REQUIRE(read.cloud.normals.size() == 1);
    CHECK(read.attribute("Cd") == std::vector<float>{1, 0.2f, 0});
    CHECK(read.attribute("intensity") == std::vector<float>{7});
    CHECK(read.said == "");
    const test::PointsRead several = pcdOf(
        "FIELDS x y z fpfh\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 3\nPOINTS 1\nDATA ascii\n"
        "1 2 3 4 5 6\n");
    CHECK(test::contains(several.said, "1 fields of several values"));
    // Dark colours of one byte stay dark.
    const test::PointsRead dark =
        pcdOf("FIELDS x y z r g b\nSIZE 4 4 4 1 1 1\nTYPE F F F U U U\nPOINTS 1\nDATA ascii\n1 2 3 1 0 1\n");
    CHECK(dark.attribute("Cd")[0] == Approx(1 / 255.0));
}

TEST_CASE("readPcd: packed colours as whole numbers in a field of floats", "[io][hand]") {
    const std::string header = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3 ";
    const std::vector<float> right{1, 0.2f, 0};
    CHECK(pcdOf(header + "16724736\n").attribute("Cd") == right);      // 0x00ff3300
    CHECK(pcdOf(header + "4294914816\n").attribute("Cd") == right);    // 0xffff3300
    CHECK(pcdOf(header + "2.3418052e-38\n").attribute("Cd")[0] == 1);  // the same bits as a float
}

TEST_CASE("readPcd: counts that contradict each other or the file", "[io][hand]") {
    const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
    const test::PointsRead grid = pcdOf(fields + "WIDTH 3\nHEIGHT 2\nPOINTS 2\nDATA ascii\n1 2 3\nnan 5 6\n");
    CHECK(grid.cloud.points.size() == 2);
    CHECK(test::contains(grid.said, "! a.pcd: WIDTH times HEIGHT is 6, POINTS is 2"));
    const test::PointsRead more = pcdOf(fields + "POINTS 1\nDATA ascii\n1 2 3 4\n4 5 6\n7 8 9\n");
    CHECK(more.cloud.points.size() == 1);
    CHECK(test::contains(more.said, "2 rows behind its 1 point"));
    CHECK(test::contains(more.said, "1 rows have more numbers"));
    const test::PointsRead rest = pcdOf(fields + "POINTS 1\nDATA binary\n" + floats({1, 2, 3, 4, 5, 6}));
    CHECK(test::contains(rest.said, "12 bytes behind its 1 point"));
    const test::Thrown few = refusal(fields + "POINTS 3\nDATA binary\n" + floats({1, 2, 3, 4, 5, 6}));
    CHECK(test::contains(few.message, "claims 3 points of 12 bytes"));
    CHECK(test::contains(few.message, "it has 24 bytes"));
    CHECK(test::contains(refusal(fields + "POINTS 3\nDATA ascii\n1 2 3\n4 5 6\n").message,
                         "claims 3 points, more than the file holds: 2"));
    CHECK(test::contains(refusal(fields + "POINTS 2\nDATA ascii\n1 2 3\n4 5").message,
                         "a.pcd:7: a row of 2 numbers for 3 fields; the file is truncated"));
}

TEST_CASE("readPcd: what a header may not say", "[io][error]") {
    for (const char* header :
         {"FIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\nPOINTS 0\nDATA ascii\n",
          "FIELDS x y z\nSIZE 4 4 4\nTYPE F F\nPOINTS 0\nDATA ascii\n",
          "FIELDS x y z\nSIZE 4 4 2\nTYPE F F F\nPOINTS 0\nDATA binary\n", "FIELDS x y z\nFIELD 4\n",
          "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA \x01\x02\n"}) {
        const test::Thrown thrown = refusal(header);
        CAPTURE(header, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        for (const char c : thrown.message) CHECK((c >= ' ' && c <= '~'));
    }
}
