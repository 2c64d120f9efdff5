#include "libvdbsynth/pipeline/render/shown_model.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"

#include <cstdio>
#include <string>

using namespace vdbsynth;

namespace {

std::string written(const std::string& name, const std::vector<GridPtr>& grids) {
    const std::string path = "shown_model_test_" + name + ".vdb";
    writeVdb(path, grids, {});
    return path;
}

GridPtr fogNamed(const std::string& name, openvdb::GridClass kind) {
    const auto grid = openvdb::FloatGrid::create(0.f);
    for (int i = 0; i < 100; ++i) grid->tree().setValueOn({i, i % 7, i % 3}, 1 + float(i));
    grid->setName(name);
    grid->setGridClass(kind);
    return grid;
}

}  // namespace

TEST_CASE("readFog: a fog volume or a field of no class, but no level set", "[pipeline]") {
    openvdb::initialize();
    const FloatGridPtr ball = meshToLevelSet(test::sphereMesh(8, 4), 1, 3, "ball");
    ball->setName("surface");
    const auto colour = openvdb::Vec3SGrid::create();
    colour->setName("Cd");
    const std::string fog = written("fog", {fogNamed("density", openvdb::GRID_FOG_VOLUME),
                                            fogNamed("heat", openvdb::GRID_UNKNOWN), colour});
    const std::string both = written("both", {ball, fogNamed("density", openvdb::GRID_FOG_VOLUME)});
    const ShownFog first = readFog(fog, "");
    REQUIRE(first.density);
    CHECK(first.name == "density");
    CHECK(first.others.size() == 3);
    CHECK(readFog(fog, "heat").name == "heat");
    CHECK_FALSE(readFog(both, "").density);
    CHECK(readFog(both, "density").density);
    CHECK_FALSE(readFog("a.obj", "").density);
    CHECK(test::thrownBy([&] { readFog("none.vdb", ""); }).code == int(ErrorCode::Io));
    CHECK(test::thrownBy([&] { readFog(fog, "nothing"); }).code == int(ErrorCode::BadData));
    std::remove(fog.c_str());
    std::remove(both.c_str());
}

TEST_CASE("fogOf: the fog among grids in memory, with all of them", "[pipeline]") {
    openvdb::initialize();
    const auto colour = openvdb::Vec3SGrid::create();
    colour->setName("Cd");
    const std::vector<GridPtr> grids{colour, fogNamed("density", openvdb::GRID_FOG_VOLUME)};
    const ShownFog fog = fogOf("the model", grids, "");
    CHECK(fog.density == grids[1]);
    CHECK(fog.others == grids);
    const FloatGridPtr ball = meshToLevelSet(test::sphereMesh(8, 4), 1, 3, "ball");
    CHECK_FALSE(fogOf("the model", {ball}, "").density);
    const test::Thrown thrown = test::thrownBy([&] { fogOf("the model", {colour}, ""); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "the model"));
}

TEST_CASE("upOf, viewOf: the model's own, unless the options say", "[pipeline]") {
    ShownModel model;
    RenderOptions options;
    CHECK(upOf(model, options) == UpAxis::Z);
    CHECK(length(viewOf(model, options) - usualView(UpAxis::Z)) == 0);
    model.up = UpAxis::Y;
    CHECK(length(viewOf(model, options) - usualView(UpAxis::Y)) == 0);
    options.up = UpAxis::Z;
    CHECK(upOf(model, options) == UpAxis::Z);
    options.view = Vec3d{0, 0, 1};
    CHECK(length(viewOf(model, options) - Vec3d{0, 0, 1}) == 0);
}

TEST_CASE("shownColours: the usual name, a given one, none", "[pipeline]") {
    openvdb::initialize();
    const auto named = [](const char* name) {
        const auto grid = openvdb::Vec3SGrid::create();
        grid->setName(name);
        return grid;
    };
    const std::vector<GridPtr> grids{named("v"), named("Cd")};
    CHECK(shownColours(grids, "", "a.vdb") == grids[1]);
    CHECK(shownColours(grids, "v", "a.vdb") == grids[0]);
    CHECK_FALSE(shownColours(grids, "none", "a.vdb"));
    CHECK_FALSE(shownColours({}, "", "a.vdb"));
    const test::Thrown thrown = test::thrownBy([&] { shownColours(grids, "w", "a.vdb"); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "`color` w: not in a.vdb, which has v"));
}

TEST_CASE("customaryUp: y for files of modelling programs", "[pipeline]") {
    for (const char* path : {"a.obj", "a.OBJ.gz", "b.gltf", "b.glb"}) CHECK(customaryUp(path) == UpAxis::Y);
    for (const char* path : {"a.stl", "a.ply", "a.vdb", "a.off", "a.3mf", "a.png", "a.xyz"})
        CHECK(customaryUp(path) == UpAxis::Z);
}
