#include "libvdbsynth/io/textured_mesh.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstring>
#include <set>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// Two triangles that share an edge and show two pictures; one shared vertex has two coordinates.
TexturedMesh roof() {
    TexturedMesh textured;
    textured.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
    textured.mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    textured.mesh.attributes = {{"Cd", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}}, {"rough", 1, {0, 1, 2, 3}}};
    textured.normals.assign(4, Vec3f{0, 0, 1});
    textured.corner = {{0, 0}, {0.5f, 0}, {0, 0.25f}, {0.75f, 0}, {1, 1}, {0, 0.25f}};
    textured.pictures = {1, 0};
    const std::string png = encodePng({1, 1, {10, 20, 30}});
    textured.materials = {{"a", png, "", "", true}, {"b", png, png, png, false}};
    textured.comments = {"vdbsynth:test one", "two"};
    return textured;
}

nlohmann::json jsonOf(const std::string& glb) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    return nlohmann::json::parse(glb.substr(20, length));
}

}  // namespace

TEST_CASE("writeTexturedGltf: reads back with a vertex for each coordinate", "[io]") {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.glb", "a.gltf"}) {
        writeTexturedGltf(folder.path(name), std::string(name) == "a.glb", roof());
        const Mesh mesh = readMesh(folder.path(name));
        CHECK(mesh.triangles.size() == 2);
        CHECK(mesh.points.size() == 6);  // 1 has two coordinates, 2 shows two pictures
        const Attribute *uv = findAttribute(mesh.attributes, "uv"),
                        *colour = findAttribute(mesh.attributes, "Cd"),
                        *rough = findAttribute(mesh.attributes, "rough");
        REQUIRE(uv);
        REQUIRE(colour);
        REQUIRE(rough);
        std::set<std::pair<float, float>> seen;
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            seen.insert({uv->values[2 * i], uv->values[2 * i + 1]});
            if (mesh.points[i].x == 1 && mesh.points[i].y == 0) CHECK(rough->values[i] == 1);
        }
        CHECK(seen == std::set<std::pair<float, float>>{{0, 0}, {0.5f, 0}, {0, 0.25f}, {0.75f, 0}, {1, 1}});
    }
}

TEST_CASE("writeTexturedGltf: pictures, samplers and materials stand in the file", "[io]") {
    const test::TemporaryFolder folder;
    writeTexturedGltf(folder.path("a.glb"), true, roof());
    const std::string glb = test::contentOf(folder.path("a.glb"));
    const nlohmann::json json = jsonOf(glb);
    const auto& primitives = json["meshes"][0]["primitives"];
    REQUIRE(primitives.size() == 2);
    CHECK(primitives[0].value("material", 0) == 0);
    CHECK(primitives[1]["material"] == 1);
    CHECK(primitives[0]["attributes"].count("COLOR_0") == 0);  // would multiply the picture
    CHECK(primitives[0]["attributes"].count("TEXCOORD_0") == 1);
    CHECK(json["images"].size() == 4);
    CHECK(json["samplers"][0]["wrapS"] == 10497);
    CHECK(json["samplers"][1]["wrapT"] == 33648);
    CHECK(json["materials"][1].count("normalTexture") == 1);
    CHECK(json["materials"][0]["pbrMetallicRoughness"].count("metallicRoughnessTexture") == 0);
    // The picture's bytes are those of the file that was given.
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    const auto& view = json["bufferViews"][json["images"][0]["bufferView"].get<std::size_t>()];
    const std::size_t at = 20 + length + 8 + view["byteOffset"].get<std::size_t>();
    CHECK(glb.substr(at, view["byteLength"].get<std::size_t>()) == roof().materials[0].colour);
    for (const auto& block : json["bufferViews"]) CHECK(block.value("byteOffset", 0) % 4 == 0);
}

TEST_CASE("writeTexturedObj: colours, coordinates of corners and comments", "[io]") {
    const test::TemporaryFolder folder;
    writeTexturedObj(folder.path("a.obj"), roof());
    const std::string text = test::contentOf(folder.path("a.obj"));
    CHECK(test::contains(text, "# vdbsynth:test one\n"));
    CHECK(test::contains(text, "usemtl a\nf "));
    const Mesh mesh = readMesh(folder.path("a.obj"));
    CHECK(mesh.triangles.size() == 2);
    CHECK(findAttribute(mesh.attributes, "uv"));
    CHECK(findAttribute(mesh.attributes, "Cd"));
}

TEST_CASE("writePly: normals and comments of meshes and points read back", "[io]") {
    const test::TemporaryFolder folder;
    const TexturedMesh from = roof();
    writePly(folder.path("m.ply"), from.mesh, from.normals, from.comments);
    CHECK(plyComments(folder.path("m.ply")) ==
          std::vector<std::string>{"vdb_synth", "vdbsynth:test one", "two"});
    CHECK(readMesh(folder.path("m.ply")).triangles.size() == 2);
    CHECK(readPoints(folder.path("m.ply")).cloud.normals.size() == 4);
    PointCloud cloud;
    cloud.points = from.mesh.points;
    writePly(folder.path("p.ply"), cloud, {"x"});
    CHECK(plyComments(folder.path("p.ply")).back() == "x");
    CHECK(holdsPoints(folder.path("p.ply")));
    CHECK(test::thrownBy([&] { plyComments(folder.path("none.ply")); }).code == int(ErrorCode::Io));
    folder.write("odd.ply", "comment a");
    CHECK(plyComments(folder.path("odd.ply")) == std::vector<std::string>{"a"});
}

TEST_CASE("writeTextured: a mesh without faces, or a folder that is not there", "[io][error]") {
    const test::TemporaryFolder folder;
    TexturedMesh empty = roof();
    empty.mesh.triangles.clear();
    CHECK(test::thrownBy([&] { writeTexturedGltf(folder.path("a.glb"), true, empty); }).code ==
          int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] { writeTexturedObj(folder.path("no/a.obj"), roof()); }).code ==
          int(ErrorCode::Io));
}

TEST_CASE("writeImagePng and writeImageExr: read back as they were", "[io]") {
    const test::TemporaryFolder folder;
    const std::vector<float> values{0, 0.25f, 1, 0.5f, 0.75f, 2};  // 2 is clamped by .png
    for (int bits : {8, 16}) {
        writeImagePng(folder.path("a.png"), 2, 1, 3, bits, values);
        const Raster raster = readRaster(folder.path("a.png"));
        CHECK(raster.channels == 3);
        CHECK(raster.white == (bits == 16 ? 65535 : 255));
        CHECK(double(raster.values[1]) == Approx(0.25 * raster.white).margin(0.51));
        CHECK(double(raster.values[5]) == raster.white);
    }
    writeImageExr(folder.path("a.exr"), 2, 1, 3, values);
    CHECK(readRaster(folder.path("a.exr")).values == values);
    writeImageExr(folder.path("g.exr"), 3, 2, 1, values);
    CHECK(readRaster(folder.path("g.exr")).values == values);
    writeImagePng(folder.path("g.png"), 3, 2, 1, 16, values);
    CHECK(readRaster(folder.path("g.png")).channels == 1);
}
