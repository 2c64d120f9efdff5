#include "libvdbsynth/io/mesh_file.h"

#include <catch2/catch.hpp>

#include <tuple>

#include <cstring>

#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

template <typename T>
std::string bytesOf(const T& value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binaryStl(std::uint32_t claimed, std::uint32_t written) {
    std::string text(80, ' ');
    text += bytesOf(claimed);
    for (std::uint32_t i = 0; i < written; ++i) {
        const float corners[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, float(i)};
        text += bytesOf(corners) + std::string(2, '\0');
    }
    return text;
}

const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/2 4/3\nf 2 3 4\nf -4 -1 -2\n";

}  // namespace

TEST_CASE("readMesh, writeMesh: what is written reads back, in every format", "[io][property]") {
    const test::TemporaryFolder folder;
    const Mesh mesh = test::sphereMesh(1.7, 2);
    const MeshSummary before = summarize(mesh);
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.3mf"}) {
        INFO(name);
        MeshFormat format{};
        REQUIRE(meshFormatOf(name, format));
        writeMesh(folder.path(name), format, mesh);
        const MeshSummary after = summarize(readMesh(folder.path(name)));
        CHECK(after.vertices == before.vertices);
        CHECK(after.faces == before.faces);
        CHECK(after.closedManifold());
        CHECK(after.signedVolume == Approx(before.signedVolume).epsilon(1e-6));
    }
    MeshFormat format{};
    CHECK_FALSE(meshFormatOf("a.vdb", format));
}

TEST_CASE("readMesh: OBJ with texture indices, negative indices and no last line end", "[io][fast]") {
    const test::TemporaryFolder folder;
    CHECK(summarize(readMesh(folder.write("t.obj", kObj))).closedManifold());
    CHECK(readMesh(folder.write("e.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3")).triangles.size() == 1);
}

TEST_CASE("readMesh: OFF with colours, comments, polygons and an extra header", "[io][fast]") {
    const test::TemporaryFolder folder;
    const Mesh mesh =
        readMesh(folder.write("c.off",
                              "COFF # coloured\n5 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n2 1 0 1 1 1 1\n1 2 "
                              "0 1 1 1 1\n0 1 0 1 1 1 1\n5 0 1 2 3 4 0.5 0.5 0.5\n"));
    CHECK(mesh.points.size() == 5);
    CHECK(mesh.triangles.size() == 3);
}

TEST_CASE("readMesh: PLY in both byte orders with doubles, extra properties and lists", "[io][property]") {
    const test::TemporaryFolder folder;
    const std::string body =
        "element vertex 3\nproperty double x\nproperty uchar red\nproperty double y\nproperty double "
        "z\nproperty list uchar short extra\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar flag\nend_header\n";
    for (bool big : {false, true}) {
        std::string text =
            std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + body;
        const auto add = [&](auto value) {
            std::string bytes = bytesOf(value);
            if (big) std::reverse(bytes.begin(), bytes.end());
            text += bytes;
        };
        for (int v = 0; v < 3; ++v) {
            add(double(v));
            add(std::uint8_t(9));
            add(double(v * v));
            add(0.25);
            add(std::uint8_t(v));
            for (int i = 0; i < v; ++i) add(std::int16_t(7));
        }
        add(std::uint8_t(3));
        for (int i = 0; i < 3; ++i) add(std::int32_t(i));
        add(std::uint8_t(1));
        const Mesh mesh = readMesh(folder.write("d.ply", text));
        REQUIRE(mesh.triangles.size() == 1);
        CHECK(mesh.points[2].y == 4.f);
        CHECK(mesh.points[1].z == 0.25f);
    }
    const Mesh ascii = readMesh(folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    CHECK(ascii.triangles.size() == 1);
}

TEST_CASE("readMesh: binary STL whose header says solid is still binary", "[io][fast]") {
    const test::TemporaryFolder folder;
    std::string text = binaryStl(2, 2);
    text.replace(0, 5, "solid");
    CHECK(readMesh(folder.write("s.stl", text)).triangles.size() == 2);
}

TEST_CASE("readMesh: corrupt files are refused in one line that names them", "[io][error]") {
    const test::TemporaryFolder folder;
    const std::string plyHead =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    struct Bad {
        const char* name;
        std::string content, says;
        ErrorCode code;
    };
    const std::vector<Bad> all{
        {"a.obj", "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj:1: a vertex has fewer", ErrorCode::BadData},
        {"b.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number", ErrorCode::BadData},
        {"c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "uses vertex 8 of 3", ErrorCode::BadData},
        {"d.obj", "v 0 0 0\n", "no faces", ErrorCode::EmptyInput},
        {"e.obj", "", "the file is empty", ErrorCode::BadData},
        {"f.off", "OFF\n353535235358 1 0\n", "more than the file can hold", ErrorCode::BadData},
        {"g.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "truncated", ErrorCode::BadData},
        {"h.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "vertex 3 of 3 does not exist",
         ErrorCode::BadData},
        {"i.off", "PLY\n", "not an OFF file", ErrorCode::BadData},
        {"j.off", "OFF BINARY\n", "binary OFF is not supported", ErrorCode::BadData},
        {"k.ply", plyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 5\n", "uses vertex 5 of 3", ErrorCode::BadData},
        {"l.ply", plyHead + "0.000000 0 0\n1.00000 0 0\n", "truncated", ErrorCode::BadData},
        {"m.ply", plyHead + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "not a finite number", ErrorCode::BadData},
        {"n.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "end_header", ErrorCode::BadData},
        {"o.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float "
         "y\nproperty float z\nend_header\n",
         "more than the file can hold", ErrorCode::BadData},
        {"p.stl", binaryStl(5, 2), "claims 5 triangles", ErrorCode::BadData},
        {"q.stl",
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
         "fewer than three", ErrorCode::BadData},
        {"r.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "truncated", ErrorCode::BadData},
        {"s.stl", "hello", "not an STL file", ErrorCode::BadData},
    };
    for (const Bad& bad : all) {
        INFO(bad.name);
        const test::Thrown thrown = test::thrownBy([&] { readMesh(folder.write(bad.name, bad.content)); });
        CHECK(thrown.code == int(bad.code));
        CHECK(test::contains(thrown.message, bad.says));
        CHECK(test::contains(thrown.message, bad.name));
        CHECK_FALSE(test::contains(thrown.message, "\n"));
    }
    CHECK(test::thrownBy([&] { readMesh(folder.path("missing.obj")); }).code == int(ErrorCode::Io));
    CHECK(test::thrownBy([&] { readMesh("a.xyz"); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("readMesh: a file cut anywhere is an error or a smaller mesh, never a crash", "[io][property]") {
    const test::TemporaryFolder folder;
    const Mesh mesh = test::sphereMesh(1, 1);
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off"}) {
        MeshFormat format{};
        meshFormatOf(name, format);
        writeMesh(folder.path(name), format, mesh);
        const std::string whole = test::contentOf(folder.path(name));
        for (std::size_t i = 0; i < 120; ++i) {
            const std::string cut = whole.substr(0, whole.size() * i / 120);
            const test::Thrown thrown = test::thrownBy([&] { readMesh(folder.write(name, cut)); });
            if (format != MeshFormat::Obj)
                CHECK((thrown.code == int(ErrorCode::BadData) || thrown.code == int(ErrorCode::EmptyInput)));
        }
    }
}

TEST_CASE("readMesh: the sample meshes have the counts that their sources state", "[io][oracle]") {
    const std::string bunny = test::sample("meshes/bunny.off");
    if (bunny.empty()) {
        WARN("samples absent: skipped");
        return;
    }
    const MeshSummary s = summarize(readMesh(bunny));
    CHECK(s.vertices == 34835);
    CHECK(s.faces == 69666);
    CHECK(s.closedManifold());
    const MeshSummary cheese = summarize(readMesh(test::sample("meshes/cheese.off")));
    CHECK(cheese.vertices == 8629);
    CHECK(cheese.faces == 17786);
    const MeshSummary bars = summarize(readMesh(test::sample("meshes/thingi10k-88566-grooved-bars.stl")));
    CHECK(bars.vertices == 2624);
    CHECK(bars.faces == 5344);
    CHECK(summarize(readMesh(test::sample("meshes/stanford-bunny.obj"))).openEdges == 223);
}

TEST_CASE("writeMesh: a folder that does not exist is an Io error", "[io][error]") {
    CHECK(test::thrownBy([] { writeMesh("/nowhere/a.obj", MeshFormat::Obj, test::sphereMesh(1, 0)); }).code ==
          int(ErrorCode::Io));
}

TEST_CASE("readMesh: PLY triangle strips, -1 begins a new one", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
    const Mesh mesh = readMesh(folder.write("s.ply", head + "9 0 1 2 3 -1 2 3 4 4\n"));
    REQUIRE(mesh.triangles.size() == 3);
    CHECK(mesh.triangles[0] == Triangle{0, 1, 2});
    CHECK(mesh.triangles[1] == Triangle{2, 1, 3});
    CHECK(mesh.triangles[2] == Triangle{2, 3, 4});
    const test::Thrown outside = test::thrownBy([&] { readMesh(folder.write("b.ply", head + "3 0 1 7\n")); });
    CHECK(outside.code == int(ErrorCode::BadData));
    CHECK(test::contains(outside.message, "vertex 7 of 5"));
}

TEST_CASE("readMesh: a PLY index that is no whole number is refused", "[io][error]") {
    const test::TemporaryFolder folder;
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar float vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    CHECK(readMesh(folder.write("a.ply", head + "3 0 1 2\n")).triangles.size() == 1);
    CHECK(
        test::contains(test::thrownBy([&] { readMesh(folder.write("b.ply", head + "3 0 1.5 2\n")); }).message,
                       "vertex 1.5 of 3"));
}

TEST_CASE("readMesh: MEDIT surfaces, and the outside of tetrahedra", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const std::string vertices =
        "MeshVersionFormatted 1\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n";
    const Mesh solid =
        readMesh(folder.write("t.mesh", vertices + "Tetrahedra\n2\n1 2 3 4 0\n2 3 4 5 0\nEnd\n"));
    CHECK(solid.triangles.size() == 6);
    const MeshSummary summary = summarize(solid);
    CHECK(summary.openEdges == 0);
    // 1/6 for the corner, 1/3 for the other.
    CHECK(std::abs(summary.signedVolume) <= 0.5 + 1e-9);
    const Mesh surface =
        readMesh(folder.write("s.mesh", vertices + "Edges\n1\n1 2 0\nTriangles\n1\n1 2 3 7\nEnd\n"));
    CHECK(surface.triangles.size() == 1);
    CHECK(test::contains(test::thrownBy([&] {
                             readMesh(folder.write("b.mesh", vertices + "Triangles\n1\n1 2 9 0\n"));
                         }).message,
                         "vertex 9 of 5"));
    CHECK(test::thrownBy([&] {
              readMesh(folder.write("c.mesh", "MeshVersionFormatted 2\nVertices\n99999999\n"));
          }).code == int(ErrorCode::BadData));
}

TEST_CASE("readMesh: OBJ lines that go on after a backslash", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Mesh mesh =
        readMesh(folder.write("a.obj", "v 0 0 \\\n0\nv 1 0 0\r\nv 0 1 0\nv 1 1 0\nf 1 2 \\\r\n4 \\\n3\n"));
    CHECK(mesh.points.size() == 4);
    REQUIRE(mesh.quads.size() == 1);
    CHECK(mesh.quads[0] == Quad{0, 1, 3, 2});
    CHECK(test::contains(
        test::thrownBy([&] { readMesh(folder.write("b.obj", "v 0 0 \\\n0\nv 1 x 0\n")); }).message,
        "b.obj:3"));
}

TEST_CASE("readMesh, writeMesh: attributes of vertices in every format that has them", "[io][property]") {
    const test::TemporaryFolder folder;
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 2, 3});
    Attribute colour{"Cd", 3, {}}, heat{"heat", 1, {}}, flow{"flow", 3, {}}, uv{"uv", 2, {}};
    for (int i = 0; i < 8; ++i) {
        colour.values.insert(colour.values.end(), {float(i) / 7, 1, 0.2f});
        heat.values.push_back(float(i) * 1.5f);
        flow.values.insert(flow.values.end(), {float(i), 0, -1});
        uv.values.insert(uv.values.end(), {float(i), 0.5f});
    }
    mesh.attributes = {colour, heat, flow, uv};
    for (const auto& [name, format, count] :
         {std::tuple("a.ply", MeshFormat::Ply, 4), std::tuple("a.obj", MeshFormat::Obj, 1),
          std::tuple("a.off", MeshFormat::Off, 1)}) {
        CAPTURE(name);
        writeMesh(folder.path(name), format, mesh);
        const Mesh back = readMesh(folder.path(name));
        REQUIRE(back.attributes.size() == std::size_t(count));
        for (std::size_t i = 0; i < 24; ++i)
            REQUIRE(findAttribute(back.attributes, "Cd")->values[i] ==
                    Approx(colour.values[i]).margin(0.002));
        if (count == 1) continue;
        CHECK(findAttribute(back.attributes, "heat")->values == heat.values);
        CHECK(findAttribute(back.attributes, "flow")->values == flow.values);
        CHECK(findAttribute(back.attributes, "uv")->values == uv.values);
    }
    // Colours beyond what 8 bits hold stay real numbers.
    mesh.attributes = {{"Cd", 3, std::vector<float>(24, 4.5f)}};
    writeMesh(folder.path("b.ply"), MeshFormat::Ply, mesh);
    CHECK(test::contains(test::contentOf(folder.path("b.ply")).substr(0, 400), "property float Cd_x"));
}

TEST_CASE("readMesh: OBJ texture coordinates part the vertices of a seam", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Mesh mesh =
        readMesh(folder.write("a.obj",
                              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.5\n"
                              "f 1/1 2/2 3/3\nf 1/4 3/3 4/1\nf 1/4 2/2 4/1\n"));
    REQUIRE(mesh.points.size() == 5);  // vertex 1 has two texture coordinates
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {4, 2, 3}, {4, 1, 3}});
    CHECK(findAttribute(mesh.attributes, "uv")->values ==
          std::vector<float>{0, 0, 1, 0, 1, 1, 0, 0, 0.5f, 0.5f});
    CHECK(mesh.points[4].x == 0);
}

TEST_CASE("readMesh: colours that some vertices lack in part are passed over", "[io][regression]") {
    const test::TemporaryFolder folder;
    CHECK(readMesh(folder.write("a.obj", "v 0 0 0 x 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nf 1 2 3\n"))
              .attributes.empty());
    CHECK(readMesh(folder.write("a.off", "COFF 3 1 0\n0 0 0 x 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n"))
              .attributes.empty());
}

TEST_CASE("readMesh: an OBJ face beyond the vertices is refused at texture seams too", "[io][regression]") {
    const test::TemporaryFolder folder;
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/2 2/2\nf 1/1 2/1 5/1\n";
    const test::Thrown thrown = test::thrownBy([&] { readMesh(folder.write("a.obj", text)); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "uses vertex 4 of 3"));
}

TEST_CASE("readMesh: COFF colours are real if any of them has a point", "[io][regression]") {
    const test::TemporaryFolder folder;
    const Mesh mesh = readMesh(
        folder.write("a.off", "COFF 3 1 0\n0 0 0 1 0.5 0 1\n1 0 0 1 0.5 0 1\n0 1 0 0 1 0 1\n3 0 1 2\n"));
    CHECK(findAttribute(mesh.attributes, "Cd")->values ==
          std::vector<float>{1, 0.5f, 0, 1, 0.5f, 0, 0, 1, 0});
}

TEST_CASE("glTF: names of any bytes are written", "[io][regression]") {
    const test::TemporaryFolder folder;
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 1, 1});
    mesh.attributes = {{"gr\xf6sse", 1, std::vector<float>(8, 2.f)}};
    writeMesh(folder.path("a.glb"), MeshFormat::Glb, mesh);
    CHECK(readMesh(folder.path("a.glb")).attributes[0].name == "gr_sse");
}
