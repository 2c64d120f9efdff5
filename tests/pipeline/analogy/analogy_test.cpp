#include "libvdbsynth/pipeline/analogy/analogy.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

using namespace vdbsynth;

namespace {

MakeOptions makeOptions(const std::string& kind, int resolution) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    return options;
}

ModelPair pairOf(const std::string& kind, int resolution = 64) {
    return makePair(makeOptions(kind, resolution));
}

LevelSet tori() {
    return makeModel(makeOptions("three-tori", 72));
}

DirectionSource direction(const std::string& text) {
    DirectionSource source;
    REQUIRE(parseDirection(text, source));
    return source;
}

AnalogyResult applied(const ModelPair& pair, const LevelSet& target, AnalogyOptions options = {},
                      const RunContext& ctx = {}) {
    if (options.direction.kind == DirectionSource::Kind::Automatic) options.direction = direction("around:z");
    return makeAnalogyModel({{&pair.plain, &pair.textured}}, target, options, ctx);
}

// A solid by its distances over a domain that it is cut at.
template <typename Distance>
LevelSet solidOf(const IndexBox& domain, bool recorded, Distance&& distance) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(3.f);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName("surface");
    auto to = grid->getAccessor();
    forEachVoxel(domain.expanded(recorded ? 3 : 0), [&](const Index3& p) {
        double d = distance(Vec3d{double(p.x), double(p.y), double(p.z)});
        if (recorded)
            for (int axis = 0; axis < 3; ++axis)
                d = std::max({d, domain.min[axis] - 0.5 - p[axis], p[axis] - domain.max[axis] - 0.5});
        const openvdb::Coord at(p.x, p.y, p.z);
        if (std::abs(d) < 3)
            to.setValueOn(at, float(d));
        else
            to.setValueOff(at, d < 0 ? -3.f : 3.f);
    });
    LevelSet model;
    model.grid = grid;
    model.domain = recorded ? domain : solidBox(*grid, "the test");
    model.domainRecorded = recorded;
    stampLevelSet(model);
    return model;
}

// Deviation of a result's surface from a ball around 0. [voxels]
double reliefOnBall(const openvdb::FloatGrid& grid, double radius) {
    double sum = 0, squares = 0, count = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        if (std::abs(*it) > 0.5f) continue;
        const double height = it.getCoord().asVec3d().length() - radius - double(*it);
        sum += height;
        squares += height * height;
        ++count;
    }
    return std::sqrt(squares / count - sum / count * (sum / count));
}

// A ball with a rod that is thinner than grooves are deep on both sides.
LevelSet ballWithRod() {
    return solidOf(IndexBox{{-30, -30, -30}, {30, 30, 70}}, false, [](const Vec3d& p) {
        const double across = std::sqrt(p.x * p.x + p.y * p.y);
        return std::min(length(p) - 24, std::max({across - 3.5, -p.z, p.z - 60}));
    });
}

// Solid voxels of the rod.
std::size_t rodVoxels(const openvdb::FloatGrid& grid) {
    std::size_t solid = 0;
    auto at = grid.getConstAccessor();
    forEachVoxel(IndexBox{{-8, -8, 34}, {8, 8, 62}},
                 [&](const Index3& p) { solid += at.getValue(openvdb::Coord(p.x, p.y, p.z)) < 0; });
    return solid;
}

}  // namespace

TEST_CASE("makeAnalogyModel: a shallow texture of a thin slab arrives on a ball at its strength",
          "[pipeline]") {
    // Five voxels of solid below the texture: less than the margin of neighbourhoods. The surface's depth
    // within a voxel is another at every place of a ball, and one and the same on a slab.
    const IndexBox slab{{0, 0, 0}, {79, 79, 14}};
    constexpr double kHeight = 1.2;
    const LevelSet plain = solidOf(slab, true, [](const Vec3d& p) { return p.z - 5.3; });
    const LevelSet textured = solidOf(slab, true, [](const Vec3d& p) {
        return p.z - 5.3 - kHeight * std::cos(2 * 3.14159265358979 * p.y / 12);
    });
    const LevelSet ball = solidOf(IndexBox{{-40, -40, -40}, {40, 40, 40}}, false,
                                  [](const Vec3d& p) { return length(p) - 33; });
    AnalogyOptions options;
    options.direction = direction("around:z");
    options.exemplarDirection = direction("axis:x");
    const AnalogyResult result = makeAnalogyModel({{&plain, &textured}}, ball, options);
    const double relief = reliefOnBall(*result.model.grid, 33);
    CHECK(reliefOnBall(*ball.grid, 33) < 0.02);
    CHECK(relief > 0.75 * kHeight / std::sqrt(2));
    CHECK(relief < 1.15 * kHeight / std::sqrt(2));
}

TEST_CASE("makeAnalogyModel: thin parts bear a share of the texture, none of it, or are cut", "[pipeline]") {
    // A texture that takes four voxels off everywhere, and a rod of three and a half.
    const auto ball = [](double radius) {
        return solidOf(IndexBox{{-28, -28, -28}, {28, 28, 28}}, false,
                       [=](const Vec3d& p) { return length(p) - radius; });
    };
    const ModelPair pair{ball(24), ball(20)};
    const LevelSet target = ballWithRod();
    const std::size_t whole = rodVoxels(*target.grid);
    AnalogyOptions options;
    options.direction = direction("axis:z");
    std::vector<std::string> notes;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Note) notes.push_back(text);
    };
    const AnalogyResult scaled = applied(pair, target, options, ctx);
    REQUIRE(notes.size() == 1);
    CHECK(test::contains(notes[0], "`thin`"));
    options.thin = ThinParts::Keep;
    const AnalogyResult kept = applied(pair, target, options);
    options.thin = ThinParts::AsIs;
    notes.clear();
    const AnalogyResult cut = applied(pair, target, options, ctx);
    CHECK(notes.empty());
    CHECK(rodVoxels(*kept.model.grid) == whole);
    CHECK(rodVoxels(*scaled.model.grid) > whole / 10);
    CHECK(rodVoxels(*scaled.model.grid) < whole / 2);
    CHECK(rodVoxels(*cut.model.grid) == 0);
    // Where the ball is thick all three are one.
    for (const AnalogyResult* other : {&scaled, &kept}) {
        std::size_t different = 0;
        auto a = cut.model.grid->getConstAccessor(), b = other->model.grid->getConstAccessor();
        forEachVoxel(IndexBox{{-26, -26, -26}, {26, 26, -4}}, [&](const Index3& p) {
            const openvdb::Coord at(p.x, p.y, p.z);
            different += a.getValue(at) != b.getValue(at);
        });
        CHECK(different == 0);
    }
}

TEST_CASE("makeAnalogyModel: a draft has the texture, repeats from its map, same bits for any threads",
          "[pipeline]") {
    constexpr double kRadius = 28;
    const ModelPair pair = pairOf("grooves", 72);
    const LevelSet target = solidOf(IndexBox{{-38, -38, -38}, {38, 38, 38}}, false,
                                    [](const Vec3d& p) { return length(p) - kRadius; });
    AnalogyOptions options;
    options.direction = direction("around:z");
    const AnalogyResult full = applied(pair, target, options);
    options.draft = true;
    RunContext one;
    one.threads = 1;
    const AnalogyResult draft = applied(pair, target, options), again = applied(pair, target, options, one);
    CHECK(levelSetHash(*draft.model.grid) == levelSetHash(*again.model.grid));
    const double relief = reliefOnBall(*draft.model.grid, kRadius),
                 wanted = reliefOnBall(*full.model.grid, kRadius);
    CHECK(relief == Approx(wanted).epsilon(0.2));
    REQUIRE(!draft.levels.empty());
    CHECK(draft.levels.back().voxels < full.levels.back().voxels / 4);
    const LevelSet repeated = repeatMap(draft.map, {&pair.textured, &target});
    CHECK(levelSetHash(*repeated.grid) == levelSetHash(*draft.model.grid));
    // Sweeps asked for are not taken, and that is said.
    options.synthesis.sweeps = 4;
    test::Said said;
    CHECK(levelSetHash(*applied(pair, target, options, said.ctx).model.grid) ==
          levelSetHash(*draft.model.grid));
    CHECK(said.noted("a draft takes one sweep"));
}

TEST_CASE("makeAnalogyModel: hollowing makes a shell of the pair's thickness, a valid level set",
          "[pipeline]") {
    const ModelPair pair = pairOf("hollow");
    const LevelSet target = tori();
    const AnalogyResult result = applied(pair, target);
    // The plate is about 4.8 thick and the tubes 7.2 in radius, so what is left is the core: (2.4 / 7.2)^2.
    const double share = solidVoxels(*result.model.grid) / solidVoxels(*target.grid);
    CHECK(share > 0.80);
    CHECK(share < 0.95);
    const BandQuality band = measureBand(*result.model.grid);
    CHECK(band.gradientErrorMean < 0.05);
    CHECK(band.missingNeighbours == 0);
    CHECK(band.finite);
    CHECK(result.model.domain == target.domain);
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
    REQUIRE(grids.size() == 4);
    CHECK(grids[0]->getName() == "source");
    CHECK(grids[0]->activeVoxelCount() > activeVoxels(*result.model.grid) / 2);
    CHECK(result.reach > 4);
}

TEST_CASE("makeAnalogyModel: strength 0 and an empty mask leave the target as it is", "[pipeline]") {
    const ModelPair pair = pairOf("dilation", 48);
    const LevelSet target = tori();
    AnalogyOptions plain;
    plain.direction = direction("around:z");
    const auto prepared = preparePairs({{&pair.plain, &pair.textured}}, plain);
    const auto solidWith = [&](const AnalogyOptions& options) {
        return solidVoxels(*makeAnalogyModel(*prepared, target, options).model.grid);
    };
    AnalogyOptions none = plain, masked = plain;
    none.strength = 0;
    const double before = solidVoxels(*target.grid);
    CHECK(solidWith(none) == Approx(before).epsilon(0.003));
    const auto empty = openvdb::FloatGrid::create(0.f);
    empty->setTransform(target.grid->transform().copy());
    masked.mask = empty;
    CHECK(solidWith(masked) == Approx(before).epsilon(0.003));
    CHECK(solidWith(plain) > 1.5 * before);
}

TEST_CASE("makeAnalogyModel: outside a mask of any kind the target's bits stay", "[pipeline][property]") {
    const ModelPair pair = pairOf("dilation", 48);
    const LevelSet target = tori();
    const openvdb::Vec3f middle(36, 36, 36);
    const auto solid = [&](float voxel, float band) -> GridConstPtr {
        return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20.f, middle, voxel, band);
    };
    const auto numbers = openvdb::FloatGrid::create(0.f);
    numbers->fill(openvdb::CoordBBox({0, 0, 0}, {30, 90, 90}), 1.f);
    const auto truths = openvdb::BoolGrid::create(false);
    truths->fill(openvdb::CoordBBox({0, 0, 0}, {30, 90, 90}), true);
    AnalogyOptions options;
    options.direction = direction("around:z");
    const auto prepared = preparePairs({{&pair.plain, &pair.textured}}, options);
    for (const GridConstPtr& mask :
         {solid(0.4f, 3), solid(1, 2), solid(3, 3), GridConstPtr(numbers), GridConstPtr(truths)}) {
        options.mask = mask;
        const AnalogyResult result = makeAnalogyModel(*prepared, target, options);
        const bool isSolid = mask->getGridClass() == openvdb::GRID_LEVEL_SET;
        std::size_t flipped = 0, changed = 0, far = 0;
        auto made = result.model.grid->getConstAccessor();
        for (auto it = target.grid->cbeginValueOn(); it; ++it) {
            const openvdb::Vec3d at = target.grid->indexToWorld(it.getCoord());
            const double outside = isSolid ? (at - openvdb::Vec3d(middle)).length() - 20 : at.x() - 30;
            const float now = made.getValue(it.getCoord());
            if (outside > 0.3 && (now < 0) != (*it < 0)) ++flipped;
            if (outside > 12 && now != *it) ++far;
            if (now != *it) ++changed;
        }
        CHECK(flipped == 0);
        CHECK(far == 0);
        CHECK(changed > 100);
    }
}

TEST_CASE("makeAnalogyModel: attributes of the textured model are transferred, directions are written",
          "[pipeline]") {
    ModelPair pair = pairOf("dilation");
    auto heat = openvdb::FloatGrid::create(0.f);
    heat->setName("heat");
    heat->setTransform(pair.textured.grid->transform().copy());
    for (auto it = pair.textured.grid->cbeginValueOn(); it; ++it) heat->tree().setValueOn(it.getCoord(), 3.f);
    pair.textured.attributes.push_back(heat);
    AnalogyOptions options;
    options.keepDirections = true;
    options.scale = 1.25;
    const AnalogyResult result = applied(pair, tori(), options);
    REQUIRE(result.model.attributes.size() == 1);
    const auto carried = openvdb::gridPtrCast<openvdb::FloatGrid>(result.model.attributes[0]);
    REQUIRE(carried);
    CHECK(carried->activeVoxelCount() > 1000);
    for (auto it = carried->cbeginValueOn(); it; ++it) REQUIRE(it.getValue() == 3.f);
    REQUIRE(result.directions);
    CHECK(result.directions->isType<openvdb::Vec3SGrid>());
    CHECK(sourceMapGrids(result.map, *result.model.grid).size() == 5);  // source_scale too
}

TEST_CASE("makeAnalogyModel: the same bits for any threads", "[pipeline][tsan]") {
    const ModelPair pair = pairOf("grooves");
    const LevelSet target = tori();
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    CHECK(levelSetHash(*applied(pair, target, {}, one).model.grid) ==
          levelSetHash(*applied(pair, target, {}, four).model.grid));
}

TEST_CASE("makeAnalogyModel: prepared pairs give each target what the pairs themselves do",
          "[pipeline][property]") {
    const ModelPair pair = pairOf("dilation", 48);
    AnalogyOptions options;
    options.direction = direction("around:z");
    for (const bool draft : {false, true}) {
        options.draft = draft;
        options.scale = draft ? 0.8 : 1;
        const auto prepared = preparePairs({{&pair.plain, &pair.textured}}, options);
        for (const int side : {40, 48}) {
            const LevelSet target = makeModel(makeOptions("three-tori", side));
            const AnalogyResult shared = makeAnalogyModel(*prepared, target, options);
            const AnalogyResult alone = applied(pair, target, options);
            CHECK(levelSetHash(*shared.model.grid) == levelSetHash(*alone.model.grid));
            CHECK(shared.map.elements.size() == alone.map.elements.size());
        }
        AnalogyOptions other = options;
        other.scale = 0.5;
        CHECK(test::contains(test::thrownBy([&] { makeAnalogyModel(*prepared, tori(), other); }).message,
                             "as when the pairs were prepared"));
        other = options;
        other.draft = !draft;
        CHECK(test::thrownBy([&] { makeAnalogyModel(*prepared, tori(), other); }).code ==
              int(ErrorCode::InvalidOption));
    }
    CHECK(test::thrownBy([&] { preparePairs({}, options); }).code == int(ErrorCode::InvalidOption));
    const std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] {
              preparePairs({{&pair.plain, &pair.textured}}, options, stopped);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("makeAnalogyModel: every refusal says what to do", "[pipeline]") {
    const ModelPair pair = pairOf("dilation");
    const LevelSet target = tori();
    const auto thrown = [&](const LevelSet& plain, const LevelSet& textured, const LevelSet& onto,
                            const AnalogyOptions& options) {
        return test::thrownBy([&] { makeAnalogyModel({{&plain, &textured}}, onto, options); });
    };
    AnalogyOptions options;
    options.direction = direction("axis:z");
    MakeOptions fine = makeOptions("dilation", 64);
    fine.voxelSize = 0.5;
    const test::Thrown sizes = thrown(pair.plain, makePair(fine).textured, target, options);
    CHECK(sizes.code == int(ErrorCode::ShapeMismatch));
    CHECK(test::contains(sizes.message, "`voxelSize`"));
    AnalogyOptions strong = options;
    strong.strength = 2;
    CHECK(thrown(pair.plain, pair.textured, target, strong).code == int(ErrorCode::InvalidOption));
    AnalogyOptions large = options;
    large.scale = 9;
    CHECK(thrown(pair.plain, pair.textured, target, large).code == int(ErrorCode::InvalidOption));
    // A plane has no curvature to follow.
    const test::Thrown flat = thrown(pair.plain, pair.textured, pairOf("pits").plain, {});
    CHECK(flat.code == int(ErrorCode::Unusable));
    CHECK(test::contains(flat.message, "`direction`"));
    AnalogyOptions memory = options;
    RunContext little;
    little.maxMemory = 1000;
    CHECK(test::thrownBy([&] { applied(pair, target, memory, little); }).code == int(ErrorCode::Memory));
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { applied(pair, target, {}, stopped); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("makeAnalogyModel: a target thinner than a neighbourhood is worked on, or said to be too thin",
          "[pipeline]") {
    AnalogyOptions options;
    options.direction = direction("axis:x");
    const auto plate = [](float thickness) {
        LevelSet model;
        model.grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {40, 40, thickness}), 1, 3, "plate");
        model.domain = solidBox(*model.grid, "plate");
        return model;
    };
    // Two voxels thick, dilated by four.
    const ModelPair dilation = pairOf("dilation");
    const LevelSet thin = plate(2);
    const AnalogyResult grown = makeAnalogyModel({{&dilation.plain, &dilation.textured}}, thin, options);
    const openvdb::FloatGrid& made = *grown.model.grid;
    CHECK(made.tree().getValue({20, 20, 1}) < 0);
    double top = 0;
    while (made.tree().getValue({20, 20, int(top)}) < 0) ++top;
    CHECK(top - 2 == Approx(4).margin(1));
    const ModelPair grooves = pairOf("grooves");
    const LevelSet small = [&] {
        LevelSet model;
        model.grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {3, 3, 3}), 1, 3, "island");
        model.domain = solidBox(*model.grid, "island");
        return model;
    }();
    // By default a core of it stays.
    const AnalogyResult kept = makeAnalogyModel({{&grooves.plain, &grooves.textured}}, small, options);
    CHECK(solidVoxels(*kept.model.grid) > 0);
    options.thin = ThinParts::AsIs;
    const test::Thrown gone = test::thrownBy([&] {
        makeAnalogyModel({{&grooves.plain, &grooves.textured}}, small, options);
    });
    CHECK(gone.code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(gone.message, "smaller voxels for the target"));
}

TEST_CASE("makeAnalogyModel: what is wrong with a direction names the field that gave it",
          "[pipeline][error]") {
    const ModelPair pair = pairOf("dilation");
    const auto nowhere = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    const auto said = [&](const GridConstPtr& own, const GridConstPtr& exemplar) {
        AnalogyOptions options;
        if (own) options.direction.kind = DirectionSource::Kind::Grid;
        if (exemplar) options.exemplarDirection.kind = DirectionSource::Kind::Grid;
        options.direction.grid = own;
        options.exemplarDirection.grid = exemplar;
        return test::thrownBy([&] { applied(pair, tori(), options); }).message;
    };
    CHECK(test::contains(said(nowhere, nullptr), "the target: `direction` gives no direction"));
    CHECK(test::contains(said(nullptr, nowhere), "the pair: `exemplarDirection` gives no direction"));
    CHECK(test::contains(said(nullptr, openvdb::Int32Grid::create()), "`exemplarDirection`: grid"));
}

TEST_CASE("makeAnalogyModel: the target's own grids follow, extended to the new surface, and repeat",
          "[pipeline][property]") {
    const ModelPair pair = pairOf("dilation");
    LevelSet target = tori();
    const auto density = openvdb::FloatGrid::create(0.f), heat = openvdb::FloatGrid::create(0.f);
    density->setName("density");
    heat->setName("heat");
    // One fills the solid, the other is on the band.
    for (auto value = target.grid->cbeginValueAll(); value; ++value)
        if (*value < 0 && value.isVoxelValue()) density->tree().setValueOn(value.getCoord(), 2.f);
    for (auto value = target.grid->cbeginValueOn(); value; ++value)
        heat->tree().setValueOn(value.getCoord(), float(value.getCoord().x()));
    density->tree().addTile(1, {800, 0, 0}, 1.f, true);
    target.attributes = {density, heat};
    const AnalogyResult result = applied(pair, target);
    REQUIRE(result.model.attributes.size() == 2);
    for (const GridPtr& grid : result.model.attributes) {
        if (grid->getName() == "density") {
            CHECK(grid->activeVoxelCount() == density->activeVoxelCount());
            continue;
        }
        REQUIRE(grid->getName() == "heat");
        const auto extended = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        // The dilated surface is over voxels where the target had no band.
        CHECK(double(extended->activeVoxelCount()) > 0.98 * double(result.model.grid->activeVoxelCount()));
        for (auto value = extended->cbeginValueOn(); value; ++value)
            REQUIRE(std::abs(*value - float(value.getCoord().x())) < 9);
    }
}
