// glTF beyond plain meshes: instances, skins, morph targets, extensions, scenes, points.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "tests/support/gltf_files.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;
using nlohmann::json;

namespace {

// What readMesh makes of a file, and what it says.
struct Read {
    MeshSummary summary;
    Mesh mesh;
    std::string said;
};

Read read(const std::string& bytes, const std::string& name = "a.glb") {
    const test::TemporaryFolder folder;
    Read result;
    RunContext ctx;
    ctx.maxMemory = 1000000000;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { result.said += text + "\n"; };
    result.mesh = readMesh(folder.write(name, bytes), ctx);
    result.summary = summarize(result.mesh);
    return result;
}

Read read(const test::GltfMaker& maker) {
    return read(maker.bytes());
}

void refused(const std::string& bytes, const std::string& words, ErrorCode code = ErrorCode::BadData) {
    const test::Thrown thrown = test::thrownBy([&] { read(bytes); });
    CAPTURE(words, thrown.message);
    CHECK(thrown.code == int(code));
    CHECK(test::contains(thrown.message, "a.glb: "));
    CHECK(test::contains(thrown.message, words));
    for (const char c : thrown.message) CHECK((c >= ' ' && c <= '~'));
}

void refused(const test::GltfMaker& maker, const std::string& words) {
    refused(maker.bytes(), words);
}

bool near(const Vec3d& a, const Vec3d& b) {
    return length(a - b) < 1e-5;
}

// The cube with all corners on joints 0 and 1, by these weights.
test::GltfMaker skinned(std::vector<float> weights, const std::vector<json>& joints) {
    test::GltfMaker maker;
    std::vector<std::uint8_t> names;
    std::vector<float> all;
    for (int i = 0; i < 8; ++i) {
        names.insert(names.end(), {0, 1, 0, 0});
        all.insert(all.end(), {weights[0], weights[1], 0, 0});
    }
    maker.primitive()["attributes"]["JOINTS_0"] = maker.add<std::uint8_t>(names, "VEC4", 5121);
    maker.primitive()["attributes"]["WEIGHTS_0"] = maker.add<float>(all, "VEC4", 5126);
    for (const json& joint : joints) maker.json["nodes"].push_back(joint);
    maker.json["nodes"][0]["skin"] = 0;
    maker.json["skins"] = {{{"joints", {1, 2}}}};
    return maker;
}

}  // namespace

TEST_CASE("glTF instances: places, turns and sizes by hand, also as normalised integers", "[io][oracle]") {
    test::GltfMaker maker;
    const auto instances = [&](const json& attributes) {
        maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
    };
    maker.json["nodes"][0]["translation"] = {0, 0, 5};
    const int places = maker.add<float>({0, 0, 0, 10, 0, 0, 20, 0, 0}, "VEC3", 5126);
    instances({{"TRANSLATION", places}});
    for (const bool required : {false, true}) {
        if (required) maker.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
        const Read three = read(maker);
        CHECK(three.summary.signedVolume == Approx(3));
        CHECK(near(three.summary.boxMin, {0, 0, 5}));
        CHECK(near(three.summary.boxMax, {21, 1, 6}));
        CHECK(three.said == "");
    }
    // A quarter turn about z, as bytes that are not quite of length one; the second one mirrored and twice as
    // large.
    const int turns = maker.add<std::int8_t>({0, 0, 90, 90, 0, 0, 0, 127}, "VEC4", 5120, true);
    const int sizes = maker.add<float>({1, 1, 1, 2, 2, -2}, "VEC3", 5126);
    const int moves = maker.add<std::int16_t>({0, 0, 0, 100, 0, 0}, "VEC3", 5122);
    instances({{"TRANSLATION", moves}, {"ROTATION", turns}, {"SCALE", sizes}});
    const Read two = read(maker);
    CHECK(two.summary.signedVolume == Approx(9));
    CHECK(near(two.summary.boxMin, {-1, 0, 3}));
    CHECK(near(two.summary.boxMax, {102, 2, 6}));
    instances(json::object());
    CHECK(test::contains(read(maker).said, "instances have no places"));
    instances({{"TRANSLATION", places}, {"SCALE", sizes}});
    refused(maker, "SCALE of its instances has 2 values, others have 3");
    instances({{"TRANSLATION", 1}});
    refused(maker, "not a vector of 3");
    instances({{"TRANSLATION", 99}});
    refused(maker, "an accessor does not exist");
}

TEST_CASE("glTF instances: many copies of many vertices are refused before memory is taken", "[io][error]") {
    test::GltfMaker maker;
    maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        maker.add<float>(std::vector<float>(900000), "VEC3", 5126);
    maker.primitive()["attributes"]["POSITION"] = maker.add<float>(std::vector<float>(9000), "VEC3", 5126);
    refused(maker.bytes(), "its vertices needs", ErrorCode::Memory);
}

TEST_CASE("glTF skins: joints alone say where a vertex is", "[io][oracle]") {
    // Half of (1, 0, 0) and half of (0, 4, 0); the node's own place does not count.
    test::GltfMaker maker =
        skinned({0.5f, 0.5f}, {{{"translation", {1, 0, 0}}}, {{"translation", {0, 4, 0}}}});
    maker.json["nodes"][0]["translation"] = {100, 100, 100};
    CHECK(near(read(maker).summary.boxMin, {0.5, 2, 0}));
    // Weights need not sum to one, and may be integers.
    test::GltfMaker uneven = skinned({3, 1}, {{{"translation", {4, 0, 0}}}, json::object()});
    CHECK(near(read(uneven).summary.boxMin, {3, 0, 0}));
    uneven.primitive()["attributes"]["WEIGHTS_0"] =
        uneven.add<std::uint8_t>(std::vector<std::uint8_t>(32, 10), "VEC4", 5121, true);
    CHECK(near(read(uneven).summary.boxMin, {3, 0, 0}));
    // Inverse bind matrices, and a joint below a scaled node that no scene holds.
    test::GltfMaker bound = skinned(
        {1, 0},
        {{{"translation", {1, 0, 0}}}, json::object(), {{"scale", {0.5, 0.5, 0.5}}, {"children", {1}}}});
    bound.json["skins"][0]["inverseBindMatrices"] = bound.add<float>(
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 4, 6, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
        "MAT4", 5126);
    const Read scaled = read(bound);
    CHECK(near(scaled.summary.boxMin, {1.5, 2, 3}));
    CHECK(scaled.summary.signedVolume == Approx(0.125));
    // A mirrored joint turns the faces.
    CHECK(read(skinned({1, 0}, {{{"scale", {-1, 1, 1}}}, json::object()})).summary.signedVolume == Approx(1));
}

TEST_CASE("glTF skins: a second set of joints, vertices without weights", "[io][oracle]") {
    test::GltfMaker maker = skinned({1, 0}, {{{"translation", {8, 0, 0}}}, json::object()});
    maker.primitive()["attributes"]["JOINTS_1"] =
        maker.add<std::uint16_t>(std::vector<std::uint16_t>(32, 1), "VEC4", 5123);
    std::vector<float> weights;
    for (int i = 0; i < 8; ++i) weights.insert(weights.end(), {3, 0, 0, 0});
    maker.primitive()["attributes"]["WEIGHTS_1"] = maker.add<float>(weights, "VEC4", 5126);
    CHECK(near(read(maker).summary.boxMin, {2, 0, 0}));
    const Read loose = read(skinned({0, 0}, {{{"translation", {8, 0, 0}}}, json::object()}));
    CHECK(near(loose.summary.boxMin, {8, 0, 0}));
    CHECK(test::contains(loose.said, "8 vertices without weights"));
}

TEST_CASE("glTF skins: a mesh without joints stays at its node, one with instances is read once",
          "[io][oracle]") {
    test::GltfMaker maker = skinned({1, 0}, {json::object(), json::object()});
    maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        maker.add<float>({0, 0, 0, 9, 0, 0}, "VEC3", 5126);
    const Read once = read(maker);
    CHECK(once.summary.signedVolume == Approx(1));
    CHECK(test::contains(once.said, "it is read once"));
    maker = skinned({1, 0}, {{{"translation", {7, 0, 0}}}, json::object()});
    maker.json["nodes"][0]["translation"] = {3, 0, 0};
    maker.primitive()["attributes"].erase("WEIGHTS_0");
    const Read plain = read(maker);
    CHECK(near(plain.summary.boxMin, {3, 0, 0}));
    CHECK(test::contains(plain.said, "1 primitives with a skin and no joints"));
}

TEST_CASE("glTF skins: what is wrong is named", "[io][error]") {
    const std::vector<json> joints{json::object(), json::object()};
    const auto changed = [&](const std::string& pointer, const json& value) {
        test::GltfMaker maker = skinned({1, 1}, joints);
        maker.json[json::json_pointer(pointer)] = value;
        return maker;
    };
    refused(changed("/nodes/0/skin", 3), "a skin does not exist");
    refused(changed("/skins/0/joints", {1, 9}), "a joint does not exist");
    refused(changed("/skins/0/joints", {1}), "a joint that its skin does not have");
    refused(changed("/skins/0/joints", {"x"}), "not a list of whole numbers");
    refused(changed("/skins/0/inverseBindMatrices", 0), "2 joints and 0 inverse bind matrices");
    refused(changed("/meshes/0/primitives/0/attributes/JOINTS_0", 0), "not vectors of four");
    test::GltfMaker circle = changed("/nodes/1/children", {2});
    circle.json["nodes"][2]["children"] = {1};
    refused(circle, "not a tree");
}

TEST_CASE("glTF morph targets: default weights, sparse and integer targets", "[io][oracle]") {
    test::GltfMaker maker;
    std::vector<float> up(24, 0.f);
    for (std::size_t i = 2; i < 24; i += 3) up[i] = 4;
    maker.primitive()["targets"] = {{{"POSITION", maker.add<float>(up, "VEC3", 5126)}}};
    CHECK(near(read(maker).summary.boxMin, {0, 0, 0}));
    maker.json["meshes"][0]["weights"] = {0.5};
    CHECK(near(read(maker).summary.boxMin, {0, 0, 2}));
    maker.json["nodes"][0]["weights"] = {0.25};
    CHECK(near(read(maker).summary.boxMin, {0, 0, 1}));
    // A sparse target without a view of its own moves corner 7 alone; normals do not matter.
    const json& accessors = maker.json["accessors"];
    const int rows = maker.add<std::uint16_t>({7}, "SCALAR", 5123),
              steps = maker.add<float>({2, 0, 0}, "VEC3", 5126);
    maker.json["accessors"].push_back(
        {{"componentType", 5126},
         {"count", 8},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 1},
           {"indices", {{"bufferView", accessors[std::size_t(rows)]["bufferView"]}, {"componentType", 5123}}},
           {"values", {{"bufferView", accessors[std::size_t(steps)]["bufferView"]}}}}}});
    maker.primitive()["targets"].push_back({{"POSITION", accessors.size() - 1}, {"NORMAL", 0}});
    maker.json["nodes"][0]["weights"] = {0, 1};
    CHECK(near(read(maker).summary.boxMax, {3, 1, 1}));
    const int bytes = maker.add<std::int8_t>(std::vector<std::int8_t>(24, 127), "VEC3", 5120, true);
    maker.primitive()["targets"][0]["POSITION"] = bytes;
    maker.json["nodes"][0]["weights"] = {3};
    CHECK(near(read(maker).summary.boxMin, {3, 3, 3}));
    maker.primitive()["targets"][0]["POSITION"] = 1;
    refused(maker, "a morph target has 36 positions for 8 vertices");
}

TEST_CASE("glTF: required extensions are read, harmless or refused by name", "[io][error]") {
    test::GltfMaker maker;
    for (const char* name : {"KHR_mesh_quantization", "KHR_texture_transform", "KHR_materials_unlit",
                             "KHR_texture_basisu", "KHR_lights_punctual", "KHR_node_visibility"}) {
        maker.json["extensionsRequired"] = maker.json["extensionsUsed"] = {name};
        CHECK(read(maker).said == "");
    }
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "MESHOPT_compression",
                             "KHR_meshopt_compression"}) {
        maker.json["extensionsRequired"] = {"KHR_materials_unlit", name};
        refused(maker, std::string("is compressed with ") + name);
        refused(maker, "without compression");
    }
    maker.json["extensionsRequired"] = {"ACME_\xc3\xa9\nfolded_space"};
    refused(maker, "requires the extension ACME_???folded_space, which is not supported");
    maker.json["extensionsRequired"] = json::array();
    maker.json["extensionsUsed"] = {"ACME_bolts", "KHR_draco_mesh_compression"};
    CHECK(test::contains(read(maker).said, "without what these extensions add: ACME_bolts\n"));
}

TEST_CASE("glTF: compressed data is read from its fallback if that is whole", "[io][oracle]") {
    test::GltfMaker draco;
    draco.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
    CHECK(read(draco).summary.signedVolume == Approx(1));
    draco.json["accessors"][1].erase("bufferView");
    refused(draco, "is compressed with KHR_draco_mesh_compression");
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        test::GltfMaker meshopt;
        meshopt.json["bufferViews"][0]["extensions"][name] = {{"buffer", 0}};
        CHECK(read(meshopt).summary.signedVolume == Approx(1));
        json whole = meshopt.json;
        whole["buffers"] = {{{"byteLength", meshopt.binary.size()}},
                            {{"byteLength", 96}, {"extensions", {{name, {{"fallback", true}}}}}}};
        whole["bufferViews"][0]["buffer"] = 1;
        refused(test::glb(whole.dump(), meshopt.binary), std::string("is compressed with ") + name);
        whole["buffers"][1]["uri"] = "none.bin";
        refused(test::glb(whole.dump(), meshopt.binary), std::string("is compressed with ") + name);
    }
}

TEST_CASE("glTF: other versions are refused by name", "[io][error]") {
    const std::string cube = test::GltfMaker().bytes();
    for (const json& version : {json("1.0"), json("1.1"), json(1), json("1")}) {
        test::GltfMaker maker;
        maker.json["asset"]["version"] = version;
        refused(maker, "glTF 1.0 is not read; convert it to 2.0");
    }
    refused(test::glb(R"({"meshes":{"a":{}},"accessors":{}})", ""), "glTF 1.0 is not read");
    refused(test::glb("{}", "", 1), "glTF 1.0 (binary) is not read; convert it to 2.0");
    test::GltfMaker later;
    later.json["asset"]["version"] = "3.0";
    refused(later, "glTF 3.0 is not read");
    later.json["asset"] = {{"version", "2.1"}};
    CHECK(read(later).said == "");
    later.json["asset"]["minVersion"] = "2.1";
    refused(later, "glTF 2.1 is not read");
    later.json["asset"] = {{"version", 2.0}};
    CHECK(read(later).said == "");
    later.json.erase("asset");
    CHECK(test::contains(read(later).said, "names no version of glTF; read as 2.0"));
    refused(test::glb(R"({"metadata":{"type":"Object"}})", ""), "names no version of glTF");
    refused(test::glb("[]", ""), "no object");
}

TEST_CASE("glTF: containers of careless writers", "[io][oracle]") {
    const std::string cube = test::GltfMaker().bytes();
    CHECK(read(cube + "trailing").summary.signedVolume == Approx(1));
    std::string wrong = cube;
    wrong.replace(8, 4, std::string(4, '\0'));
    CHECK(read(wrong).summary.signedVolume == Approx(1));
    // A byte that nothing uses is cut off, then one of the triangles.
    test::GltfMaker more;
    more.add<std::uint8_t>({1, 2, 3, 4}, "SCALAR", 5121);
    const Read cut = read(more.bytes().substr(0, more.bytes().size() - 1));
    CHECK(cut.summary.signedVolume == Approx(1));
    CHECK(test::contains(cut.said, "the last 1 byte of its data is missing"));
    refused(cube.substr(0, cube.size() - 1), "the file is truncated");
    refused(cube.substr(0, 200), "its JSON is cut off (180 of");
    refused(cube.substr(0, 15), "cut off in its header");
    std::string noJson = cube;
    noJson.replace(16, 4, "JSOM");
    refused(noJson, "its first chunk is no JSON");
    // Letters that are not UTF-8, and a name of 100 000 brackets in brackets.
    test::GltfMaker named;
    named.json["nodes"][0]["name"] = "NAME";
    std::string latin = named.bytes();
    latin.replace(latin.find("NAME"), 4, "\xe9\xe8\xff\x80");
    CHECK(test::contains(read(latin).said, "not UTF-8"));
    named.json["extras"] = "DEEP";
    json whole = named.json;
    whole["buffers"] = {{{"byteLength", named.binary.size()}}};
    std::string text = whole.dump();
    text.replace(text.find("\"DEEP\""), 6, std::string(100000, '[') + std::string(100000, ']'));
    CHECK(read(test::glb(text, named.binary)).summary.signedVolume == Approx(1));
    refused(test::glb("{\"asset\":{\"version\":\"2.0\"},\x01\xff", ""),
            "its JSON is invalid or cut off at byte");
    refused(test::glb(R"({"asset":{"version":"2.0"},"extras":1e999})", ""), "number that is too large");
}

TEST_CASE("glTF: scenes, loose and hidden nodes, a file without nodes", "[io][oracle]") {
    test::GltfMaker maker;
    maker.json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
    Read one = read(maker);
    CHECK(one.summary.signedVolume == Approx(1));
    CHECK(test::contains(one.said, "1 node with a mesh in no scene left out"));
    maker.json["scenes"].push_back({{"nodes", {1}}});
    one = read(maker);
    CHECK(test::contains(one.said, "1 other scene with 1 node of meshes left out"));
    CHECK_FALSE(test::contains(one.said, "no scene"));
    maker.json["scene"] = 1;
    CHECK(near(read(maker).summary.boxMin, {5, 0, 0}));
    maker.json["scene"] = 7;
    refused(maker, "its scene does not exist");
    maker.json.erase("scenes");
    maker.json.erase("scene");
    CHECK(read(maker).summary.signedVolume == Approx(2));
    maker.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
    one = read(maker);
    CHECK(one.summary.signedVolume == Approx(1));
    CHECK(test::contains(one.said, "1 hidden node with a mesh left out"));
    maker.json.erase("nodes");
    one = read(maker);
    CHECK(one.summary.signedVolume == Approx(1));
    CHECK(test::contains(one.said, "has no nodes"));
}

TEST_CASE("glTF: what is left out is said", "[io][oracle]") {
    test::GltfMaker maker;
    maker.json["animations"] = {json::object(), json::object()};
    for (const int mode : {0, 1, 2, 3})
        maker.json["meshes"][0]["primitives"].push_back({{"mode", mode}, {"attributes", {{"POSITION", 0}}}});
    maker.json["meshes"][0]["primitives"].push_back({{"attributes", json::object()}});
    maker.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
    const Read mixed = read(maker);
    CHECK(test::contains(
        mixed.said, "3 primitives of lines and 1 primitive of points left out; only triangles are read"));
    CHECK(test::contains(mixed.said, "2 animations left out"));
    CHECK(test::contains(mixed.said, "1 primitives without positions left out"));
    CHECK(test::contains(mixed.said, "2 corners at the end"));
    maker.json["meshes"][0]["primitives"] = {{{"mode", 1}, {"attributes", {{"POSITION", 0}}}}};
    refused(maker, "holds only lines (1 in number)");
    maker.primitive()["mode"] = 9;
    refused(maker, "a primitive's mode is not one of glTF's");
}

TEST_CASE("glTF points: a cloud with normals and colours at its place", "[io][oracle]") {
    const test::TemporaryFolder folder;
    test::GltfMaker maker;
    std::vector<float> normals, colours;
    for (int i = 0; i < 8; ++i) {
        normals.insert(normals.end(), {1, 0, 0});
        colours.insert(colours.end(), {float(i) / 8, 0, 0});
    }
    maker.json["meshes"][0]["primitives"] = {{{"mode", 0},
                                              {"attributes",
                                               {{"POSITION", 0},
                                                {"NORMAL", maker.add<float>(normals, "VEC3", 5126)},
                                                {"COLOR_0", maker.add<float>(colours, "VEC3", 5126)}}}},
                                             {{"mode", 1}, {"attributes", {{"POSITION", 0}}}}};
    maker.json["nodes"][0]["scale"] = {-1e-4, 2, 3};
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
    const std::string path = folder.write("a.glb", maker.bytes());
    REQUIRE(holdsPoints(path));
    const PointFile file = readPoints(path, ctx);
    REQUIRE(file.cloud.points.size() == 8);
    CHECK(file.cloud.points[7].z == 3);
    REQUIRE(file.cloud.normals.size() == 8);
    CHECK(file.cloud.normals[3].x == -1);
    CHECK(findAttribute(file.cloud.attributes, "Cd")->values == colours);
    CHECK(test::contains(said, "1 primitive of lines left out; only points are read"));
    // Indices choose points.
    maker.primitive()["indices"] = maker.add<std::uint8_t>({7, 7, 2, 3}, "SCALAR", 5121);
    const PointFile chosen = readPoints(folder.write("b.glb", maker.bytes()));
    REQUIRE(chosen.cloud.points.size() == 3);
    CHECK(chosen.cloud.points[2].z == 3);
    CHECK(findAttribute(chosen.cloud.attributes, "Cd")->values.size() == 9);
    refused(maker, "holds points and no triangles");
    CHECK_FALSE(holdsPoints(folder.write("c.glb", test::GltfMaker().bytes())));
    // A long JSON, of which the beginning is not enough.
    maker.json["extras"] = std::string(100000, 'x');
    CHECK(holdsPoints(folder.write("d.glb", maker.bytes())));
    CHECK(
        holdsPoints(folder.write("e.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":)"
                                           R"([{"primitives":[{"mode":0,"attributes":{"POSITION":0}}]}]})")));
    CHECK(test::contains(test::thrownBy([&] { holdsPoints(folder.write("f.gltf", "[1,")); }).message,
                         "f.gltf: not a whole glTF file"));
}

TEST_CASE("glTF buffers: data addresses of many writers, files named carelessly", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const std::string start =
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
        R"({"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,)"
        R"("count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":)"
        R"([{"byteLength":36,"uri":")";
    const std::string base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    for (const char* head : {"data:application/octet-stream;base64,", "data:application/gltf-buffer;base64,",
                             "data:;base64,", "data:application/octet-stream;charset=utf-8;base64,"})
        CHECK(read(start + head + base64 + "\"}]}", "a.gltf").summary.area == Approx(0.5));
    const std::string bytes = test::raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    folder.write("a%20b.bin", bytes + "more");
    std::filesystem::create_directories(folder.path("sub"));
    folder.write("sub/c.bin", bytes);
    for (const char* uri : {"a%20b.bin", "sub\\\\c.bin"})
        CHECK(readMesh(folder.write("b.gltf", start + uri + "\"}]}")).points.size() == 3);
    // What materials need is not looked for.
    CHECK(readMesh(folder.write("b.gltf", start + R"(sub/c.bin"}],"images":[{"uri":"none.png"},{}]})"))
              .points.size() == 3);
    const test::Thrown thrown =
        test::thrownBy([&] { readMesh(folder.write("b.gltf", start + "%ff%0a.bin\"}]}")); });
    CHECK(test::contains(thrown.message, "??.bin: no such file"));
    CHECK(test::contains(
        test::thrownBy([&] { readMesh(folder.write("b.gltf", start + "data:;base64,%\"}]}")); }).message,
        "its base64 is invalid"));
}

TEST_CASE("glTF numbers: strides of any size, doubles, quantised positions", "[io][oracle]") {
    test::GltfMaker maker;
    std::vector<double> corners;
    std::vector<std::uint16_t> quantised;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            corners.push_back(1e6 + 0.125 * (i >> axis & 1));
            quantised.push_back(std::uint16_t(i >> axis & 1 ? 65535 : 0));
        }
    maker.primitive()["attributes"]["POSITION"] = maker.add<double>(corners, "VEC3", 5130);
    CHECK(near(read(maker).summary.boxMax, {1000000.125, 1000000.125, 1000000.125}));
    maker.primitive()["attributes"]["POSITION"] = maker.add<std::uint16_t>(quantised, "VEC3", 5123, true);
    maker.json["bufferViews"].back()["byteStride"] = 6;
    CHECK(read(maker).summary.signedVolume == Approx(1));
    maker.json["accessors"].back()["count"] = 1000000000000;
    refused(maker, "the file is truncated");
    maker.json["accessors"].back().erase("bufferView");
    refused(maker, "the file is truncated");
    maker.json["accessors"].back()["count"] = -1;
    refused(maker, "\"count\" is not a whole number");
    maker.json["accessors"].back()["componentType"] = 5127;
    refused(maker, "component type");
    maker.json["nodes"][0]["matrix"] = {1, 2, 3};
    refused(maker, "\"matrix\" has 3 numbers, not 16");
}

TEST_CASE("glTF: an origin is written as a translation in double and comes back", "[io][property]") {
    const test::TemporaryFolder folder;
    Mesh mesh = test::boxMesh({-1, -1, -1}, {1, 2, 3.1f});
    for (const auto& [name, format] :
         {std::pair("a.glb", MeshFormat::Glb), std::pair("a.gltf", MeshFormat::Gltf)}) {
        mesh.origin = {};
        writeMesh(folder.path(name), format, mesh);
        CHECK_FALSE(test::contains(test::contentOf(folder.path(name)), "translation"));
        mesh.origin = {500000.125, 5400000.0625, -1.0 / 3};
        writeMesh(folder.path(name), format, mesh);
        const Mesh back = readMesh(folder.path(name));
        REQUIRE(back.points.size() == mesh.points.size());
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            const Vec3d right = mesh.origin + cast<double>(mesh.points[i]),
                        found = back.origin + cast<double>(back.points[i]);
            CHECK(length(found - right) < 1e-6);
        }
    }
}
