#include "libvdbsynth/pipeline/patch/patch_onto.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_sources.h"
#include "tests/support/said.h"

#include <openvdb/tools/LevelSetSphere.h>

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

LevelSet ballModel(double radius, const Vec3d& middle = {40, -20, 10}) {
    openvdb::initialize();
    LevelSet model;
    model.grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        float(radius), openvdb::Vec3f(float(middle.x), float(middle.y), float(middle.z)), 1.f, 3.f);
    model.domain = solidBox(*model.grid, "the ball");
    stampLevelSet(model);
    return model;
}

double volumeOf(const LevelSet& model) {
    const double voxel = voxelSizeOf(*model.grid);
    return solidVoxels(*model.grid) * voxel * voxel * voxel;
}

const Vec3d kMiddle{40, -20, 10};

}  // namespace

TEST_CASE("patchOnto: an egg-crate over a ball, its points with what they carry", "[pipeline][patch]") {
    PatchSource source = test::eggCrateSource();
    Attribute colour{"Cd", 1, {}};
    for (std::size_t p = 0; p < source.exemplar.points.size(); ++p) colour.values.push_back(float(p % 251));
    source.attributes = {colour};
    test::Said said;
    const PatchedModel patched = patchOnto(source, ballModel(30), {}, said.ctx);
    CHECK(said.nothing());
    const PointCloud cloud = ontoCloud(source, patched);
    const Attribute *number = findAttribute(cloud.attributes, "source"),
                    *patch = findAttribute(cloud.attributes, "patch"),
                    *carried = findAttribute(cloud.attributes, "Cd");
    REQUIRE(number);
    REQUIRE(patch);
    REQUIRE(carried);
    CHECK(double(cloud.points.size()) > 0.95 * 4 * kPi * 30 * 30);
    for (std::size_t p = 0; p < cloud.points.size(); ++p) {
        const Vec3d at = cast<double>(cloud.points[p]) + cloud.origin - kMiddle;
        REQUIRE(length(at) == Approx(30).margin(2.5));
        REQUIRE(double(dot(cloud.normals[p], cast<float>(at))) > 0);
        REQUIRE(carried->values[p] == float(std::size_t(number->values[p]) % 251));
    }
}

TEST_CASE("ontoLevelSet: closed where the exemplar goes all around, and united with the model on request",
          "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource();
    const LevelSet ball = ballModel(30);
    const PatchedModel patched = patchOnto(source, ball, {});
    const LevelSet made = ontoLevelSet(patched, 1, 3);
    requireModel(&made, "the result");
    CHECK(halfWidthOf(*made.grid) == Approx(3));
    CHECK(volumeOf(made) == Approx(4.0 / 3 * kPi * 30 * 30 * 30).epsilon(0.03));
    CHECK(made.grid->tree().getValue(openvdb::Coord(40, -20, 10)) < 0);
    CHECK(!made.domainRecorded);
    // Rings of an exemplar below the surface vanish in the model.
    PatchOntoOptions below;
    below.onto.heightOffset = -8;
    const PatchedModel inner = patchOnto(source, ball, below);
    const LevelSet both = ontoLevelSet(inner, 1, 3, &ball);
    CHECK(volumeOf(ontoLevelSet(inner, 1, 3)) < 0.6 * volumeOf(ball));
    CHECK(volumeOf(both) == Approx(volumeOf(ball)).epsilon(0.01));
}

TEST_CASE("patchOnto: a model bent more than the exemplar is high is said, with the scale that holds",
          "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource();
    PatchOntoOptions options;
    options.onto.heightOffset = -13;
    test::Said said;
    const PatchedModel patched = patchOnto(source, ballModel(14), options, said.ctx);
    CHECK(said.noted("`scale` of"));
    CHECK(patched.result.bend.dropped > 0);
    CHECK(patched.result.bend.folded > 0.5);
}

TEST_CASE("patchOnto: a direction along an axis is kept", "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource();
    PatchOntoOptions options;
    options.direction = DirectionSource{};
    options.direction->kind = DirectionSource::Kind::Around;
    options.direction->axis = {0, 0, 1};
    CHECK(patchOnto(source, ballModel(24), options).result.sheet.size() > 5000);
}

TEST_CASE("patchOnto: errors, threads and cancelling", "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource();
    const LevelSet ball = ballModel(20);
    PatchOntoOptions options;
    options.onto.scale = 0;
    CHECK(test::thrownBy([&] { patchOnto(source, ball, options); }).code == int(ErrorCode::InvalidOption));
    options = {};
    options.direction = DirectionSource{};
    options.direction->kind = DirectionSource::Kind::Grid;
    CHECK(test::thrownBy([&] { validate(options); }).code == int(ErrorCode::InvalidOption));
    options.direction->kind = DirectionSource::Kind::Strokes;
    CHECK(test::thrownBy([&] { validate(options); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] { patchOnto(source, LevelSet{}, {}); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] { ontoLevelSet({}, 1, 3); }).code == int(ErrorCode::EmptyInput));
    const PatchedModel patched = patchOnto(source, ball, {});
    CHECK(test::thrownBy([&] { ontoLevelSet(patched, 0, 3); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] { ontoLevelSet(patched, 1, 1); }).code == int(ErrorCode::InvalidOption));
    RunContext small;
    small.maxMemory = 1000;
    CHECK(test::thrownBy([&] { ontoLevelSet(patched, 1, 3, nullptr, small); }).code ==
          int(ErrorCode::Memory));
    const auto run = [&](const RunContext& ctx) {
        return ontoLevelSet(patchOnto(source, ball, {}, ctx), 1, 3, nullptr, ctx);
    };
    CHECK(levelSetHash(*run(test::onThreads(1)).grid) == levelSetHash(*run(test::onThreads(4)).grid));
    CHECK(test::thrownWhenCancelled(run).code == int(ErrorCode::Cancelled));
}
