#include "libvdbsynth/pipeline/texture/texture_outputs.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/level_sets.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture_makers.h"

using namespace vdbsynth;

namespace {

void write(const TextureShape& shape, const TextureSample& sample, const std::vector<std::string>& paths,
           const RunContext& ctx = {}) {
    OutputSet outputs;
    writeTextured(shape, test::flatResult(shape, sample), {sample}, paths, {}, outputs, ctx);
    outputs.commit();
}

const Attribute& attribute(const Attributes& attributes, const std::string& name) {
    const Attribute* found = findAttribute(attributes, name);
    INFO(name);
    REQUIRE(found);
    return *found;
}

}  // namespace

TEST_CASE("writeTextured: a .ply of a mesh has colours, normals, maps and coordinates", "[pipeline]") {
    const test::TemporaryFolder folder;
    const TextureShape shape = test::shapeOf(test::squareMesh(5));
    write(shape, test::rampSample(8, 8, 1), {folder.path("a.ply")});
    const Mesh mesh = readMesh(folder.path("a.ply"));
    CHECK(mesh.triangles.size() == shape.triangles.size());
    const Attribute &u = attribute(mesh.attributes, "source_u"), &v = attribute(mesh.attributes, "source_v"),
                    &colour = attribute(mesh.attributes, "Cd");
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        REQUIRE(u.values[i] == mesh.points[i].x);
        REQUIRE(v.values[i] == mesh.points[i].y);
    }
    CHECK(colour.values[3 * 12] == Approx(2.0 / 8).margin(0.01));
    CHECK(attribute(mesh.attributes, "map0").values[3] == Approx(0.25));
    CHECK(attribute(mesh.attributes, "source_exemplar").values[0] == 0);
    CHECK(attribute(mesh.attributes, "source_tangent").width == 3);
    CHECK(attribute(mesh.attributes, "uv").width == 2);  // the target's own stays
    CHECK(readPoints(folder.path("a.ply")).cloud.normals.size() == 25);
}

TEST_CASE("writeTextured: points as .ply and as OpenVDB points", "[pipeline]") {
    const test::TemporaryFolder folder;
    TextureShape shape = test::shapeOf(test::squareMesh(5));
    shape.kind = TargetKind::Points;
    shape.triangles.clear();
    write(shape, test::rampSample(8, 8), {folder.path("a.ply"), folder.path("a.vdb")});
    CHECK(holdsPoints(folder.path("a.ply")));
    const auto grids = readVdbGrids(folder.path("a.vdb"));
    REQUIRE(grids.size() == 1);
    CHECK(nameOf(*grids[0]) == "points");
    const test::Thrown thrown =
        test::thrownBy([&] { write(shape, test::rampSample(8, 8), {folder.path("a.glb")}); });
    CHECK(thrown.code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown.message, "`as` mesh"));
}

TEST_CASE("writeTextured: .glb has the picture's coordinates, the target's own are replaced aloud",
          "[pipeline]") {
    const test::TemporaryFolder folder;
    const TextureShape shape = test::shapeOf(test::squareMesh(5));
    test::Said said;
    write(shape, test::rampSample(8, 16, 1),
          {folder.path("a.glb"), folder.path("a.obj"), folder.path("a.off")}, said.ctx);
    CHECK(said.noted("replaced by those of the sample"));
    CHECK(said.noted("map0"));
    const Mesh mesh = readMesh(folder.path("a.glb"));
    const Attribute& uv = attribute(mesh.attributes, "uv");
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        REQUIRE(double(uv.values[2 * i]) == Approx(double(mesh.points[i].x) / 8));
        REQUIRE(double(uv.values[2 * i + 1]) == Approx(double(mesh.points[i].y) / 16));
    }
    CHECK(attribute(readMesh(folder.path("a.obj")).attributes, "uv").values.size() == 50);
    CHECK(attribute(readMesh(folder.path("a.off")).attributes, "Cd").width == 3);
}

TEST_CASE("writeTextured: a level set gets Cd in its band, read at the nearest site", "[pipeline]") {
    const test::TemporaryFolder folder;
    const FloatGridPtr ball = test::ball();
    ball->setName("surface");
    writeVdb(folder.path("in.vdb"), {ball}, {});
    const TextureShape shape = loadTarget(folder.path("in.vdb"), {}, {});
    TextureSample sample = test::rampSample(8, 8);
    std::fill(sample.image.values.begin(), sample.image.values.end(), 0.25f);
    write(shape, sample, {folder.path("out.vdb")});
    const auto surface = readVdbFloatGrid(folder.path("out.vdb"), "surface");
    CHECK(levelSetHash(*surface) == levelSetHash(*ball));
    const auto colour = openvdb::gridPtrCast<openvdb::Vec3SGrid>(readVdbGrid(folder.path("out.vdb"), "Cd"));
    REQUIRE(colour);
    CHECK(colour->activeVoxelCount() == surface->activeVoxelCount());
    for (auto voxel = colour->cbeginValueOn(); voxel; ++voxel) REQUIRE((*voxel)[1] == Approx(0.25));
    CHECK_NOTHROW(readVdbGrid(folder.path("out.vdb"), "source_u"));
}

TEST_CASE("elementNormals: of a displaced mesh they are its faces'", "[pipeline]") {
    TextureShape shape = test::shapeOf(test::squareMesh(3));
    CHECK(elementNormals(shape)[4].z == 1);
    shape.moved = shape.site;
    for (Vec3f& p : shape.moved) p.z = p.x;
    CHECK(elementNormals(shape)[4].x == Approx(-0.7071).margin(1e-3));
}

TEST_CASE("requireOutputs: what cannot be written is refused before the work", "[pipeline][error]") {
    const TextureShape shape = test::shapeOf(test::sphereMesh(1, 1));
    TextureOutputOptions options;
    const auto code = [&](const std::string& path) {
        return test::thrownBy([&] { requireOutputs(shape, {path}, options); }).code;
    };
    CHECK(code("a.stl") == int(ErrorCode::InvalidOption));
    CHECK(code("a.doc") == int(ErrorCode::InvalidOption));
    CHECK(code("a.png") == int(ErrorCode::InvalidOption));
    CHECK(code("a.glb") == -1);
    options.bake = true;
    CHECK(code("a.glb") == int(ErrorCode::InvalidOption));
    CHECK(code("a.png") == int(ErrorCode::Unusable));  // a sphere without texture coordinates
    options.bakeSize = 5;
    CHECK(test::contains(test::thrownBy([&] { validate(options); }).message, "`bakeSize`"));
    options = {};
    options.bakeBits = 12;
    CHECK(test::contains(test::thrownBy([&] { validate(options); }).message, "`bakeBits`"));
}
