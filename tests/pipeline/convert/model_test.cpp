#include "libvdbsynth/pipeline/convert/model.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"

#include <functional>
#include <string>
#include <vector>

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
    for (const char* name : {"a.hdr", "a.IMG", "a.img.gz"})
        CHECK(test::contains(test::thrownBy([&] { requireModelPath(name); }).message, "one .nii"));
}

TEST_CASE("loadModel: a turned volume is a level set whose transform is turned, at any voxel size",
          "[pipeline][oracle]") {
    const test::TemporaryFolder folder;
    std::string voxels(24 * 24 * 24, '\0');
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        const double x = double(i % 24) - 12, y = double(i / 24 % 24) - 12, z = double(i / 576) - 12;
        voxels[i] = x * x + y * y + z * z < 64 ? 1 : 0;
    }
    // 36.9 degrees about z, slices backwards, voxels of 2.
    const std::string path = folder.write(
        "a.nii", test::nifti(24, 24, 24, voxels, {1.6f, -1.2f, 0, 10, 1.2f, 1.6f, 0, 20, 0, 0, -2, 30}));
    const Vec3d centre{10 + 1.6 * 12 - 1.2 * 12, 20 + 1.2 * 12 + 1.6 * 12, 30 - 24};
    for (const double voxelSize : {0.0, 1.3}) {
        ModelOptions options;
        options.voxelSize = voxelSize;
        const LevelSet model = loadModel(path, options);
        REQUIRE_NOTHROW(requireModel(&model, "the model"));
        const openvdb::Vec3d step = model.grid->indexToWorld(openvdb::Vec3d(1, 0, 0)) -
                                    model.grid->indexToWorld(openvdb::Vec3d(0, 0, 0));
        CHECK(step.y() / step.x() == Approx(0.75));
        CHECK(step.length() == Approx(voxelSize > 0 ? voxelSize : 2));
        openvdb::Vec3d sum(0, 0, 0);
        double count = 0;
        for (auto it = model.grid->cbeginValueOn(); it; ++it) {
            if (*it >= 0) continue;
            sum += model.grid->indexToWorld(it.getCoord());
            count += 1;
        }
        for (int axis = 0; axis < 3; ++axis) CHECK(sum[axis] / count == Approx(centre[axis]).margin(0.05));
    }
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

TEST_CASE("loadModel: parts of a volume that come apart are said, with what keeps them",
          "[pipeline][property]") {
    const test::TemporaryFolder folder;
    const auto said = [&](const std::function<bool(int, int, int)>& solid) {
        std::string voxels(16 * 16 * 16, '\0'), text;
        for (int i = 0; i < 4096; ++i) voxels[std::size_t(i)] = solid(i % 16, i / 16 % 16, i / 256) ? 1 : 0;
        RunContext ctx;
        ctx.onMessage = [&](MessageLevel level, const std::string& line) {
            if (level == MessageLevel::Warning) text += line;
        };
        const std::vector<float> place{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        loadModel(folder.write("v.nii", test::nifti(16, 16, 16, voxels, place)), {}, ctx);
        return text;
    };
    // A line along the space diagonal: one part by corners, twelve single samples.
    const std::string diagonal =
        said([](int x, int y, int z) { return x == y && y == z && x > 1 && x < 14; });
    CHECK(test::contains(diagonal, "its 1 part became 12 in the level set"));
    CHECK(test::contains(diagonal, "`threshold`"));
    // Along an axis it holds together, and so do two blocks apart with a void in one.
    CHECK_FALSE(test::contains(said([](int x, int y, int z) { return x == 8 && y == 8 && z > 1 && z < 14; }),
                               "became"));
    CHECK_FALSE(test::contains(said([](int x, int y, int z) {
                                   const bool inside = y > 1 && y < 14 && z > 1 && z < 14;
                                   const bool empty = x > 2 && x < 6 && y > 5 && y < 9 && z > 5 && z < 9;
                                   return inside && ((x > 0 && x < 8) || (x > 10 && x < 14)) && !empty;
                               }),
                               "became"));
}
