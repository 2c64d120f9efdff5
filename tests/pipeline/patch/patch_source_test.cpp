#include "libvdbsynth/pipeline/patch/patch_source.h"

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <catch2/catch.hpp>

#include <limits>

#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// A plane's points, a unit apart, that goes on `margin` beyond a box of `side`.
PointCloud plane(int side, int margin) {
    PointCloud cloud;
    for (int i = -margin; i < side + margin; ++i)
        for (int j = -margin; j < side + margin; ++j) {
            cloud.points.push_back({float(i) + 0.5f, float(j) + 0.5f, 2});
            cloud.normals.push_back({0, 0, 1});
        }
    return cloud;
}

const std::vector<std::string> kBox{"vdbsynth:domain 0,0,0,20,20,8", "vdbsynth:plane xy"};

}  // namespace

TEST_CASE("loadPatchSource: points with a recorded box keep it, their normals and attributes",
          "[pipeline][patch]") {
    openvdb::initialize();
    const test::TemporaryFolder folder;
    PointCloud cloud = plane(20, 8);
    Attribute number{"Cd", 3, {}};
    for (std::size_t p = 0; p < cloud.points.size(); ++p)
        for (int c = 0; c < 3; ++c) number.values.push_back(float(p % 7) / 7);
    cloud.attributes = {number};
    writePly(folder.path("plane.ply"), cloud, kBox);
    const PatchSource source = loadPatchSource(folder.path("plane.ply"), {});
    CHECK(source.recorded);
    CHECK(source.exemplar.size.x == Approx(20));
    CHECK(source.exemplar.size.z == Approx(8).margin(0.3));
    CHECK(source.exemplar.plane == PatchPlane::XY);
    CHECK(source.exemplar.spacing == Approx(1).margin(0.05));
    CHECK(source.exemplar.points.size() == cloud.points.size());
    CHECK(source.exemplar.kernel == 2);
    REQUIRE(findAttribute(source.attributes, "Cd"));
    CHECK(source.exemplar.toWorld(cast<double>(source.exemplar.points[5])).x ==
          Approx(double(cloud.points[5].x)));
}

TEST_CASE("loadPatchSource: what a file does not say is guessed and said", "[pipeline][patch]") {
    openvdb::initialize();
    const test::TemporaryFolder folder;
    PointCloud cloud = plane(40, 0);
    writePly(folder.path("bare.ply"), cloud, {});
    test::Said said;
    PatchSourceOptions options;
    options.margin = 5;
    const PatchSource source = loadPatchSource(folder.path("bare.ply"), options, said.ctx);
    CHECK_FALSE(source.recorded);
    CHECK(source.exemplar.size.x == Approx(39 - 10));
    CHECK(said.noted("does not say its box"));
    CHECK(said.noted("taken for a sheet"));
    cloud.normals.clear();
    writePly(folder.path("flat.ply"), cloud, kBox);
    loadPatchSource(folder.path("flat.ply"), {}, said.ctx);
    CHECK(said.noted("has no normals"));
}

TEST_CASE("loadPatchSource: a level set gives points between its caps", "[pipeline][patch]") {
    openvdb::initialize();
    const test::TemporaryFolder folder;
    MakeOptions make;
    make.exemplar.kind = "terrain";
    make.exemplar.resolution = 48;
    const LevelSet model = makeModel(make);
    model.grid->setName("surface");
    writeVdb(folder.path("terrain.vdb"), {model.grid}, {});
    const PatchSource source = loadPatchSource(folder.path("terrain.vdb"), {});
    CHECK(source.voxelSize == 1);
    std::size_t level = 0;
    for (const Vec3f& normal : source.exemplar.normals) level += std::abs(normal.z) < 0.1f ? 1 : 0;
    CHECK(double(level) < 0.02 * double(source.exemplar.normals.size()));
}

TEST_CASE("loadPatchSource: says what is wrong", "[pipeline][patch]") {
    openvdb::initialize();
    const test::TemporaryFolder folder;
    PointCloud cloud = plane(40, 0);
    writePly(folder.path("plane.ply"), cloud, {});
    const auto load = [&](const char* name, const PatchSourceOptions& options) {
        return test::thrownBy([&] { loadPatchSource(folder.path(name), options); });
    };
    PatchSourceOptions wide;
    wide.margin = 30;
    CHECK(test::contains(load("plane.ply", wide).message, "leaves nothing"));
    wide.margin = -1;
    CHECK(test::contains(load("plane.ply", wide).message, "`margin`"));
    cloud.points.resize(20);
    cloud.normals.resize(20);
    writePly(folder.path("few.ply"), cloud, {});
    CHECK(test::contains(load("few.ply", {}).message, "too few"));
    cloud.points.assign(100, {1, 1, 1});
    cloud.normals.assign(100, {0, 0, 1});
    writePly(folder.path("one.ply"), cloud, {});
    CHECK(test::contains(load("one.ply", {}).message, "coincide"));
    CHECK(load("nothing.ply", {}).code == int(ErrorCode::Io));
}
