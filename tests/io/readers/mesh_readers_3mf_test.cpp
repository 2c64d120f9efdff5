#include <catch2/catch.hpp>

#include <atomic>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_file.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/threemf_files.h"

using namespace vdbsynth;

namespace {

const char* const kItem = R"(<item objectid="1"/>)";

// A file, read, with what was said.
struct Reading {
    explicit Reading(const std::string& content) {
        mesh = readMesh(folder.write("a.3mf", content), said.ctx);
    }
    test::TemporaryFolder folder;
    test::Said said;
    Mesh mesh;
};

test::Thrown refusal(const std::string& content, const RunContext& ctx = {}) {
    const test::TemporaryFolder folder;
    return test::thrownBy([&, path = folder.write("a.3mf", content)] { readMesh(path, ctx); });
}

std::vector<float> colourAt(const Mesh& mesh, std::size_t vertex) {
    const Attribute* colour = findAttribute(mesh.attributes, "Cd");
    REQUIRE(colour);
    return {colour->values.begin() + std::ptrdiff_t(3 * vertex),
            colour->values.begin() + std::ptrdiff_t(3 * vertex + 3)};
}

}  // namespace

TEST_CASE("3MF: an object that is built comes as it is", "[io][fast]") {
    const Reading read(test::threemf(test::tetrahedron("1"), kItem));
    CHECK(read.mesh.points.size() == 4);
    CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    CHECK(summarize(read.mesh).signedVolume == Approx(1.0 / 6));
    CHECK(read.mesh.attributes.empty());
    CHECK(read.said.nothing());
}

TEST_CASE("3MF: transforms are rows, components nest, mirrored ones are turned", "[io][fast]") {
    // A quarter turn about z, then a step: (x, y, z) becomes (-y, x, z) + (5, 0, 0).
    const Reading turned(test::threemf(test::tetrahedron("1"),
                                       R"(<item objectid="1" transform="0 1 0 -1 0 0 0 0 1 5 0 0"/>)"));
    CHECK(turned.mesh.points[1].x == 5);
    CHECK(turned.mesh.points[1].y == 1);
    CHECK(turned.mesh.points[2].x == 4);
    CHECK(summarize(turned.mesh).signedVolume == Approx(1.0 / 6));
    // The inner one first: scaled, then moved.
    const Reading nested(test::threemf(
        test::tetrahedron("1") +
            R"(<object id="2"><components><component objectid="1" transform="2 0 0 0 2 0 0 0 -2 0 0 0"/>)"
            R"(<component objectid="1"/></components></object>)",
        R"(<item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 20 30"/>)"));
    REQUIRE(nested.mesh.points.size() == 8);
    CHECK(nested.mesh.points[1].x == 12);
    CHECK(nested.mesh.points[3].z == 28);
    CHECK(nested.mesh.points[5].x == 11);
    CHECK(summarize(nested.mesh).signedVolume == Approx(8.0 / 6 + 1.0 / 6));
}

TEST_CASE("3MF: parts in other model files are read, in any case of their names", "[io][fast]") {
    const std::string part = test::threemfModelText(test::tetrahedron("1"), R"(<item objectid="99"/>)");
    const Reading read(test::threemf(
        R"(<object id="3"><components><component p:path="/3D/objects/A.model" objectid="1"/></components></object>)",
        R"(<item objectid="3"/><item objectid="1" p:path="/3d/Objects/a.model"/>)",
        {{"3D/Objects/a.model", part}}, R"(unit="millimeter" requiredextensions="p")"));
    CHECK(read.mesh.points.size() == 8);
    CHECK(test::contains(refusal(test::threemf("", R"(<item objectid="1" p:path="/3D/b.model"/>)")).message,
                         "refers to 3d/b.model"));
}

TEST_CASE("3MF: colours of objects, triangles and corners", "[io][fast]") {
    const std::string groups =
        R"(<basematerials id="7"><base name="red" displaycolor="#FF0000"/><base name="b" displaycolor="#0000FF"/></basematerials>)"
        R"(<m:colorgroup id="8"><m:color color="#00FF00"/><m:color color="#33669980"/></m:colorgroup>)";
    const Reading plain(test::threemf(groups + test::tetrahedron("1", R"(pid="7" pindex="1")"), kItem));
    CHECK(plain.mesh.points.size() == 4);
    CHECK(colourAt(plain.mesh, 2) == std::vector<float>{0, 0, 1});
    CHECK(plain.mesh.attributes.size() == 1);

    // The first triangle has a colour of its own: its vertices are split from the others'.
    const Reading face(
        test::threemf(groups + test::tetrahedron("1", R"(pid="7" pindex="0")", R"(pid="8" p1="1")"), kItem));
    CHECK(face.mesh.points.size() == 7);
    CHECK(colourAt(face.mesh, face.mesh.triangles[0][0]) == std::vector<float>{0.2f, 0.4f, 0.6f});
    CHECK(colourAt(face.mesh, face.mesh.triangles[1][0]) == std::vector<float>{1, 0, 0});
    REQUIRE(findAttribute(face.mesh.attributes, "Alpha"));
    CHECK(findAttribute(face.mesh.attributes, "Alpha")->values[face.mesh.triangles[0][0]] ==
          Approx(128 / 255.));
    Mesh welded = face.mesh;
    weldVertices(welded);
    CHECK(summarize(welded).closedManifold());

    // Colours at corners; what has none takes part in its vertices' own.
    const Reading corners(
        test::threemf(groups + test::tetrahedron("1", "", R"(pid="8" p1="0" p2="1" p3="0")"), kItem));
    CHECK(corners.mesh.points.size() == 4);
    CHECK(colourAt(corners.mesh, 0) == std::vector<float>{0, 1, 0});
    CHECK(colourAt(corners.mesh, 2) == std::vector<float>{0.2f, 0.4f, 0.6f});
    CHECK(colourAt(corners.mesh, 3) == std::vector<float>{1, 1, 1});
}

TEST_CASE("3MF: what is left out is said", "[io][error]") {
    const Reading read(test::threemf(
        R"(<m:texture2dgroup id="5"/><m:compositematerials id="6"/>)" +
            test::tetrahedron("1", "", R"(pid="5" p1="0" paint_color="4")") +
            test::tetrahedron("2", "", R"(pid="6" p1="0")") + test::tetrahedron("3", R"(type="support")") +
            test::tetrahedron("4", R"(pid="77" pindex="1")") + test::tetrahedron("8") +
            test::tetrahedron("9", R"(type="other")"),
        R"(<item objectid="1"/><item objectid="2"/><item objectid="3"/><item objectid="4"/><item objectid="9"/>)",
        {}, R"(unit="inch")"));
    const std::string said = read.said.all();
    for (const char* line :
         {"a.3mf: its unit is inch, and coordinates stay as they are; `unitScale` 25.4",
          "1 object of support left out", "1 object of no printed type left out",
          "1 object that nothing places left out", "1 triangle with a picture",
          "1 triangle with mixed materials", "4 triangles with a colour that does not exist",
          "1 triangle painted in a slicer"})
        CHECK(test::contains(said, line));
    CHECK(read.mesh.points.size() == 12);
}

TEST_CASE("3MF: modifiers and negative volumes of slicers are no part of the shape", "[io][fast]") {
    const std::string volumes =
        R"(<config><object id="1"><volume firstid="0" lastid="0"><metadata key="volume_type" value="ModelPart"/></volume>)"
        R"(<volume firstid="1" lastid="2"><metadata key="volume_type" value="ParameterModifier"/></volume>)"
        R"(<volume firstid="3" lastid="9999999999"><metadata key="volume_type" value="NegativeVolume"/></volume></object></config>)";
    const Reading prusa(
        test::threemf(test::tetrahedron("1"), kItem, {{"Metadata/Slic3r_PE_model.config", volumes}}));
    CHECK(prusa.mesh.triangles.size() == 1);
    CHECK(test::contains(prusa.said.all(), "1 modifier of a slicer left out"));
    CHECK(test::contains(prusa.said.all(), "1 negative volume of a slicer left out, not subtracted"));
    const Reading bambu(test::threemf(
        test::tetrahedron("1") + test::tetrahedron("2") +
            R"(<object id="3"><components><component objectid="1"/><component objectid="2"/></components></object>)",
        R"(<item objectid="3"/>)",
        {{"Metadata/model_settings.config",
          R"(<config><object id="3"><part id="1" subtype="normal_part"/><part id="2" subtype="modifier_part"/></object></config>)"}}));
    CHECK(bambu.mesh.points.size() == 4);
    CHECK(test::contains(bambu.said.all(), "1 modifier"));
}

TEST_CASE("3MF: without relations or a build the model is found, aloud", "[io][fast]") {
    const Reading read(test::package({{"x/y.model", test::threemfModelText(test::tetrahedron("1"), "")}}));
    CHECK(read.mesh.points.size() == 4);
    CHECK(test::contains(read.said.all(), "x/y.model is read"));
    CHECK(test::contains(read.said.all(), "builds no object; all its objects are read"));
}

TEST_CASE("3MF: every fault is an error that names it", "[io][error]") {
    const auto built = [](const std::string& resources) {
        return refusal(test::threemf(resources, kItem)).message;
    };
    const auto vertex = [](const std::string& attributes) {
        return "<object id=\"1\"><mesh><vertices><vertex " + attributes + "/></vertices></mesh></object>";
    };
    const auto triangle = [](const std::string& attributes) {
        return "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" "
               "z=\"0\"/></vertices><triangles><triangle " +
               attributes + "/></triangles></mesh></object>";
    };
    CHECK(test::contains(refusal("solid").message, "a.3mf: is no ZIP archive"));
    CHECK(test::contains(refusal(test::package({{"a.txt", "x"}})).message, "holds no 3D model"));
    CHECK(test::contains(refusal(test::package({{"a.model", "<model><resources>"}})).message,
                         "truncated or corrupt"));
    CHECK(test::contains(refusal(test::package({{"a.model", "<html/>"}})).message, "is no 3D model"));
    CHECK(test::contains(built(""), "object 1 of 3d/3dmodel.model, which does not exist"));
    CHECK(test::contains(built(vertex("x=\"0\" y=\"0\"")), "lacks a coordinate"));
    CHECK(test::contains(built(vertex("x=\"0\" y=\"0\" z=\"nan\"")), "no finite number: nan"));
    CHECK(test::contains(built(triangle("v1=\"0\" v2=\"0\"")), "lacks a corner"));
    CHECK(test::contains(built(triangle("v1=\"0\" v2=\"0\" v3=\"4000000\"")), "uses vertex 4000000 of 1"));
    CHECK(test::contains(built(triangle("v1=\"0\" v2=\"0\" v3=\"-1\"")), "no whole number: -1"));
    CHECK(
        test::contains(built(test::tetrahedron("1") + test::tetrahedron("1")), "two objects have the id 1"));
    CHECK(test::contains(built("<object/>"), "an object has no id"));
    CHECK(test::contains(built(R"(<m:colorgroup id="x"/>)"), "is no whole number"));
    CHECK(test::contains(built(R"(<m:colorgroup id="2"/><m:colorgroup id="2"/>)"), "one id"));
    CHECK(
        test::contains(refusal(test::threemf(test::tetrahedron("1"), "<item/>")).message, "names no object"));
    for (const char* bad : {"1 2 3", "1 0 0 0 1 0 0 0 1 0 0 inf", "1 0 0 0 1 0 0 0 1 0 0 0 9"})
        CHECK(test::contains(
            refusal(test::threemf(test::tetrahedron("1"),
                                  "<item objectid=\"1\" transform=\"" + std::string(bad) + "\"/>"))
                .message,
            "not twelve finite numbers"));
    CHECK(test::contains(
        refusal(test::threemf(test::tetrahedron("1"), kItem, {}, R"(requiredextensions="p b")")).message,
        "beamlattice/2017/02, which is not read"));
    CHECK(refusal(test::threemf(R"(<object id="1"><mesh/></object>)", kItem)).code ==
          int(ErrorCode::EmptyInput));
}

TEST_CASE("3MF: components that explode, nest without end or hold themselves are refused", "[io][error]") {
    const auto component = [](int id) { return "<component objectid=\"" + std::to_string(id) + "\"/>"; };
    CHECK(test::contains(
        refusal(
            test::threemf("<object id=\"1\"><components>" + component(1) + "</components></object>", kItem))
            .message,
        "object 1 is a component of itself"));
    std::string bomb = test::tetrahedron("1"), chain = bomb;
    for (int id = 2; id < 40; ++id)
        bomb += "<object id=\"" + std::to_string(id) + "\"><components>" + component(id - 1) +
                component(id - 1) + "</components></object>";
    for (int id = 2; id < 150; ++id)
        chain += "<object id=\"" + std::to_string(id) + "\"><components>" + component(id - 1) +
                 "</components></object>";
    CHECK(test::contains(refusal(test::threemf(bomb, R"(<item objectid="39"/>)")).message,
                         "over four billion"));
    CHECK(
        test::contains(refusal(test::threemf(chain, R"(<item objectid="149"/>)")).message, "over 100 deep"));
    RunContext ctx;
    ctx.maxMemory = 10000000;
    CHECK(refusal(test::threemf(bomb, R"(<item objectid="20"/>)"), ctx).code == int(ErrorCode::Memory));
    CHECK(refusal(test::threemf(test::tetrahedron("1") + std::string(3000000, ' '), kItem), ctx).code ==
          int(ErrorCode::Memory));
}

TEST_CASE("3MF: a cancelled reading gives nothing", "[io][cancel]") {
    const std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(refusal(test::threemf(test::tetrahedron("1"), kItem), ctx).code == int(ErrorCode::Cancelled));
}
