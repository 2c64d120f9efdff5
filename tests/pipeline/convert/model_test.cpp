#include "libvdbsynth/pipeline/convert/model.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/io/mesh_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("loadModel: a mesh by resolution or voxel size, with the default said", "[pipeline][property]") {
    openvdb::initialize();
    const test::TemporaryFolder folder;
    writeMesh(folder.path("s.obj"), MeshFormat::Obj, test::sphereMesh(10, 3));
    std::string note;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Note) note = text;
    };
    ModelOptions options;
    CHECK(voxelSizeOf(*loadModel(folder.path("s.obj"), options, ctx).grid) == Approx(20.0 / 128));
    CHECK(test::contains(note, "128 voxels along the longest side"));
    options.resolution = 40;
    CHECK(voxelSizeOf(*loadModel(folder.path("s.obj"), options, ctx).grid) == Approx(0.5));
    options.voxelSize = 0.8;
    const LevelSet model = loadModel(folder.path("s.obj"), options, ctx);
    CHECK(voxelSizeOf(*model.grid) == 0.8);
    CHECK_FALSE(model.domainRecorded);
    CHECK(model.domain == IndexBox{{-12, -12, -12}, {12, 12, 12}});
}

TEST_CASE("requireModelPath: an unknown extension is refused", "[pipeline][error]") {
    const test::Thrown thrown = test::thrownBy([] { requireModelPath("a.doc"); });
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    CHECK(test::contains(thrown.message, "a.doc: unknown extension"));
}

TEST_CASE("withHalfWidth: another band, the same surface, its own band is left alone",
          "[pipeline][property]") {
    const test::TemporaryFolder folder;
    writeMesh(folder.path("s.obj"), MeshFormat::Obj, test::sphereMesh(10, 4));
    ModelOptions options;
    options.resolution = 40;
    const LevelSet model = loadModel(folder.path("s.obj"), options);
    CHECK(withHalfWidth(model, 3).grid == model.grid);
    const LevelSet wide = withHalfWidth(model, 6);
    CHECK(halfWidthOf(*wide.grid) == Approx(6));
    CHECK(solidVoxels(*wide.grid) == Approx(solidVoxels(*model.grid)).epsilon(0.005));
    CHECK(wide.grid->getConstAccessor().getValue({24, 0, 0}) == Approx(2).margin(0.05));
    CHECK(test::contains(test::thrownBy([&] { withHalfWidth(model, 1); }).message, "`halfWidth`"));
}
