#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// Three corners of a triangle as floats, then their indices as bytes.
std::string triangleBytes() {
    return test::raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string("\0\1\2", 3);
}

std::string gltf(const std::string& nodes, const std::string& primitive, const std::string& uri,
                 const std::string& more = "") {
    return R"({"asset":{"version":"2.0"},)" + more + R"("buffers":[{"byteLength":39,"uri":")" + uri +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],)"
           R"("meshes":[{"primitives":[)" +
           primitive + R"(]}],"nodes":)" + nodes + R"(,"scenes":[{"nodes":[0]}],"scene":0})";
}

const char* const kPlain = R"({"attributes":{"POSITION":0},"indices":1})";

}  // namespace

TEST_CASE("glTF: attributes come back, in both forms, the same mesh gives the same bytes", "[io][property]") {
    const test::TemporaryFolder folder;
    Mesh mesh = test::sphereMesh(2, 2);
    Attribute colour{"Cd", 3, {}}, uv{"uv", 2, {}}, heat{"heat", 1, {}};
    for (const Vec3f& p : mesh.points) {
        colour.values.insert(colour.values.end(), {0.5f + p.x / 5, 0.5f, 0.25f});
        uv.values.insert(uv.values.end(), {p.x, 0.25f});
        heat.values.push_back(p.z);
    }
    mesh.attributes = {colour, uv, heat};
    for (const auto& [name, format] :
         {std::pair("a.glb", MeshFormat::Glb), std::pair("a.gltf", MeshFormat::Gltf)}) {
        CAPTURE(name);
        writeMesh(folder.path(name), format, mesh);
        const std::string bytes = test::contentOf(folder.path(name));
        writeMesh(folder.path(name), format, mesh);
        CHECK(bytes == test::contentOf(folder.path(name)));
        const Mesh back = readMesh(folder.path(name));
        REQUIRE(back.points.size() == mesh.points.size());
        CHECK(back.triangles == mesh.triangles);
        REQUIRE(back.attributes.size() == 3);
        CHECK(findAttribute(back.attributes, "Cd")->values == colour.values);
        CHECK(findAttribute(back.attributes, "uv")->values == uv.values);
        CHECK(findAttribute(back.attributes, "heat")->values == heat.values);
        CHECK(summarize(back).closedManifold());
    }
}

TEST_CASE("glTF: nodes move, turn and mirror, buffers may be files, strips and fans", "[io][oracle]") {
    const test::TemporaryFolder folder;
    folder.write("b.bin", triangleBytes());
    const Mesh moved = readMesh(folder.write(
        "a.gltf",
        gltf(R"([{"translation":[10,0,0],"children":[1]},{"scale":[2,2,-2],"mesh":0}])", kPlain, "b.bin")));
    REQUIRE(moved.points.size() == 3);
    CHECK(moved.points[1].x == 12);
    CHECK(moved.triangles == std::vector<Triangle>{{1, 0, 2}});  // mirrored, so turned
    const Mesh turned = readMesh(folder.write(
        "a.gltf",
        gltf(R"([{"rotation":[0,0,0.7071067811865476,0.7071067811865476],"mesh":0}])", kPlain, "b.bin")));
    CHECK(turned.points[1].y == Approx(1));
    CHECK(turned.points[1].x == Approx(0).margin(1e-6));
    CHECK(turned.triangles == std::vector<Triangle>{{0, 1, 2}});
    for (const char* mode : {"5", "6"})
        CHECK(readMesh(folder.write("a.gltf", gltf(R"([{"mesh":0}])",
                                                   R"({"mode":)" + std::string(mode) +
                                                       R"(,"attributes":{"POSITION":0},"indices":1})",
                                                   "b.bin")))
                  .triangles.size() == 1);
}

TEST_CASE("glTF: buffers are looked for beside the file, not in the working folder", "[io][regression]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path before = std::filesystem::current_path(), root = folder.path("");
    for (const char* name : {"assets/sub", "work"}) std::filesystem::create_directories(root / name);
    const std::string moved = test::raw<float>({5, 0, 0, 6, 0, 0, 5, 1, 0}) + std::string("\0\1\2", 3);
    for (const char* name : {"b.bin", "sub/b.bin", "two words.bin", "a+b.bin", "\xc3\xa9.bin", "100%.bin"}) {
        folder.write("assets/" + std::string(name), triangleBytes());
        folder.write("work/" + fileNameOf(name), moved);
    }
    folder.write("work/c.bin", moved);
    folder.write("outside.bin", triangleBytes());
    const auto read = [&](const std::string& uri) {
        folder.write("assets/a.gltf", gltf(R"([{"mesh":0}])", kPlain, uri));
        return test::thrownBy([] {
            const Mesh mesh = readMesh("../assets/a.gltf");
            if (mesh.points[0].x != 0) throw Error(ErrorCode::Solver, "that is the other file");
        });
    };
    std::filesystem::current_path(root / "work");
    for (const char* uri :
         {"b.bin", "./b.bin", "sub/b.bin", "sub/../b.bin", "sub/%2e%2e/b.bin", "two%20words.bin",
          "two words.bin", "a+b.bin", "a%2Bb.bin", "%C3%A9.bin", "100%25.bin"}) {
        CAPTURE(uri);
        CHECK(read(uri).message == "");
    }
    const std::string absolute = (root / "outside.bin").string();
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("%2E%2E/outside.bin"),
          std::string("sub/../../outside.bin"), absolute, "/" + absolute, std::string("file://") + absolute,
          std::string("c.bin"), std::string("b.bin%00")}) {
        const test::Thrown thrown = read(uri);
        CAPTURE(uri, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "../assets/a.gltf: "));
        CHECK(
            test::contains(thrown.message, uri == "c.bin" ? "../assets/c.bin: no such file" : "its file \""));
    }
    std::filesystem::current_path(before);
}

TEST_CASE("glTF: errors name the file and what is wrong", "[io][error]") {
    const test::TemporaryFolder folder;
    folder.write("b.bin", triangleBytes());
    const auto refused = [&](const std::string& content, const std::string& words) {
        const test::Thrown thrown = test::thrownBy([&] { readMesh(folder.write("a.gltf", content)); });
        CAPTURE(words, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.gltf: "));
        CHECK(test::contains(thrown.message, words));
        CHECK_FALSE(test::contains(thrown.message, "\n"));
    };
    const char* const node = R"([{"mesh":0}])";
    refused("nonsense", "not a whole glTF file");
    refused(gltf(node, kPlain, "none.bin"), "none.bin");
    refused(gltf(R"([{"mesh":7}])", kPlain, "b.bin"), "does not exist");
    refused(gltf(R"([{"children":[0]}])", kPlain, "b.bin"), "not a tree");
    refused(gltf(node, R"({"attributes":{"POSITION":9}})", "b.bin"), "does not exist");
    refused(gltf(node, R"({"attributes":{"POSITION":1}})", "b.bin"), "not vectors of three");
    refused(gltf(node, R"({"attributes":{"POSITION":0},"indices":0})", "b.bin"), "not whole numbers");
    refused(gltf(node, kPlain, "b.bin", R"("extensionsRequired":["KHR_draco_mesh_compression"],)"),
            "export it without");
    std::string large = gltf(node, kPlain, "b.bin");
    large.replace(large.find("\"count\":3"), 9, "\"count\":9");
    refused(large, "reaches beyond its buffer");
    folder.write("b.bin", test::raw<float>({0, 0, 0, 1, 0, 0, 0, 1, NAN}) + std::string("\0\1\2", 3));
    refused(gltf(node, kPlain, "b.bin"), "not a finite number");
    folder.write("b.bin", triangleBytes().substr(0, 36) + "\7\7\7");
    refused(gltf(node, kPlain, "b.bin"), "a vertex that does not exist");
}
