// Maps, directions, guides and the place of the result.
#include "libvdbsynth/pipeline/synth/synth.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/made_models.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;
using test::made;
using test::sized;

namespace {

// A grid that is `inside` in a box and `outside` elsewhere.
GridPtr boxGrid(const IndexBox& box, float inside, float outside = 0) {
    auto grid = openvdb::FloatGrid::create(outside);
    grid->fill(
        {openvdb::Coord(box.min.x, box.min.y, box.min.z), openvdb::Coord(box.max.x, box.max.y, box.max.z)},
        inside);
    return grid;
}

// Through a file and back, bit for bit.
void checkRepeats(const SynthResult& result, const std::vector<const LevelSet*>& exemplars) {
    const test::TemporaryFolder folder;
    writeVdb(folder.path("m.vdb"), sourceMapGrids(result.map, *result.model.grid), {});
    const LevelSet again = repeatMap(readSourceMap(folder.path("m.vdb")), exemplars);
    CHECK(levelSetHash(*again.grid) == levelSetHash(*result.model.grid));
}

}  // namespace

TEST_CASE("synthesize: the result's corner goes to an origin", "[pipeline][property]") {
    const LevelSet exemplar = made("balls", 40, 0, 0.5);
    SynthOptions options = sized(1.5, 1, 1);
    const SynthResult plain = synthesize(exemplar, options);
    options.origin = Vec3d{10, -2.25, 3.1};
    const SynthResult moved = synthesize(exemplar, options);
    const openvdb::Vec3d corner = moved.model.grid->transform().indexToWorld(openvdb::Vec3d(
        moved.model.domain.min.x - 0.5, moved.model.domain.min.y - 0.5, moved.model.domain.min.z - 0.5));
    CHECK((corner - openvdb::Vec3d(10, -2.25, 3.1)).length() < 1e-9);
    CHECK(moved.model.domain == plain.model.domain);
    const openvdb::FloatGrid::ConstPtr back =
        moved.model.grid->copyReplacingTransform(plain.model.grid->transform().copy());
    CHECK(levelSetHash(*back) == levelSetHash(*plain.model.grid));
    checkRepeats(moved, {&exemplar});
    RepeatOptions again;
    again.origin = Vec3d{0, 0, 0};
    const LevelSet elsewhere = repeatMap(moved.map, {&exemplar}, again);
    CHECK(elsewhere.grid->transform().indexToWorld(openvdb::Vec3d(-0.5)).length() < 1e-9);
    // Controls are read where the result lies.
    const LevelSet fibres = made("fibres", 48);
    SynthOptions turned = sized(2, 2, 1);
    turned.rotationMap = boxGrid({{0, 0, 0}, {47, 95, 47}}, 1.5f);
    const std::string there = levelSetHash(*synthesize(fibres, turned).model.grid);
    turned.origin = Vec3d{499.5, -0.5, -0.5};
    turned.rotationMap = boxGrid({{500, 0, 0}, {547, 95, 47}}, 1.5f);
    const SynthResult far = synthesize(fibres, turned);
    const openvdb::FloatGrid::ConstPtr home =
        far.model.grid->copyReplacingTransform(fibres.grid->transform().copy());
    CHECK(levelSetHash(*home) == there);
}

TEST_CASE("synthesize: several exemplars by an exemplar map, with their attributes", "[pipeline][property]") {
    LevelSet balls = made("balls"), grid = made("grid", 44);
    for (LevelSet* exemplar : {&balls, &grid}) {
        auto mark = openvdb::FloatGrid::create(0.f);
        mark->setName("mark");
        for (auto it = exemplar->grid->cbeginValueOn(); it; ++it)
            mark->tree().setValueOn(it.getCoord(), exemplar == &balls ? 1.f : 2.f);
        exemplar->attributes = {mark};
    }
    SynthOptions options = sized(2, 1.5, 1);
    options.exemplarMap = boxGrid({{0, 0, 0}, {39, 59, 43}}, 1);
    const SynthResult result = synthesize({&balls, &grid}, options);
    CHECK(result.model.domain.size() == Index3{80, 60, 40});
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
    const auto exemplar = openvdb::gridPtrCast<openvdb::Int32Grid>(grids[1]);
    for (auto it = exemplar->cbeginValueOn(); it; ++it) {
        if (it.getCoord().x() < 30) REQUIRE(*it == 1);
        if (it.getCoord().x() > 50) REQUIRE(*it == 0);
    }
    REQUIRE(result.model.attributes.size() == 1);
    const auto mark = openvdb::gridPtrCast<openvdb::FloatGrid>(result.model.attributes[0]);
    CHECK(mark->activeVoxelCount() > exemplar->activeVoxelCount() * 9 / 10);
    for (auto it = mark->cbeginValueOn(); it; ++it)
        if (it.getCoord().x() < 30) REQUIRE(*it == 2.f);
    checkRepeats(result, {&balls, &grid});
    CHECK(test::thrownBy([&] { repeatMap(result.map, {&balls}); }).code == int(ErrorCode::ShapeMismatch));
    CHECK(test::thrownBy([&] { synthesize(balls, options); }).code == int(ErrorCode::InvalidOption));
    const LevelSet coarse = made("grid", 40, 16, 2);
    CHECK(test::thrownBy([&] {
              synthesize({&balls, &coarse}, options);
          }).code == int(ErrorCode::ShapeMismatch));
    options.method = SynthesisMethod::Paper;
    CHECK(test::thrownBy([&] {
              synthesize({&balls, &grid}, options);
          }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("synthesize: rotated and scaled by maps", "[pipeline][property]") {
    // Fibres run along x; a quarter turn about z makes them run along y.
    const LevelSet fibres = made("fibres", 48);
    const auto slope = [](const openvdb::FloatGrid& grid, int axis, const IndexBox& box) {
        double sum = 0;
        std::size_t count = 0;
        for (auto it = grid.cbeginValueOn(); it; ++it) {
            const openvdb::Coord c = it.getCoord();
            if (!box.contains(Index3{c.x(), c.y(), c.z()}) || std::abs(*it) > 1) continue;
            openvdb::Coord next = c, last = c;
            ++next[axis];
            --last[axis];
            sum += std::abs(grid.tree().getValue(next) - grid.tree().getValue(last)) / 2;
            ++count;
        }
        REQUIRE(count > 1000);
        return sum / double(count);
    };
    SynthOptions options = sized(2, 2, 1);
    options.rotationMap = boxGrid({{0, 0, 0}, {47, 95, 47}}, float(3.14159265358979 / 2));
    const SynthResult result = synthesize(fibres, options);
    const IndexBox turned{{4, 4, 4}, {36, 90, 43}}, plain{{60, 4, 4}, {90, 90, 43}};
    const openvdb::FloatGrid& grid = *result.model.grid;
    const double along = slope(*fibres.grid, 0, fibres.domain.expanded(-4)),
                 across = slope(*fibres.grid, 1, fibres.domain.expanded(-4));
    REQUIRE(along < 0.5 * across);
    CHECK(slope(grid, 0, plain) == Approx(along).margin(0.1));
    CHECK(slope(grid, 1, turned) == Approx(along).margin(0.1));
    CHECK(slope(grid, 0, turned) == Approx(across).margin(0.15));
    CHECK(measureBand(grid).gradientErrorMean < 0.06);
    checkRepeats(result, {&fibres});
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, grid);
    // A place between voxels, too.
    REQUIRE(grids.size() == 7);
    CHECK(grids[5]->getName() == "source_offset");
    CHECK(grids[6]->getName() == "source_rotation");
    const auto rotation = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[6]);
    CHECK(rotation->tree().getValue(rotation->beginValueOn().getCoord()).z() == Approx(1.5708));

    options.rotationMap.reset();
    options.scaleMap = boxGrid({{0, 0, 0}, {95, 95, 47}}, 1.5f, 1.5f);
    const SynthResult larger = synthesize(fibres, options);
    // Surface per volume goes with 1 / scale.
    const auto density = [](const LevelSet& model) {
        const IndexBox inner = model.domain.expanded(-4);
        double near = 0;
        for (auto it = model.grid->cbeginValueOn(); it; ++it)
            near += inner.contains(Index3{it.getCoord().x(), it.getCoord().y(), it.getCoord().z()}) &&
                    std::abs(*it) < 1;
        return near / double(inner.volume());
    };
    CHECK(density(larger.model) == Approx(density(fibres) / 1.5).epsilon(0.15));
    checkRepeats(larger, {&fibres});
    options.border = {Border::Object, Border::Object, Border::Object};
    CHECK(test::thrownBy([&] { synthesize(fibres, options); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("synthesize: the exemplar rotated along a field of directions", "[pipeline][property]") {
    // Fibres run along x; around the middle they run in circles.
    const LevelSet fibres = made("fibres", 48);
    SynthOptions options = sized(2, 2, 1);
    options.direction = DirectionSource{};
    options.direction->kind = DirectionSource::Kind::Around;
    test::Said said;
    const SynthResult result = synthesize(fibres, options, said.ctx);
    CHECK(said.noted("is taken to run along axis:x"));
    const openvdb::FloatGrid& grid = *result.model.grid;
    double along = 0, across = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        const openvdb::Coord c = it.getCoord();
        const double x = c.x() - 47.5, y = c.y() - 47.5, r = std::sqrt(x * x + y * y);
        if (r < 16 || r > 44 || c.z() < 4 || c.z() > 43 || std::abs(*it) > 1) continue;
        const auto& tree = grid.tree();
        const double dx =
            double(tree.getValue(c.offsetBy(1, 0, 0)) - tree.getValue(c.offsetBy(-1, 0, 0))) / 2;
        const double dy =
            double(tree.getValue(c.offsetBy(0, 1, 0)) - tree.getValue(c.offsetBy(0, -1, 0))) / 2;
        along += std::abs(dy * x - dx * y) / r;
        across += std::abs(dx * x + dy * y) / r;
    }
    CHECK(along < 0.5 * across);
    checkRepeats(result, {&fibres});
    // The exemplar's own direction: along y nothing rotates along y.
    options.direction->kind = options.exemplarDirection.emplace().kind = DirectionSource::Kind::Axis;
    options.direction->axis = options.exemplarDirection->axis = {0, 1, 0};
    const SynthResult plain = synthesize(fibres, options);
    REQUIRE(plain.map.variants.size() == 1);
    CHECK(plain.map.variants[0].plain());
    // It cannot vary, nor be alone, nor be given beside a map.
    options.exemplarDirection->kind = DirectionSource::Kind::Radial;
    CHECK(test::thrownBy([&] { synthesize(fibres, options); }).code == int(ErrorCode::InvalidOption));
    options.exemplarDirection->kind = DirectionSource::Kind::Axis;
    options.rotationMap = boxGrid({{0, 0, 0}, {95, 95, 47}}, 1);
    CHECK(test::thrownBy([&] { synthesize(fibres, options); }).code == int(ErrorCode::InvalidOption));
    options.rotationMap.reset();
    options.direction.reset();
    CHECK(test::thrownBy([&] { synthesize(fibres, options); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("synthesize: a guide places parts of the exemplar", "[pipeline][property]") {
    const LevelSet balls = made("balls"), grid = made("grid");
    SynthOptions both = sized(2, 1, 1);
    both.exemplarMap = boxGrid({{0, 0, 0}, {39, 39, 39}}, 1);
    const SynthResult mixed = synthesize({&balls, &grid}, both);
    SynthOptions options = sized(1.5, 2, 1);
    options.guide = boxGrid({{0, 0, 0}, {119, 39, 39}}, 1);
    options.exemplarGuides = {both.exemplarMap};
    const SynthResult result = synthesize(mixed.model, options);
    std::size_t right = 0, all = 0;
    for (std::size_t i = 0; i < result.map.patches.source.size(); ++i) {
        const int y = result.map.patches.originOf(result.map.patches.place(i)).y + 8,
                  x = result.map.patches.source[i].x + 8;
        if (std::abs(y - 40) < 12 || std::abs(x - 40) < 8) continue;
        ++all;
        right += (y < 40) == (x < 40) ? 1 : 0;
    }
    CHECK(all > 100);
    CHECK(double(right) > 0.9 * double(all));
    options.exemplarGuides.clear();
    CHECK(test::thrownBy([&] { synthesize(mixed.model, options); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("synthesize: controls give the same bits for any number of threads, and can be cancelled",
          "[pipeline][determinism][cancel]") {
    const LevelSet balls = made("balls"), grid = made("grid");
    SynthOptions options = sized(1.5, 2, 1);
    options.exemplarMap = boxGrid({{0, 0, 0}, {39, 79, 39}}, 1);
    options.rotationMap = boxGrid({{0, 0, 0}, {59, 30, 39}}, 0.5f);
    options.scaleMap = boxGrid({{0, 40, 0}, {59, 79, 39}}, 1.25f, 1);
    options.guide = boxGrid({{20, 0, 0}, {59, 79, 39}}, 1);
    options.exemplarGuides = {boxGrid({{0, 0, 0}, {19, 39, 39}}, 1), boxGrid({{0, 0, 0}, {39, 19, 39}}, 1)};
    const auto run = [&](int threads, std::atomic<bool>* cancel) {
        RunContext ctx;
        ctx.threads = threads;
        ctx.cancel = cancel;
        return levelSetHash(*synthesize({&balls, &grid}, options, ctx).model.grid);
    };
    CHECK(run(1, nullptr) == run(2, nullptr));
    std::atomic<bool> cancel{true};
    CHECK(test::thrownBy([&] { run(2, &cancel); }).code == int(ErrorCode::Cancelled));
}
