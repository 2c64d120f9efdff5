#include "libvdbsynth/io/readers/point_readers.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include "tests/support/makers.h"
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

template <typename T>
bool equal(const Vec3<T>& a, const Vec3d& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

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
