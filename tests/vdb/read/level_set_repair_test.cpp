#include "libvdbsynth/vdb/read/level_set_repair.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/vdb/read/fields.h"

using namespace vdbsynth;
using test::ballField;
using test::Band;
using test::bandGrid;
using test::boxField;
using test::denseGrid;

namespace {

constexpr double kVoxel = 0.1;
const double kBall = 4.0 / 3 * 3.14159265358979 * 1000;  // [voxels] of radius 10

struct Read {
    LevelSet model;
    std::string said;
    double volume() const { return solidVoxels(*model.grid); }
};

Read read(const openvdb::FloatGrid::Ptr& grid, const VdbReadOptions& options = {}) {
    Read result;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { result.said += text + "\n"; };
    result.model = modelFromGrids("a.vdb", {grid}, options, ctx);
    return result;
}

// The model is a sound narrow band of this volume, and something was said of what was wrong.
void becomes(const openvdb::FloatGrid::Ptr& grid, double volume, const std::string& says,
             double tolerance = 0.03) {
    const Read result = read(grid);
    INFO(result.said);
    CHECK(result.volume() == Approx(volume).epsilon(tolerance));
    CHECK(test::contains(result.said, says));
    CHECK(halfWidthOf(*result.model.grid) >= 1.4999);
    CHECK(measureBand(*result.model.grid).gradientErrorMean < 0.1);
    // What was repaired is sound: read again, it stays as it is.
    const Read again = read(result.model.grid);
    CHECK(again.said.empty());
    CHECK(levelSetHash(*again.model.grid) == levelSetHash(*result.model.grid));
}

}  // namespace

TEST_CASE("repairedField: a sound level set stays the same tree, whatever its band", "[vdb][property]") {
    for (const double width : {1.5, 2.0, 3.0, 8.0, 50.0}) {
        Band band;
        band.outside = band.inside = band.background = width;
        band.interior = -width;
        const auto grid = bandGrid(ballField(10), 14 + int(width), kVoxel, band);
        const RepairedField sound = repairedField(grid);
        CHECK(sound.field == grid);
        CHECK(sound.said.empty());
        CHECK_FALSE(sound.measureAnew);
    }
}

TEST_CASE("repairedField: a level set with its signs turned, in four dialects", "[vdb][property]") {
    Band band;
    band.sign = -1;
    band.background = -3;
    band.interior = 3;
    becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "signs are turned");
    band.background = 3;  // only the active values were turned
    band.interior = -3;
    becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "signs are turned");
    band.interior = 3;
    becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "signs are turned");
    band.background = 0;
    band.interior = 0;
    becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "signs are turned");
}

TEST_CASE("repairedField: constant regions whose signs contradict the voxels beside them",
          "[vdb][property]") {
    // Values of voxels and the background were turned, those of larger regions were not.
    Band band;
    band.sign = -1;
    band.background = -3;
    band.interior = 3;
    const auto grid = bandGrid(ballField(10), 15, kVoxel, band);
    auto tile = grid->tree().beginValueOff();
    tile.setMaxDepth(openvdb::FloatTree::ValueOffIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(-*tile);
    becomes(grid, kBall, "signs are turned");
    // The inside of leaves is marked, larger regions amid it are not.
    const auto large = bandGrid(ballField(30), 36, kVoxel);
    large->tree().prune();
    auto inner = large->tree().beginValueOff();
    inner.setMaxDepth(openvdb::FloatTree::ValueOffIter::LEAF_DEPTH - 1);
    for (; inner; ++inner) inner.setValue(float(3 * kVoxel));
    becomes(large, kBall * 27, "filled from the signs");
}

TEST_CASE("repairedField: an inside that is marked outside is filled", "[vdb][property]") {
    for (const double width : {1.0, 2.0, 3.0}) {
        Band band;
        band.outside = band.inside = band.background = band.interior = width;
        becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "filled from the signs");
    }
    // A cavity stays one.
    Band band;
    band.interior = 3;
    const auto hollow = [](const openvdb::Vec3d& p) { return std::max(p.length() - 20, 9 - p.length()); };
    becomes(bandGrid(hollow, 25, kVoxel, band), kBall * 8 - kBall * 0.729, "filled from the signs");
}

TEST_CASE("repairedField: backgrounds that are no distance", "[vdb][property]") {
    for (const double background : {0.0, -3.0, 1e-4, 40.0, 1e11}) {
        Band band;
        band.background = background;
        INFO(background);
        becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "grid \"field\"");
    }
}

TEST_CASE("repairedField: narrow bands and bands of two widths", "[vdb][property]") {
    for (const double width : {0.6, 0.9, 1.2}) {
        Band band;
        band.outside = band.inside = band.background = width;
        band.interior = -width;
        becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "under 1.5");
    }
    Band band;
    band.inside = 6;
    band.interior = -6;
    becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "go on beyond");
    band.inside = 100;
    becomes(bandGrid(ballField(10), 15, kVoxel, band), kBall, "go on beyond");
    band = {};
    band.outside = band.background = 8;
    becomes(bandGrid(ballField(10), 20, kVoxel, band), kBall, "end earlier");
}

TEST_CASE("repairedField: dense fields of no class, with any background, turned or clamped",
          "[vdb][property]") {
    const double box = 20 * 12 * 8;
    for (const float background : {0.f, 1.f, -1.f, 1e10f}) {
        INFO(background);
        becomes(denseGrid(boxField({10, 6, 4}), 20, kVoxel, background), box, "has no class", 0.25);
        const auto turned =
            denseGrid([](const openvdb::Vec3d& p) { return -ballField(10)(p); }, 20, kVoxel, background);
        becomes(turned, kBall, "signs are turned");
    }
    for (const double limit : {1.0, 2.0, 3.0, 5.0})
        becomes(denseGrid(
                    [limit](const openvdb::Vec3d& p) {
                        return std::max(-limit, std::min(limit, ballField(10)(p)));
                    },
                    20, kVoxel, 0),
                kBall, "has no class");
    const auto inVoxels =
        denseGrid([](const openvdb::Vec3d& p) { return (p.length() - 10) / kVoxel; }, 20, kVoxel, 0);
    becomes(inVoxels, kBall, "in voxels");
}

TEST_CASE("repairedField: voxels on the surface that a background of 0 leaves inactive", "[vdb][property]") {
    const auto grid = denseGrid(boxField({6, 5, 4}), 9, 1, 0);
    for (auto it = grid->beginValueOn(); it; ++it)
        if (*it == 0) it.setValueOff();
    const Read result = read(grid);
    CHECK_FALSE(test::contains(result.said, "cut open"));
    CHECK_FALSE(test::contains(result.said, "gaps"));
    CHECK(result.volume() == 11 * 9 * 7);
}

TEST_CASE("repairedField: clamped distances of any scale", "[vdb][property]") {
    const auto grid = denseGrid(
        [](const openvdb::Vec3d& p) { return std::max(-10.0, std::min(10.0, 2.5 * ballField(10)(p))); }, 20,
        kVoxel, 0);
    becomes(grid, kBall, "are no distances");
}

TEST_CASE("repairedField: `iso` moves the surface of a field of distances", "[vdb][property]") {
    const auto grid = denseGrid(ballField(10), 20, kVoxel, 0);
    VdbReadOptions options;
    options.iso = 0;
    CHECK(read(grid, options).volume() == Approx(kBall).epsilon(0.03));
    options.iso = 2 * kVoxel;
    const Read moved = read(grid, options);
    CHECK(moved.volume() == Approx(kBall * 1.728).epsilon(0.03));
    CHECK(test::contains(moved.said, "`iso`"));
    CHECK(test::contains(read(bandGrid(ballField(10), 15, kVoxel), options).said, "`iso` is ignored"));
}

TEST_CASE("repairedField: a solid cut open is closed flat where it was cut", "[vdb][property]") {
    const auto grid = bandGrid(ballField(10), 15, kVoxel);
    const auto clipped = [&](const openvdb::CoordBBox& box) {
        const auto copy = grid->deepCopy();
        copy->clip(box);
        return copy;
    };
    // Half a voxel beyond the last layer.
    const double halfBall = kBall / 2 + 3.14159 * (100 * 0.5 - 0.125 / 3);
    becomes(clipped({{-30, -30, -30}, {30, 30, 0}}), halfBall, "cut open at high z");
    becomes(clipped({{0, -30, -30}, {30, 30, 30}}), halfBall, "cut open at low x");
    const Read octant = read(clipped({{0, 0, 0}, {30, 30, 30}}));
    CHECK(test::contains(octant.said, "low x, low y, low z"));
    double voxels = 0;
    for (auto it = openvdb::CoordBBox({0, 0, 0}, {10, 10, 10}).begin(); it; ++it)
        voxels += grid->tree().getValue(*it) < 0 ? 1 : 0;
    CHECK(octant.volume() == voxels);
    // Only its active voxels were copied, so that its inside is lost too.
    Band lost;
    lost.interior = 3;
    const auto open = bandGrid(ballField(10), 15, kVoxel, lost);
    open->clip({{-30, -30, -30}, {30, 30, 0}});
    becomes(open, halfBall, "cut open at high z");
    // One face within the solid, away from its band.
    becomes(clipped({{-3, -3, 0}, {3, 3, 30}}), 7 * 7 * 9.9, "low z", 0.05);
    // A dense box that ends amid the solid.
    becomes(denseGrid(boxField({30, 5, 5}), 8, kVoxel, 0), 17 * 9 * 9, "low x, high x", 0.05);
}

TEST_CASE("repairedField: cubic solids of pores keep their sense where the box cuts them",
          "[vdb][property]") {
    const auto pores = [](const openvdb::Vec3d& p) {
        openvdb::Vec3d q;
        for (int i = 0; i < 3; ++i) q[i] = p[i] - 10 * std::round(p[i] / 10);
        return 4 - q.length();
    };
    const Read result = read(denseGrid(pores, 12, kVoxel, 0));
    CHECK(result.volume() > 0.6 * 25 * 25 * 25);
    CHECK(test::contains(result.said, "cut open at low x, high x, low y, high y, low z, high z"));
}

TEST_CASE("repairedField: values of another scale keep their zero level", "[vdb][property]") {
    becomes(bandGrid([](const openvdb::Vec3d& p) { return ballField(10)(p); }, 15, kVoxel), kBall, "");
    const auto scaled = bandGrid(ballField(10), 15, kVoxel);
    for (auto it = scaled->beginValueAll(); it; ++it) it.setValue(*it * 100);
    scaled->tree().root().setBackground(30.f, false);
    becomes(scaled, kBall, "are no distances");
}

TEST_CASE("repairedField: anisotropic, sheared and mirrored fields are repaired before they are resampled",
          "[vdb][property]") {
    const auto grid = denseGrid(
        [](const openvdb::Vec3d& p) { return (openvdb::Vec3d(p[0], p[1], 2 * p[2]).length() - 10); }, 16, 1,
        0);
    grid->transform().postScale({1, 1, 2});
    const Read flat = read(grid);
    CHECK(flat.volume() == Approx(kBall).epsilon(0.05));
    const auto mirrored = denseGrid(ballField(10), 16, kVoxel, 0);
    mirrored->transform().postScale({-1, 1, 1});
    becomes(mirrored, kBall, "has no class");
}

TEST_CASE("repairedField: the same bits for any number of threads", "[vdb][determinism]") {
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    Band band;
    band.background = 0;
    for (const auto& grid :
         {denseGrid(boxField({10, 6, 4}), 20, kVoxel, 1.f), bandGrid(ballField(10), 15, kVoxel, band)})
        CHECK(levelSetHash(*modelFromGrids("a", {grid}, {}, one).grid) ==
              levelSetHash(*modelFromGrids("a", {grid}, {}, four).grid));
}

TEST_CASE("repairedField: fields without an inside or without voxels", "[vdb][degenerate]") {
    const auto said = [](const openvdb::FloatGrid::Ptr& grid) {
        return test::thrownBy([&] { modelFromGrids("a.vdb", {grid}); });
    };
    Band band;
    band.outside = band.inside = band.background = 3;
    const auto outside = bandGrid([](const openvdb::Vec3d& p) { return p.length() + 1; }, 8, kVoxel, band);
    CHECK(said(outside).code == int(ErrorCode::EmptyInput));
    // All inside, all active: it ends at its voxels.
    const auto full = openvdb::FloatGrid::create(0.3f);
    full->fill(openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}), -0.3f, true);
    full->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel));
    full->setGridClass(openvdb::GRID_LEVEL_SET);
    CHECK(said(full).code == -1);
    // What no band touches has no sign of its own.
    const auto tile = openvdb::FloatGrid::create(3.f);
    tile->tree().addTile(2, {0, 0, 0}, -3.f, false);
    tile->tree().setValue({300, 0, 0}, 1.f);
    tile->setGridClass(openvdb::GRID_LEVEL_SET);
    CHECK(said(tile).code == int(ErrorCode::EmptyInput));
    RunContext small;
    small.maxMemory = 100000;
    const auto open = bandGrid(ballField(10), 15, kVoxel);
    open->clip({{-30, -30, -30}, {30, 30, 0}});
    CHECK(test::thrownBy([&] { modelFromGrids("a.vdb", {open}, {}, small); }).code == int(ErrorCode::Memory));
}
