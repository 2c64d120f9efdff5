#include "libvdbsynth/pipeline/relief/relief_bake.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <functional>

using namespace vdbsynth;

namespace {

// A square of 8 in the plane z = 0, u along x, v along y.
Mesh square() {
    Mesh mesh;
    mesh.points = {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.attributes.push_back({"uv", 2, {0, 0, 1, 0, 1, 1, 0, 1}});
    return mesh;
}

// A plane that rises along x: z = 1 + x / 8, solid below; voxels of a quarter.
LevelSet slope() {
    openvdb::initialize();
    LevelSet model;
    model.grid = openvdb::FloatGrid::create(0.75f);
    model.grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    model.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    auto write = model.grid->getAccessor();
    const double along = std::sqrt(1 + 1.0 / 64);
    for (int x = -40; x <= 40; ++x)
        for (int y = -40; y <= 40; ++y)
            for (int z = -40; z <= 40; ++z) {
                const double d = (z * 0.25 - 1 - x * 0.25 / 8) / along;
                const openvdb::Coord at(x, y, z);
                if (std::abs(d) < 0.75)
                    write.setValueOn(at, float(d));
                else
                    write.setValueOff(at, d < 0 ? -0.75f : 0.75f);
            }
    model.domain = solidBox(*model.grid, "test");
    return model;
}

Raster baked(const std::string& name, const ReliefBakeOptions& options) {
    const test::TemporaryFolder folder;
    OutputSet outputs;
    bakeRelief(square(), slope(), "test", folder.path(name), options, outputs);
    outputs.commit();
    return readRaster(folder.path(name));
}

ReliefBakeOptions wide() {
    ReliefBakeOptions options;
    options.size = 32;
    options.reach = 4;
    return options;
}

}  // namespace

TEST_CASE("bakedReliefOf: by the end of the name") {
    CHECK(bakedReliefOf("a/x.png") == BakedRelief::Displacement);
    CHECK(bakedReliefOf("a/x_normal.png") == BakedRelief::Normal);
    CHECK(bakedReliefOf("x_vector.<UDIM>.exr") == BakedRelief::Vector);
}

TEST_CASE("bakeRelief: displacement, vectors and normals of a slope") {
    const Raster heights = baked("x.exr", wide());
    REQUIRE(heights.size.x == 32);
    for (int x : {4, 16, 28}) {
        const double world = -4 + 8 * (x + 0.5) / 32;
        CHECK(double(heights.at(x, 16, 0)) == Approx(1 + world / 8).margin(0.03));
    }
    const Raster grey = baked("x.png", wide());
    CHECK(double(grey.at(16, 16, 0)) / grey.white == Approx(0.5 + 0.5 * 1.0156 / 4).margin(0.01));
    const Raster vectors = baked("x_vector.exr", wide());
    REQUIRE(vectors.channels == 3);
    const std::size_t middle = (16 * 32 + 16) * 3;
    CHECK(double(vectors.values[middle]) == Approx(0).margin(0.01));
    CHECK(double(vectors.values[middle + 2]) == Approx(1.0156).margin(0.03));
    const Raster normals = baked("x_normal.exr", wide());
    const double size = std::sqrt(1 + 1.0 / 64);
    CHECK(double(normals.values[middle]) == Approx(0.5 - 0.5 * 0.125 / size).margin(0.02));
    CHECK(double(normals.values[middle + 1]) == Approx(0.5).margin(0.02));
    CHECK(double(normals.values[middle + 2]) == Approx(0.5 + 0.5 / size).margin(0.02));
}

TEST_CASE("bakeRelief: every error") {
    for (const auto& change : std::vector<std::function<void(ReliefBakeOptions&)>>{
             [](auto& o) { o.size = 8; }, [](auto& o) { o.bits = 12; }, [](auto& o) { o.reach = 0; }}) {
        ReliefBakeOptions options = wide();
        change(options);
        CHECK_THROWS_AS(baked("x.exr", options), Error);
    }
    CHECK_THROWS_AS(baked("x_vector.png", wide()), Error);
    Mesh bare = square();
    bare.attributes.clear();
    OutputSet outputs;
    CHECK_THROWS_AS(bakeRelief(bare, slope(), "test", "x.exr", wide(), outputs), Error);
}
