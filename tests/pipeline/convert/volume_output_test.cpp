#include "libvdbsynth/pipeline/convert/volume_output.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/model_unit.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

constexpr float kRadius = 4.6f, kVoxel = 0.5f;
const openvdb::Vec3f kCentre(3.f, -2.f, 7.25f);

// A ball off the centre, its domain that of its solid.
LevelSet ball() {
    openvdb::initialize();
    LevelSet model;
    model.grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(kRadius, kCentre, kVoxel);
    model.domain = solidBox(*model.grid, "the ball");
    stampLevelSet(model);
    return model;
}

double distanceAt(const VolumeHead& head, int x, int y, int z) {
    const Vec3d p = transformed(head.toWorld, {double(x), double(y), double(z)});
    return length(p - Vec3d{double(kCentre[0]), double(kCentre[1]), double(kCentre[2])}) - double(kRadius);
}

double meanOf(const openvdb::FloatGrid& grid, int axis) {
    double sum = 0, count = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it, ++count) sum += grid.indexToWorld(it.getCoord())[axis];
    return sum / count;
}

}  // namespace

TEST_CASE("writeModelVolume: each kind of value at its place", "[pipeline][oracle]") {
    const test::TemporaryFolder folder;
    const LevelSet model = ball();
    for (const VolumeValues values : {VolumeValues::Inside, VolumeValues::Distance, VolumeValues::Density}) {
        const VolumeHead head = volumeHeadOf(model, values);
        writeModelVolume(model, "v.vti", folder.path("v.vti"), values);
        const Raster raster = readRaster(folder.path("v.vti"));
        REQUIRE(raster.size == head.size);
        CHECK(raster.origin.x == Approx(head.toWorld[12]));
        double most = 0;
        for (int z = 0; z < head.size.z; ++z)
            for (int y = 0; y < head.size.y; ++y)
                for (int x = 0; x < head.size.x; ++x) {
                    const double d = distanceAt(head, x, y, z);
                    const double right = values == VolumeValues::Inside     ? double(d < 0)
                                         : values == VolumeValues::Distance ? std::clamp(d, -1.5, 1.5)
                                                                            : std::clamp(0.5 - d, 0.0, 1.0);
                    most = std::max(most, std::abs(double(raster.at(x, y, z)) - right));
                }
        CAPTURE(int(values));
        CHECK(most < 1e-5);
    }
}

TEST_CASE("volumeBox: a recorded domain, else the solid with its band around it", "[pipeline][oracle]") {
    LevelSet model = ball();
    CHECK(volumeBox(model) == model.domain.expanded(3));
    model.domainRecorded = true;
    CHECK(volumeBox(model) == model.domain);
    LevelSet empty = model;
    empty.grid = openvdb::FloatGrid::create(1.f);
    empty.domainRecorded = false;
    CHECK(test::thrownBy([&] { volumeBox(empty); }).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("writeModelVolume: density comes back as the same surface from every format",
          "[pipeline][property]") {
    const test::TemporaryFolder folder;
    const LevelSet model = ball();
    for (const char* name : {"v.tif", "v.vti", "v.nii", "v.nii.gz"}) {
#ifndef VDBSYNTH_TESTS_TIFF
        if (std::string(name) == "v.tif") continue;
#endif
        writeModelVolume(model, name, folder.path(name), VolumeValues::Density);
        ModelOptions options;
        options.volume.threshold = 0.5;
        const LevelSet back = loadModel(folder.path(name), options);
        CAPTURE(name);
        CHECK(voxelSizeOf(*back.grid) == Approx(double(kVoxel)).epsilon(1e-6));
        double most = 0;
        for (auto it = back.grid->cbeginValueOn(); it; ++it) {
            if (std::abs(*it) > kVoxel) continue;
            const double right =
                (back.grid->indexToWorld(it.getCoord()) - openvdb::Vec3d(kCentre)).length() - double(kRadius);
            most = std::max(most, std::abs(double(*it) - right));
        }
        CHECK(most < 0.1 * double(kVoxel));
        for (int axis = 0; axis < 3; ++axis)
            CHECK(meanOf(*back.grid, axis) == Approx(double(kCentre[axis])).margin(0.01));
    }
}

TEST_CASE("writeModelVolume: the same bytes on any number of threads", "[pipeline][determinism]") {
    const test::TemporaryFolder folder;
    std::string contents[2];
    for (const int threads : {1, 4}) {
        RunContext ctx;
        ctx.threads = threads;
        writeModelVolume(ball(), "v.nii.gz", folder.path("v.nii.gz"), VolumeValues::Distance, ctx);
        contents[threads > 1] = test::contentOf(folder.path("v.nii.gz"));
    }
    CHECK(contents[0] == contents[1]);
}

TEST_CASE("writeModelVolume: units are kept or missed aloud, what lies outside the domain too",
          "[pipeline][errors]") {
    const test::TemporaryFolder folder;
    LevelSet model = ball();
    setUnit(*model.grid, "um");
    for (const char* name : {"v.nii", "v.tif"}) {
        test::Said said;
        writeModelVolume(model, name, folder.path(name), VolumeValues::Inside, said.ctx);
        CHECK(said.nothing());
#ifndef VDBSYNTH_TESTS_TIFF
        if (std::string(name) == "v.tif") continue;
#endif
        CHECK(readRaster(folder.path(name)).unit == "um");
        CHECK(unitOf(*loadModel(folder.path(name)).grid) == "um");
    }
    test::Said vti;
    writeModelVolume(model, "v.vti", folder.path("v.vti"), VolumeValues::Inside, vti.ctx);
    CHECK(vti.noted("v.vti: has no place for its unit (um)"));
    test::Said npy;
    writeModelVolume(model, "v.npy", folder.path("v.npy"), VolumeValues::Inside, npy.ctx);
    REQUIRE(npy.notes.size() == 1);
    CHECK(npy.noted(
        "[z][y][x] of 24 x 25 x 25 samples, `inside` (uint8, 1 in the solid); its first voxel lies at "
        "-3, -8, 1.5, voxels of 0.5 (world, in um)"));
    model.domain.max.x = 5;
    model.domainRecorded = true;
    test::Said cut;
    writeModelVolume(model, "v.nii", folder.path("v.nii"), VolumeValues::Inside, cut.ctx);
    CHECK(cut.noted("solid voxels outside the model's domain left out"));
    CHECK(test::thrownBy([&] { writeModelVolume(model, "v.vdb", "v", VolumeValues::Inside); }).code ==
          int(ErrorCode::InvalidOption));
}

TEST_CASE("writeModelVolume: turned voxels lie where they were, or a note says they do not",
          "[pipeline][property]") {
    const test::TemporaryFolder folder;
    LevelSet model = ball();
    model.grid->transform().postRotate(0.3, openvdb::math::Z_AXIS);
    const openvdb::Vec3d centre = model.grid->indexToWorld(openvdb::Vec3d(kCentre) / double(kVoxel));
    for (const char* name : {"v.nii", "v.vti"}) {
        test::Said said;
        writeModelVolume(model, name, folder.path(name), VolumeValues::Inside, said.ctx);
        CHECK(said.nothing());
        const LevelSet back = loadModel(folder.path(name));
        for (int axis = 0; axis < 3; ++axis)
            CHECK(meanOf(*back.grid, axis) == Approx(centre[axis]).margin(0.02));
    }
    for (const char* name : {"v.npy", "v.tif"}) {
        test::Said said;
        writeModelVolume(model, name, folder.path(name), VolumeValues::Inside, said.ctx);
        CHECK(said.noted("has no place for the rotation of its axes"));
    }
}
