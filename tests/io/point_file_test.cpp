#include "libvdbsynth/io/point_file.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <limits>

#include "libvdbsynth/io/mesh_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

std::string pcd(const std::string& data, const std::string& body, int points = 2) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " +
           std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
           "\nDATA " + data + "\n" + body;
}

std::string bytesOf(std::initializer_list<float> values) {
    std::string text;
    for (float value : values) text.append(reinterpret_cast<const char*>(&value), 4);
    return text;
}

test::Thrown reading(const std::string& path) {
    return test::thrownBy([&] { readPoints(path); });
}

}  // namespace

TEST_CASE("readPoints: rows with and without normals, commas, comments, counts", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const PointFile plain = readPoints(folder.write("a.xyz", "# scan\n1 2 3\n\n4,5,6\n"));
    REQUIRE(plain.cloud.points.size() == 2);
    CHECK(plain.cloud.points[1].z == 6);
    CHECK(plain.cloud.normals.empty());
    const PointFile normals = readPoints(folder.write("b.pwn", "0 0 0 0 0 1\n1 0 0 0.6 0.8 0\n"));
    REQUIRE(normals.cloud.normals.size() == 2);
    CHECK(normals.cloud.normals[1].y == Approx(0.8f));
    CHECK(readPoints(folder.write("c.xyz", "0 0 0 200 10 30\n1 0 0 1 0 0\n")).cloud.normals.empty());
    const PointFile counted = readPoints(folder.write("d.pwn", "2\n0 0 0\n1 1 1\n0 0 1\n0 1 0\n"));
    REQUIRE(counted.cloud.points.size() == 2);
    CHECK(counted.cloud.normals[1].y == 1);
}

TEST_CASE("readPoints: PCD ascii, binary and compressed hold the same", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::string rows = bytesOf({1, 2, 3, 0, nan, 5, 6, 0});
    // Compressed files hold field after field; control byte 31 begins 32 literal bytes.
    const std::string fields = bytesOf({1, nan, 2, 5, 3, 6, 0, 0});
    const std::uint32_t sizes[2] = {33, 32};
    const std::string packed = std::string(reinterpret_cast<const char*>(sizes), 8) + '\x1f' + fields;
    for (const std::string& content :
         {pcd("ascii", "1 2 3 0\nnan 5 6 0\n"), pcd("binary", rows), pcd("binary_compressed", packed)}) {
        const PointFile file = readPoints(folder.write("a.pcd", content));
        REQUIRE(file.cloud.points.size() == 1);
        CHECK(file.invalid == 1);
        CHECK(file.cloud.points[0].y == 2);
    }
    // A repeat: four zero bytes, then 16 more of the same place.
    const std::uint32_t repeated[2] = {8, 32};
    const std::string run = std::string(reinterpret_cast<const char*>(repeated), 8) +
                            std::string("\x03\0\0\0\0", 5) + std::string("\xe0\x13\x00", 3);
    CHECK(readPoints(folder.write("b.pcd", pcd("binary_compressed", run))).cloud.points.size() == 2);
}

TEST_CASE("readPoints: PLY without faces, as writePointsPly writes it", "[io][property]") {
    const test::TemporaryFolder folder;
    PointCloud cloud;
    cloud.points = {{1, 2, 3}, {4, 5, 6}};
    cloud.normals = {{0, 0, 1}, {0, 1, 0}};
    writePointsPly(folder.path("p.ply"), cloud);
    CHECK(holdsPoints(folder.path("p.ply")));
    const PointFile file = readPoints(folder.path("p.ply"));
    REQUIRE(file.cloud.points.size() == 2);
    CHECK(file.cloud.normals[1].y == 1);
    writeMesh(folder.path("m.ply"), MeshFormat::Ply, test::sphereMesh(1, 1));
    CHECK_FALSE(holdsPoints(folder.path("m.ply")));
    CHECK_FALSE(holdsPoints(folder.path("m.obj")));
}

TEST_CASE("readPoints: what is wrong is named", "[io][error]") {
    const test::TemporaryFolder folder;
    CHECK(reading(folder.path("none.xyz")).code == int(ErrorCode::Io));
    CHECK(reading(folder.write("e.xyz", "")).code == int(ErrorCode::BadData));
    CHECK(test::contains(reading(folder.write("t.xyz", "1 2\n")).message, "three coordinates"));
    CHECK(test::contains(reading(folder.write("r.xyz", "1 2 3\n1 2\n")).message, "r.xyz:2: a row of 2"));
    CHECK(test::contains(reading(folder.write("w.xyz", "1 2 three\n")).message, "\"three\" is not a number"));
    CHECK(test::contains(reading(folder.write("c.pwn", "99999999\n1 2 3\n")).message, "more points"));
    CHECK(reading(folder.write("n.xyz", "nan nan nan\n")).code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(reading(folder.write("b.pcd", pcd("binary", bytesOf({1, 2})))).message,
                         "more than the file holds"));
    CHECK(test::contains(reading(folder.write("b.pcd", pcd("binary", "", 2000000000))).message,
                         "more than the file holds"));
    CHECK(test::contains(reading(folder.write("b.pcd", pcd("zip", ""))).message, "DATA \"zip\""));
    const std::uint32_t sizes[2] = {3, 32};
    const std::string head(reinterpret_cast<const char*>(sizes), 8);
    CHECK(test::contains(
        reading(folder.write("b.pcd", pcd("binary_compressed", head + std::string("\x20\x05\x00", 3))))
            .message,
        "corrupt"));
    CHECK(test::contains(
        reading(folder.write("b.pcd", pcd("binary_compressed", head + std::string("\x1f\x05\x00", 3))))
            .message,
        "truncated"));
    CHECK(test::contains(reading(folder.write("x.pcd",
                                              "FIELDS a b\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT "
                                              "1\nPOINTS 1\nDATA ascii\n1 2\n"))
                             .message,
                         "no x, y and z"));
}

TEST_CASE("readPoints: a PCD whose points times bytes wrap in 64 bits is refused", "[io][regression]") {
    const test::TemporaryFolder folder;
    for (const char* points : {"1152921504606846976", "4611686018427387905", "9223372036854775807"})
        for (const char* data : {"binary", "binary_compressed", "ascii"}) {
            CAPTURE(points, data);
            const test::Thrown thrown = reading(folder.write(
                "w.pcd",
                std::string(
                    "FIELDS x y z w\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS ") +
                    points + "\nDATA " + data + "\n" + std::string(64, '\0')));
            CHECK(thrown.code == int(ErrorCode::BadData));
            CHECK(test::contains(thrown.message, "more"));
        }
}

TEST_CASE("readPoints: colours of rows and of PCD, and other fields", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const PointFile rows = readPoints(folder.write("a.xyz", "0 0 0 255 51 0\n1 0 0 0 0 255\n"));
    REQUIRE(rows.cloud.attributes.size() == 1);
    CHECK(rows.cloud.attributes[0].values == std::vector<float>{1, 0.2f, 0, 0, 0, 1});
    const PointFile both = readPoints(folder.write("b.xyz", "0 0 0 0 0 1 255 51 0\n1 0 0 0 1 0 0 0 255\n"));
    CHECK(both.cloud.normals.size() == 2);
    CHECK(both.cloud.attributes.size() == 1);
    // 0x00ff3300 as a whole number; a point without a place takes its colour along.
    std::string header =
        "VERSION 0.7\nFIELDS x y z rgb heat\nSIZE 4 4 4 4 4\nTYPE F F F U F\nCOUNT 1 1 1 1 1\nWIDTH "
        "2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n";
    const PointFile pcd = readPoints(folder.write("c.pcd", header + "nan 0 0 255 1\n1 2 3 16724736 7\n"));
    REQUIRE(pcd.cloud.points.size() == 1);
    CHECK(findAttribute(pcd.cloud.attributes, "Cd")->values == std::vector<float>{1, 0.2f, 0});
    CHECK(findAttribute(pcd.cloud.attributes, "heat")->values == std::vector<float>{7});
}

TEST_CASE("readPoints: packed colours stored as floats keep their bits", "[io][regression]") {
    const test::TemporaryFolder folder;
    // Opaque, red 150: as a float a NaN that is not quiet.
    const std::uint32_t colour = 0xff966432;
    const float place[3] = {1, 2, 3};
    std::string body(reinterpret_cast<const char*>(place), 12);
    body.append(reinterpret_cast<const char*>(&colour), 4);
    const std::string header =
        "VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS "
        "1\nDATA binary\n";
    const PointFile file = readPoints(folder.write("a.pcd", header + body));
    CHECK(findAttribute(file.cloud.attributes, "Cd")->values[0] == Approx(150 / 255.0));
    CHECK(findAttribute(file.cloud.attributes, "Cd")->values[2] == Approx(50 / 255.0));
}
