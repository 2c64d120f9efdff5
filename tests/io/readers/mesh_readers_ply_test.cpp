#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/points/point_readers.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/stl_files.h"

using namespace vdbsynth;
using test::replaced;

namespace {

const std::string kVertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n",
                  kFace = "element face 4\nproperty list uchar int vertex_indices\n",
                  kPoints = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", kCorners = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

std::string ply(const std::string& elements, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

void requireTetrahedron(const std::string& content, const RunContext& ctx) {
    const MeshSummary solid = summarize(meshOf("a.ply", readPly("a.ply", content, ctx), ctx));
    CHECK(solid.vertices == 4);
    CHECK(solid.faces == 4);
    CHECK(solid.closedManifold());
    CHECK(solid.signedVolume == Approx(1 / 6.0));
}

}  // namespace

TEST_CASE("readPly: dialects that say the same give the same, without a word", "[io][oracle]") {
    const std::string plain = ply(kVertex + kFace, kPoints + kCorners);
    const std::vector<std::string> all{
        plain,
        replaced(plain, "\n", "\r\n"),
        replaced(plain, "\n", "\r"),
        replaced(plain, "\n", "   \r"),
        "\xEF\xBB\xBF" + plain,
        "PLY" + plain.substr(3),
        plain + "\n \n",
        replaced(plain, "vertex_indices", "vertex_index"),
        replaced(plain, "uchar int", "uint8 uint32"),
        replaced(plain, "uchar int", "int int64"),
        replaced(plain, "uchar int", "uchar double"),
        replaced(replaced(replaced(plain, "float x", "float X"), "float y", "double Y"), "float z",
                 "float32_t Z"),
        replaced(replaced(plain, "element vertex", "element vertices"), "element face", "element polygon"),
        ply(kFace + kVertex, kCorners + kPoints),
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);
        test::Said said;
        requireTetrahedron(all[i], said.ctx);
        CHECK(said.nothing());
    }
}

TEST_CASE("readPly: what is guessed or left out is said", "[io][error]") {
    const std::string plain = ply(kVertex + kFace, kPoints + kCorners);
    const auto read = [](const std::string& content, test::Said& said) {
        requireTetrahedron(content, said.ctx);
    };
    {
        test::Said said;
        read(replaced(plain, "vertex_indices",
                      "corner\x1B"
                      "s"),
             said);
        CHECK(said.noted("a.ply: the list \"corner?s\" is read as the corners of the faces"));
    }
    {
        test::Said said;  // more on a line than the header says, as an old MeshLab wrote it
        read(ply(kVertex + kFace + "property list uchar float texcoord\nproperty uchar red\n",
                 kPoints + replaced(kCorners, "\n", " 2 0.5 0.25 9 1 1 1\n")),
             said);
        CHECK(said.noted("not read: face texcoord, face red"));
        CHECK(said.noted("4 lines have more words than the header declares, which are not read"));
    }
    {
        test::Said said;
        read(ply("element camera 1\nproperty float view\n" + kVertex + "property list uchar int tags\n" +
                     kFace,
                 "7\n" + replaced(kPoints, "\n", " 2 8 9\n") + kCorners),
             said);
        CHECK(said.noted("not read: element camera, vertex tags"));
    }
    {
        test::Said said;
        read(plain + "3 0 1 2\n", said);
        CHECK(said.noted("7 bytes behind the last element left out"));
    }
    {
        test::Said said;
        read(ply(replaced(kVertex, "4", "6") + kFace,
                 kPoints + "nan nan nan\n0 -nan(ind) 1.#QNAN\n" + kCorners),
             said);
        CHECK(said.noted("2 vertices without finite coordinates"));
    }
    {
        test::Said said;
        std::string many = kFace;
        for (int i = 0; i < 10; ++i) many += "property uchar extra\n";
        read(ply(kVertex + many, kPoints + replaced(kCorners, "\n", " 0 0 0 0 0 0 0 0 0 0\n")), said);
        CHECK(said.noted("and 2 more"));
    }
}

TEST_CASE("readPly: errors", "[io][error]") {
    const std::pair<std::string, std::string> all[] = {
        {ply(kFace, kCorners), "no element \"vertex\""},
        {ply(kVertex + kVertex + kFace, kPoints + kPoints + kCorners), "two elements \"vertex\""},
        {ply(replaced(kVertex, "float y", "float t") + kFace, kPoints + kCorners), "the vertices have no y"},
        {ply(kVertex + kFace, kPoints + replaced(kCorners, "3 1 2 3", "3 1 2 4")),
         "face 2 uses vertex 4 of 4"},
        {ply(kVertex + kFace, kPoints + replaced(kCorners, "3 1 2 3", "3 1 2 -1")), "face 2 uses vertex -1"},
        {ply(kFace + kVertex, "3 0 2 4\n" + kCorners + kPoints), "face 0 uses vertex 4 of 4"},
        {ply(replaced(kVertex, "4", "5") + kFace, kPoints + kCorners), "truncated"},
        {ply(replaced(kVertex, "4", "5") + "property float w\n" + kFace,
             replaced(kPoints, "\n", " 1\n") + kCorners),
         "truncated"},
        {ply(replaced(kVertex, "4", "5") + "property float w\nproperty float v\n" + kFace,
             replaced(kPoints, "\n", " 1 1\n") + kCorners),
         "a line of \"vertex\" has fewer words"},
        {ply(kVertex + kFace, kPoints + "3 0 2 1\n3 0 1"), "truncated: 1 of 4 of \"face\" are there"},
    };
    for (const auto& [content, says] : all) {
        const test::Thrown thrown =
            test::thrownBy([&, &content = content] { meshOf("a.ply", readPly("a.ply", content), {}); });
        CAPTURE(thrown.message, says);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, says));
    }
    test::Said said;
    const MeshContent none = readPly(
        "a.ply", ply(kVertex + "element face 1\nproperty list uchar float weights\n", kPoints + "1 0.5\n"),
        said.ctx);
    CHECK(none.polygons.sizes.empty());
    CHECK(said.warned("its faces have no list of whole numbers, so no corners"));
}

TEST_CASE("readPlyPoints: doubles keep their digits, normals without a length are said", "[io][oracle]") {
    const std::string head =
        "element vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
        "property float nx\nproperty float ny\nproperty float nz\n";
    test::Said said;
    const PointContent cloud = readPlyPoints(
        "a.ply", ply(head, "500000.123 5600000.456 7 0 0 1\n500000.124 5600000.457 8 1 0 0\n"), said.ctx);
    CHECK(said.nothing());
    CHECK(cloud.points[0].y == 5600000.456);
    CHECK(cloud.points[1].x == 500000.124);
    REQUIRE(cloud.normals.size() == 2);
    for (const char* normal : {"0 0 0", "nan nan nan", "inf 0 0"}) {
        test::Said left;
        const PointContent without =
            readPlyPoints("a.ply", ply(head, "0 0 0 0 0 1\n1 1 1 " + std::string(normal) + "\n"), left.ctx);
        CHECK(without.normals.empty());
        CHECK(without.points.size() == 2);
        CHECK(left.noted("1 of 2 normals have no length, so that none are read"));
    }
}
