#include "libvdbsynth/pipeline/relief/relief_outputs.h"

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/level_sets.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// A wave along the first axis of a plane, 2 units high, over a domain of 64 x 48 x 32 voxels of a half.
LevelSet wave(int axis) {
    openvdb::initialize();
    Index3 size;
    size[axis] = 32;
    size[(axis + 1) % 3] = 64;
    size[(axis + 2) % 3] = 48;
    const BrickField field = test::fieldFrom(size, [=](const Index3& p) {
        const double h = 2 * sine(2 * kPi * p[(axis + 1) % 3] / 16);
        return float(std::clamp((p[axis] - 16 - h) / 1.2, -3.0, 3.0));
    });
    LevelSet model;
    model.grid = scatterBricks(closeField(field, field.box(), kAllCut, 3), {0, 0, 0}, 0.5f, 3.f);
    model.grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    model.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    model.domain = field.box();
    model.domainRecorded = true;
    return model;
}

ReliefExtractOptions withRadius(double radius, std::optional<double> strength = {}) {
    ReliefExtractOptions options;
    options.baseRadius = radius;
    options.strength = strength;
    return options;
}

}  // namespace

TEST_CASE("reliefImage: a wave over each plane, columns along its first axis", "[pipeline][oracle]") {
    const int axis = GENERATE(0, 1, 2);
    const ReliefImage image = reliefImage(extractRelief(wave(axis), withRadius(4)));
    REQUIRE(image.columns == 64);
    REQUIRE(image.rows == 48);
    for (int column = 16; column < 48; ++column)
        CHECK(double(image.heights[std::size_t(24 * 64 + column)]) ==
              Approx(0.5 * 2 * sine(2 * kPi * column / 16)).margin(0.06));
}

TEST_CASE("reliefImage: a ball is not flat", "[pipeline][error]") {
    LevelSet model;
    model.grid = test::ball();
    model.domain = solidBox(*model.grid, "the ball");
    const ReliefExtraction extraction = extractRelief(model, withRadius(1));
    const test::Thrown thrown = test::thrownBy([&] { reliefImage(extraction); });
    CHECK(thrown.code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown.message, "not flat"));
}

TEST_CASE("requireReliefPaths: what cannot be written is refused", "[pipeline][error]") {
    const auto refusal = [](const std::string& path, std::optional<double> strength) {
        return test::thrownBy([&] { requireReliefPaths({path}, withRadius(1, strength)); }).message;
    };
    CHECK(test::contains(refusal("a.txt", {}), "unknown extension"));
    CHECK(test::contains(refusal("a.obj", {}), "`strength`"));
    CHECK(refusal("a.obj", 1.0).empty());
    for (const char* path : {"a.vdb", "a.ply", "a.png", "a.exr"}) CHECK(refusal(path, {}).empty());
}

TEST_CASE("writeRelief: every kind of file can be read again", "[pipeline]") {
    const test::TemporaryFolder folder;
    test::Said said;
    const ReliefExtractOptions options = withRadius(4, 1.0);
    const ReliefExtraction extraction = extractRelief(wave(2), options);
    const std::string vdb = folder.path("r.vdb"), ply = folder.path("r.ply"), png = folder.path("r.png"),
                      exr = folder.path("r.exr"), obj = folder.path("r.obj");
    OutputSet outputs;
    writeRelief(extraction, {vdb, ply, png, exr, obj}, options, {}, outputs, said.ctx);
    outputs.commit();
    CHECK(readVdb(vdb).grids.size() >= 3);
    const Mesh mesh = readMesh(ply);
    const Attribute *relief = findAttribute(mesh.attributes, "relief"),
                    *vector = findAttribute(mesh.attributes, "relief_vector");
    REQUIRE(relief);
    REQUIRE(vector);
    CHECK(vector->width == 3);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec3f& p = mesh.points[i];
        if (p.x < 8 || p.x > 24 || p.y < 8 || p.y > 16) continue;
        if (std::abs(p.z - 8) > 1) continue;  // a cap
        REQUIRE(double(relief->values[i]) == Approx(sine(2 * kPi * double(p.x) / 8)).margin(0.08));
        REQUIRE(double(vector->values[3 * i + 2]) == Approx(double(relief->values[i])).margin(0.02));
    }
    CHECK(readRaster(exr).size == Index3{64, 48, 1});
    CHECK(readRaster(png).white == 65535);
    CHECK(said.noted("black is a height"));
    CHECK(readMesh(obj).faceCount() > 1000);
}
