#include "libvdbsynth/pipeline/convert/outputs.h"

#include <openvdb/tools/Interpolation.h>
#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/geometry/sliver_removal.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// A field of distances [voxels] as a model in voxels of a half, its domain the field's box.
LevelSet modelOf(const Index3& size, const std::function<double(const Vec3d&)>& distance, bool recorded) {
    openvdb::initialize();
    LevelSet model;
    const BrickField field = test::fieldFrom(size, [&](const Index3& p) {
        return float(std::clamp(distance({double(p.x), double(p.y), double(p.z)}), -3.0, 3.0));
    });
    model.grid = levelSetFrom(field, 3.f, 0.5, "test");
    model.domain = field.box();
    model.domainRecorded = recorded;
    stampLevelSet(model);
    return model;
}

LevelSet ball() {
    return modelOf(
        {24, 24, 24},
        [](const Vec3d& p) {
            return length(p - Vec3d{11.5, 11.5, 11.5}) - 8;
        },
        false);
}

// A slope from 4 to 8.4 voxels in height over 12 x 10 voxels; the field goes on to the sides.
LevelSet slope() {
    LevelSet model = modelOf(
        {20, 18, 16},
        [](const Vec3d& p) {
            return std::max({(p.z - 4 - 0.4 * (p.x - 4)) / std::sqrt(1.16), 1 - p.z, 1 - p.x, p.x - 18,
                             1 - p.y, p.y - 16});
        },
        true);
    model.domain = {{4, 4, 2}, {15, 13, 14}};
    return model;
}

void write(const LevelSet& model, const std::vector<std::string>& paths,
           const ModelOutputOptions& options = {}, const RunContext& ctx = {}) {
    OutputSet outputs;
    writeModel(model, paths, options, outputs, ctx);
    outputs.commit();
}

const std::vector<std::string> kAllNames{"o.vdb", "o.obj",  "o.ply", "o.stl", "o.off",
                                         "o.glb", "o.gltf", "o.3mf", "o.png", "o.exr",
                                         "o.npy", "o.tif",  "o.vti", "o.nii", "o.nii.gz"};

}  // namespace

TEST_CASE("writeModel: one run writes every kind, nothing before commit, twice the same bytes",
          "[pipeline][property][determinism]") {
    const LevelSet model = ball();
    ModelOutputOptions options;
    options.metadata = {{"vdbsynth:version", "1"}};
    std::vector<std::string> contents[2];
    for (int threads : {1, 4}) {
        const test::TemporaryFolder folder;
        std::vector<std::string> paths;
        for (const std::string& name : kAllNames) paths.push_back(folder.path(name));
        RunContext ctx;
        ctx.threads = threads;
        OutputSet outputs;
        writeModel(model, paths, options, outputs, ctx);
        for (const std::string& path : paths) CHECK(test::contentOf(path).empty());
        outputs.commit();
        for (const std::string& path : paths) {
            contents[threads > 1].push_back(test::contentOf(path));
            CHECK_FALSE(contents[threads > 1].back().empty());
        }
        const VdbContents vdb = readVdb(paths[0]);
        CHECK(vdb.metadata == options.metadata);
        CHECK(levelSetHash(*modelFromGrids("o", vdb.grids).grid) == levelSetHash(*model.grid));
        const MeshSummary first = summarize(readMesh(paths[1]));
        CHECK(first.closedManifold());
        CHECK(first.signedVolume == Approx(4.18879 * 64).epsilon(0.02));
        for (std::size_t i = 2; i < 8; ++i) CHECK(summarize(readMesh(paths[i])).faces >= first.faces);
    }
    for (std::size_t i = 0; i < kAllNames.size(); ++i) {
        INFO(kAllNames[i]);
        CHECK(contents[0][i] == contents[1][i]);
    }
}

TEST_CASE("writeModel: heights of the topmost surface over the domain, a pixel a voxel, without its caps",
          "[pipeline][oracle]") {
    const test::TemporaryFolder folder;
    std::vector<std::string> notes;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { notes.push_back(text); };
    ModelOutputOptions options;
    options.height = 5;
    write(slope(), {folder.path("h.exr"), folder.path("h.png")}, options, ctx);
    const Raster heights = readRaster(folder.path("h.exr")), grey = readRaster(folder.path("h.png"));
    REQUIRE((heights.size == Index3{12, 10, 1} && grey.size == heights.size));
    for (int x = 0; x < 12; ++x)
        for (int y = 0; y < 10; ++y) {
            const double height = 0.5 * (4 + 0.4 * x);  // world
            REQUIRE(heights.at(x, y, 0) == Approx(height).margin(0.02));
            REQUIRE(grey.at(x, y, 0) / 65535 == Approx(height / 5).margin(0.005));
        }
    CHECK(test::contains(notes.back(), "white one of 5"));
    options.height = 0;  // white is the highest point
    write(slope(), {folder.path("h.png")}, options);
    const Raster full = readRaster(folder.path("h.png"));
    CHECK(*std::max_element(full.values.begin(), full.values.end()) == 65535);
    options.plane = HeightPlane::ZX;
    write(ball(), {folder.path("b.exr")}, options, ctx);
    CHECK(test::contains(notes.back(), "pixels meet no surface"));
    const Raster side = readRaster(folder.path("b.exr"));
    CHECK(side.at(11, 11, 0) == Approx(0.5 * 19.5).margin(0.05));
    CHECK(std::isnan(side.at(0, 0, 0)));
}

TEST_CASE("writeModel: points with normals, grids beside the surface, attributes of vertices",
          "[pipeline][property]") {
    const test::TemporaryFolder folder;
    LevelSet model = ball();
    const auto heat = openvdb::FloatGrid::create(2.5f);
    heat->setName("heat");
    heat->setTransform(model.grid->transform().copy());
    model.attributes = {heat};
    ModelOutputOptions options;
    const auto extra = openvdb::Int32Grid::create(3);
    extra->setName("extra");
    options.extraGrids = {extra};
    options.points = true;
    options.spacing = 2;
    write(model, {folder.path("p.ply"), folder.path("m.obj"), folder.path("g.vdb")}, options);
    const PointFile points = readPoints(folder.path("p.ply"));
    CHECK(holdsPoints(folder.path("p.ply")));
    CHECK(points.cloud.points.size() > 100);
    CHECK(points.cloud.normals.size() == points.cloud.points.size());
    REQUIRE(findAttribute(points.cloud.attributes, "heat"));
    CHECK(findAttribute(points.cloud.attributes, "heat")->values.front() == 2.5f);
    std::vector<std::string> names;
    for (const GridPtr& grid : readVdbGrids(folder.path("g.vdb"))) names.push_back(nameOf(*grid));
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"extra", "heat", "surface"});
    options.points = false;
    write(model, {folder.path("m.ply")}, options);
    CHECK(findAttribute(readMesh(folder.path("m.ply")).attributes, "heat")->values.front() == 2.5f);
}

TEST_CASE("requireOutputPaths, writeModel: other extensions are refused before anything is written",
          "[pipeline][error]") {
    for (const std::string& name : kAllNames) CHECK_NOTHROW(requireOutputPaths({name, "FOLDER/A.VDB"}));
    const test::TemporaryFolder folder;
    for (const char* bad : {"a.doc", "a", "a.mesh", "a.obj.gz", "a.jpg"}) {
        const test::Thrown thrown = test::thrownBy([&] { requireOutputPaths({"a.vdb", bad}); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, std::string(bad) + ": unknown extension"));
        CHECK(test::thrownBy([&] {
                  write(ball(), {folder.path("a.vdb"), folder.path(bad)});
              }).message.size() > 0);
    }
    CHECK(folder.fileCount() == 0);
}

TEST_CASE("writeModel: options out of range, bad models, no folder, nothing to write", "[pipeline][error]") {
    const test::TemporaryFolder folder;
    const LevelSet model = ball();
    const auto refusal = [&](const std::function<void(ModelOutputOptions&)>& change, const char* field) {
        ModelOutputOptions options;
        change(options);
        const test::Thrown thrown = test::thrownBy([&] { write(model, {folder.path("a.vdb")}, options); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, field));
        CHECK(test::thrownBy([&] { validate(options); }).message == thrown.message);
    };
    refusal([](auto& o) { o.adaptivity = 1.5; }, "`adaptivity`");
    refusal([](auto& o) { o.spacing = 0.2; }, "`spacing`");
    refusal([](auto& o) { o.height = -1; }, "`height`");
    refusal([](auto& o) { o.extraGrids = {nullptr}; }, "`extraGrids`");
    refusal([](auto& o) { o.sharp = true, o.adaptivity = 0.5; }, "`sharp` and `adaptivity`");
    const auto code = [&](const LevelSet& bad, const std::string& path) {
        return test::thrownBy([&] { write(bad, {path}); }).code;
    };
    CHECK(code({}, folder.path("a.vdb")) == int(ErrorCode::InvalidOption));
    CHECK(code(model, folder.path("none/a.vdb")) == int(ErrorCode::Io));
    LevelSet flat = model;  // a band on one side of nothing
    flat.grid = openvdb::FloatGrid::create(1.5f);
    flat.grid->setTransform(model.grid->transform().copy());
    flat.grid->fill(openvdb::CoordBBox(0, 0, 0, 9, 9, 9), 1.f);
    for (const char* name : {"a.obj", "a.png", "a.exr"})
        CHECK(code(flat, folder.path(name)) == int(ErrorCode::EmptyInput));
    CHECK(folder.fileCount() == 0);
}

TEST_CASE("writeModel: what .3mf has no place for is a note", "[pipeline][error]") {
    const test::TemporaryFolder folder;
    LevelSet model = ball();
    const auto heat = openvdb::FloatGrid::create(2.5f);
    heat->setName("heat");
    heat->setTransform(model.grid->transform().copy());
    model.attributes = {heat};
    test::Said said;
    write(model, {folder.path("o.3mf")}, {}, said.ctx);
    CHECK(said.noted("o.3mf: .3mf has no place for heat"));
    CHECK(readMesh(folder.path("o.3mf")).attributes.empty());
}

namespace {

// The share [percent] of triangles with an angle under 5 degrees.
double sliverShare(const Mesh& mesh) {
    Mesh copy = mesh;
    return 100.0 * double(removeSlivers(copy, {}).before) / double(triangulated(mesh).size());
}

// [voxels] the farthest that a vertex is from the zero level, by the grid's trilinear value.
double farthestVertex(const LevelSet& model, const Mesh& mesh) {
    const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sampler(*model.grid);
    double farthest = 0;
    for (const Vec3f& p : mesh.points)
        farthest = std::max(farthest, std::abs(double(sampler.wsSample({p.x, p.y, p.z}))));
    return farthest / voxelSizeOf(*model.grid);
}

}  // namespace

TEST_CASE("writeModel: merged meshes of real models have hardly any slivers", "[pipeline][property]") {
    if (test::sample("").empty()) return;
    const test::TemporaryFolder folder;
    for (const char* name : {"bunny.off", "3holes.off", "fandisk.obj"})
        for (double adaptivity : {0.3, 1.0}) {
            INFO(name << " " << adaptivity);
            const LevelSet model = loadModel(test::sample(std::string("meshes/") + name), {});
            MeshingOptions meshing;
            meshing.adaptivity = adaptivity;
            const Mesh before = levelSetToMesh(*model.grid, meshing);
            ModelOutputOptions options;
            options.adaptivity = adaptivity;
            std::vector<std::string> details;
            RunContext ctx;
            ctx.onMessage = [&](MessageLevel level, const std::string& text) {
                if (level == MessageLevel::Detail) details.push_back(text);
            };
            write(model, {folder.path("m.ply")}, options, ctx);
            CHECK(std::any_of(details.begin(), details.end(), [](const std::string& text) {
                return test::contains(text, "slivers (an angle under 5 degrees)");
            }));
            const Mesh after = readMesh(folder.path("m.ply"));
            CHECK(sliverShare(before) > 0.1);
            CHECK(sliverShare(after) < 0.1);
            const MeshSummary was = summarize(before), is = summarize(after);
            CHECK(is.closedManifold());
            CHECK(is.signedVolume == Approx(was.signedVolume).epsilon(1e-3));
            // Euler number of a closed mesh of triangles.
            CHECK(2 * long(is.vertices) - long(is.faces) ==
                  2 * long(was.vertices) - long(triangulated(before).size()));
            CHECK(farthestVertex(model, after) < 0.1);
            CHECK(farthestVertex(model, after) <= farthestVertex(model, before));
        }
}

TEST_CASE("writeModel: attributes follow the vertices that stay", "[pipeline][property]") {
    const test::TemporaryFolder folder;
    LevelSet model = ball();
    const auto height = openvdb::FloatGrid::create(0.f);
    height->setName("height");
    height->setTransform(model.grid->transform().copy());
    for (auto at = model.grid->cbeginValueOn(); at; ++at)
        height->tree().setValue(at.getCoord(), float(height->indexToWorld(at.getCoord()).z()));
    model.attributes = {height};
    ModelOutputOptions options;
    options.adaptivity = 1;
    write(model, {folder.path("m.ply")}, options);
    const Mesh mesh = readMesh(folder.path("m.ply"));
    const Attribute* heights = findAttribute(mesh.attributes, "height");
    REQUIRE((heights && heights->values.size() == mesh.points.size()));
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        REQUIRE(heights->values[i] == Approx(mesh.points[i].z).margin(0.05));
}
