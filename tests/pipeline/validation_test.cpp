// Every public function refuses what it cannot work on, with the right code and the field's name, before any
// work: never a crash, never nonsense.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/analogy/filter_analogy.h"
#include "libvdbsynth/pipeline/compare/compare.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/crop/crop.h"
#include "libvdbsynth/pipeline/fill/fill.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/match/match.h"
#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/render/slice.h"
#include "libvdbsynth/synth/block_synthesis.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Case {
    std::string named;  // that the message must have
    ErrorCode code;
    std::function<void()> call;
};

void refuses(const std::vector<Case>& cases) {
    for (const Case& each : cases) {
        const test::Thrown thrown = test::thrownBy(each.call);
        INFO(each.named << " | " << thrown.message);
        CHECK(thrown.code == int(each.code));
        CHECK(test::contains(thrown.message, each.named));
        CHECK(thrown.message.find("--") == std::string::npos);
        CHECK(thrown.message.find('\n') == std::string::npos);
    }
}

LevelSet made(const char* kind = "balls", int resolution = 32) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    return makeModel(options);
}

LevelSet withGrid(const LevelSet& model, const std::function<void(openvdb::FloatGrid&)>& change) {
    LevelSet copy = model;
    copy.grid = model.grid->deepCopy();
    change(*copy.grid);
    return copy;
}

struct BadModel {
    std::string named;
    ErrorCode code;
    LevelSet model;
};

// What no function may take for a model.
std::vector<BadModel> badModels(const LevelSet& good) {
    std::vector<BadModel> all;
    LevelSet null = good;
    null.grid = nullptr;
    all.push_back({"`grid` is null", ErrorCode::InvalidOption, null});
    all.push_back({"is not a level set", ErrorCode::Unusable, withGrid(good, [](openvdb::FloatGrid& grid) {
                       grid.setGridClass(openvdb::GRID_FOG_VOLUME);
                   })});
    all.push_back({"not cubes", ErrorCode::Unusable, withGrid(good, [](openvdb::FloatGrid& grid) {
                       grid.transform().preScale(openvdb::Vec3d(1, 1, 2));
                   })});
    all.push_back({"not cubes", ErrorCode::Unusable, withGrid(good, [](openvdb::FloatGrid& grid) {
                       grid.setTransform(openvdb::math::Transform::createFrustumTransform(
                           openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(32)), 0.5, 10));
                   })});
    all.push_back({"under 1.5", ErrorCode::Unusable,
                   withGrid(good, [](openvdb::FloatGrid& grid) { grid.transform().preScale(3); })});
    all.push_back({"NaN", ErrorCode::BadData, withGrid(good, [](openvdb::FloatGrid& grid) {
                       grid.tree().setValueOn(grid.cbeginValueOn().getCoord(), float(kNaN));
                   })});
    all.push_back({"no active voxels", ErrorCode::EmptyInput,
                   withGrid(good, [](openvdb::FloatGrid& grid) { grid.clear(); })});
    LevelSet nullAttribute = good;
    nullAttribute.attributes = {nullptr};
    all.push_back({"`attributes`", ErrorCode::InvalidOption, nullAttribute});
    LevelSet empty = good;
    empty.domain = IndexBox();
    all.push_back({"`domain`", ErrorCode::InvalidOption, empty});
    LevelSet far = good;
    far.domain.max.x = std::numeric_limits<int>::max();
    all.push_back({"`domain`", ErrorCode::InvalidOption, far});
    return all;
}

// Every function that takes models, with a bad one in each place.
void refusesBadModels(const std::function<void(const LevelSet&)>& call, const LevelSet& good) {
    std::vector<Case> cases;
    const std::vector<BadModel> bad = badModels(good);
    for (const BadModel& each : bad) cases.push_back({each.named, each.code, [&] { call(each.model); }});
    refuses(cases);
}

template <typename Options, typename Field, typename Call>
Case with(const std::string& named, Field Options::*field, Field value, const Call& call,
          Options options = {}, ErrorCode code = ErrorCode::InvalidOption) {
    options.*field = value;
    return {named, code, [=] { call(options); }};
}

}  // namespace

TEST_CASE("bad models are refused by every function", "[pipeline][error]") {
    const LevelSet good = made();
    const LevelSet hole = boxHole(good, {{8, 8, 8}, {14, 14, 14}});
    const SourceMap map = synthesize(good).map;
    const std::vector<std::function<void(const LevelSet&)>> calls{
        [&](const LevelSet& bad) { synthesize(bad); },
        [&](const LevelSet& bad) {
            synthesize({&good, &bad});
        },
        [&](const LevelSet& bad) { matchModel(bad, good, {}); },
        [&](const LevelSet& bad) { matchModel(good, bad, {}); },
        [&](const LevelSet& bad) { fillHoles(bad, hole, nullptr); },
        [&](const LevelSet& bad) { fillHoles(good, bad, nullptr); },
        [&](const LevelSet& bad) { fillHoles(good, hole, &bad); },
        [&](const LevelSet& bad) {
            boxHole(bad, {{0, 0, 0}, {4, 4, 4}});
        },
        [&](const LevelSet& bad) {
            makeAnalogyModel({{&bad, &good}}, good, {});
        },
        [&](const LevelSet& bad) {
            makeAnalogyModel({{&good, &bad}}, good, {});
        },
        [&](const LevelSet& bad) {
            makeAnalogyModel({{&good, &good}}, bad, {});
        },
        [&](const LevelSet& bad) {
            compareModels({"bad", bad, {}}, {});
        },
        [&](const LevelSet& bad) {
            compareModels({"good", good, {}}, {{"bad", bad, {}}});
        },
        [&](const LevelSet& bad) {
            cropModel(bad, {{0, 0, 0}, {9, 9, 9}});
        },
        [&](const LevelSet& bad) { withHalfWidth(bad, 4); },
        [&](const LevelSet& bad) { resampled(bad, 2); },
        [&](const LevelSet& bad) { repeatMap(map, {&bad}); },
    };
    for (std::size_t c = 0; c < calls.size(); ++c) {
        INFO("call " << c);
        refusesBadModels(calls[c], good);
    }
}

TEST_CASE("SynthOptions: every field out of its range is refused", "[pipeline][error]") {
    const LevelSet balls = made(), grid = made("grid");
    const auto call = [&](const SynthOptions& options) { synthesize(balls, options); };
    using O = SynthOptions;
    O sized;
    std::vector<Case> cases;
    for (float halfWidth : {0.f, -3.f, 1.4f, float(kNaN), float(kInfinite), 1e9f})
        cases.push_back(with("`halfWidth`", &O::halfWidth, halfWidth, call));
    for (double value : {0.0, -1.0, 2.0, kNaN, kInfinite})
        cases.push_back(with("`longestRun`", &O::longestRun, value, call));
    for (double value : {0.0, -1.0, 1e9, kNaN})
        cases.push_back(with("`guideWeight`", &O::guideWeight, value, call));
    for (int value : {-1, 1, 3, 257, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
        cases.push_back(with("`block`", &O::block, value, call));
    for (int value : {-1, 9, std::numeric_limits<int>::max()})
        cases.push_back(with("`levels`", &O::levels, value, call));
    for (int value : {-1, std::numeric_limits<int>::max()})
        cases.push_back(with("`drift`", &O::drift, value, call));
    for (double value : {0.0, -2.0, 1e9, kNaN, kInfinite})
        cases.push_back(with("`size`", &O::size, TargetSize::multiples(2, value, 1), call));
    for (int value : {0, -5, std::numeric_limits<int>::max()})
        cases.push_back(with("`size`", &O::size, TargetSize::voxels(64, 64, value), call));
    cases.push_back(with("`size`", &O::size, TargetSize::voxels(8, 64, 64), call, {}, ErrorCode::Unusable));
    cases.push_back(with("`exemplarBox`", &O::exemplarBox, std::optional<IndexBox>(IndexBox()), call));
    cases.push_back(with("`exemplarBox`", &O::exemplarBox,
                         std::optional<IndexBox>(IndexBox{{0, 0, 0}, {1 << 30, 9, 9}}), call));
    cases.push_back(with("`exemplarMap`", &O::exemplarMap, GridConstPtr(balls.grid), call));
    cases.push_back(with("`guide`", &O::guide, GridConstPtr(balls.grid), call));
    cases.push_back(with("`exemplarGuides`", &O::exemplarGuides, {GridConstPtr()}, call, [&] {
        O o;
        o.guide = balls.grid;
        return o;
    }()));
    cases.push_back(with("`exemplarGuides`", &O::exemplarGuides,
                         {GridConstPtr(balls.grid), GridConstPtr(balls.grid)}, call, [&] {
                             O o;
                             o.guide = balls.grid;
                             return o;
                         }()));
    cases.push_back(with("`origin`", &O::origin, std::optional<Vec3d>(Vec3d{0, 1e31, 0}), call));
    cases.push_back(with("no active voxels", &O::exemplarMask, GridConstPtr(openvdb::BoolGrid::create(false)),
                         call, {}, ErrorCode::EmptyInput));
    cases.push_back({"at least one exemplar", ErrorCode::InvalidOption,
                     [] { synthesize(std::vector<const LevelSet*>{}); }});
    cases.push_back({"exemplar 2", ErrorCode::InvalidOption, [&] { synthesize({&balls, nullptr}); }});
    cases.push_back({"`exemplarMap`", ErrorCode::InvalidOption, [&] {
                         O options;
                         options.rotationMap = balls.grid;
                         synthesize({&balls, &grid}, options);
                     }});
    cases.push_back({"no exemplar", ErrorCode::BadData, [&] { repeatMap({}, {&balls}); }});
    for (Case& each : cases)
        if (each.named == "voxel size") each.named = "voxels";
    refuses(cases);
}

TEST_CASE("MatchOptions: every field out of its range is refused", "[pipeline][error]") {
    const LevelSet model = made();
    const auto call = [&](const MatchOptions& options) { matchModel(model, model, options); };
    using O = MatchOptions;
    std::vector<Case> cases;
    for (int value : {-1, 0, 3, 257, std::numeric_limits<int>::max()})
        cases.push_back(with("`block`", &O::block, value, call));
    for (int value : {0, -1, 100001}) cases.push_back(with("`count`", &O::count, value, call));
    for (double value : {-0.1, 101.0, kNaN}) cases.push_back(with("`tolerance`", &O::tolerance, value, call));
    cases.push_back(with("`at`", &O::at, Index3{std::numeric_limits<int>::max(), 0, 0}, call));
    cases.push_back(with("`at`", &O::at, Index3{1000, 0, 0}, call, {}, ErrorCode::Unusable));
    cases.push_back(with("`block` 40", &O::block, 40, call, {}, ErrorCode::Unusable));
    cases.push_back(with("no active voxels", &O::mask, GridConstPtr(openvdb::BoolGrid::create(false)), call,
                         {}, ErrorCode::EmptyInput));
    refuses(cases);
}

TEST_CASE("FillOptions: fields out of their range and exemplars of other voxels are refused",
          "[pipeline][error]") {
    const LevelSet model = made();
    const LevelSet hole = boxHole(model, {{8, 8, 8}, {14, 14, 14}});
    const auto call = [&](const FillOptions& options) { fillHoles(model, hole, nullptr, options); };
    using O = FillOptions;
    std::vector<Case> cases;
    for (int value : {-1, 3, 257, std::numeric_limits<int>::max()})
        cases.push_back(with("`block`", &O::block, value, call));
    for (int value : {-1, 9, std::numeric_limits<int>::max()})
        cases.push_back(with("`levels`", &O::levels, value, call));
    const LevelSet coarse = resampled(model, 2);
    cases.push_back({"voxel size", ErrorCode::ShapeMismatch, [&] { fillHoles(model, hole, &coarse); }});
    cases.push_back({"`box`", ErrorCode::InvalidOption, [&] { boxHole(model, IndexBox()); }});
    cases.push_back({"`box`", ErrorCode::InvalidOption, [&] {
                         boxHole(model, {{0, 0, 0}, {1 << 30, 4, 4}});
                     }});
    cases.push_back({"`hole`", ErrorCode::Unusable, [&] { holesAtOpenEdges(model); }});
    refuses(cases);
}

TEST_CASE("AnalogyOptions: every field out of its range is refused", "[pipeline][error]") {
    const LevelSet model = made();
    const std::vector<AnalogyModelPair> pairs{{&model, &model}};
    const auto call = [&](const AnalogyOptions& options) { makeAnalogyModel(pairs, model, options); };
    using O = AnalogyOptions;
    using V = VolumeAnalogyOptions;
    const auto deep = [&](const V& synthesis) {
        O options;
        options.synthesis = synthesis;
        call(options);
    };
    std::vector<Case> cases;
    for (double value : {0.0, 0.2, 5.0, kNaN}) cases.push_back(with("`scale`", &O::scale, value, call));
    for (double value : {-0.1, 1.1, kNaN}) cases.push_back(with("`strength`", &O::strength, value, call));
    for (float value : {0.f, -1.f, float(kNaN), 1e9f})
        cases.push_back(with("`halfWidth`", &O::halfWidth, value, call));
    for (int value : {0, -1, 5, 1 << 30, std::numeric_limits<int>::max()})
        cases.push_back(with("`half`", &V::half, value, deep));
    for (int value : {0, 4, 1 << 30}) cases.push_back(with("`coarseHalf`", &V::coarseHalf, value, deep));
    for (int value : {-1, 7, 31, 1 << 30}) cases.push_back(with("`levels`", &V::levels, value, deep));
    for (int value : {-1, 0, 11}) cases.push_back(with("`sweeps`", &V::sweeps, value, deep));
    for (int value : {0, 3, 257}) cases.push_back(with("`components`", &V::components, value, deep));
    for (double value : {-1.0, 101.0, kNaN}) cases.push_back(with("`coherence`", &V::coherence, value, deep));
    for (double value : {-1.0, 101.0, kNaN}) cases.push_back(with("`epsilon`", &V::epsilon, value, deep));
    DirectionSource source;
    source.kind = DirectionSource::Kind::Grid;
    cases.push_back(with("`direction`", &O::direction, source, call));
    cases.push_back(with("`exemplarDirection`", &O::exemplarDirection, source, call));
    source.kind = DirectionSource::Kind::Strokes;
    cases.push_back(with("`direction`", &O::direction, source, call));
    source.strokes = {{{0, 0, 0}, {kNaN, 0, 0}}};
    cases.push_back(with("`direction`", &O::direction, source, call));
    source.kind = DirectionSource::Kind::Axis;
    source.axis = {0, 0, 0};
    cases.push_back(with("`direction`", &O::direction, source, call));
    cases.push_back({"`pairs`", ErrorCode::InvalidOption,
                     [&] { makeAnalogyModel(std::vector<AnalogyModelPair>{}, model, {}); }});
    cases.push_back({"the pair, textured", ErrorCode::InvalidOption, [&] {
                         makeAnalogyModel({{&model, nullptr}}, model, {});
                     }});
    const LevelSet coarse = resampled(model, 2);
    cases.push_back({"same voxels", ErrorCode::ShapeMismatch, [&] {
                         makeAnalogyModel({{&model, &coarse}}, model, {});
                     }});
    refuses(cases);
}

TEST_CASE("FilterAnalogyOptions, CompareOptions, MakeOptions: fields out of their range are refused",
          "[pipeline][error]") {
    openvdb::initialize();
    using F = FilterAnalogyOptions;
    auto fog = openvdb::FloatGrid::create(0);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    fog->tree().setValueOn(openvdb::Coord(1, 2, 3), 1.f);
    const LevelSet model = made();
    const auto filter = [&](const F& options) { makeFilteredGrid({{fog, fog}}, fog, options); };
    std::vector<Case> cases;
    for (int value : {0, 5, -1, 1 << 30}) cases.push_back(with("`half`", &F::half, value, filter));
    for (int value : {0, 5, 40}) cases.push_back(with("`levels`", &F::levels, value, filter));
    for (int value : {3, 257}) cases.push_back(with("`components`", &F::components, value, filter));
    cases.push_back({"`pairs`", ErrorCode::InvalidOption, [&] { makeFilteredGrid({}, fog, {}); }});
    cases.push_back({"`before`", ErrorCode::InvalidOption, [&] {
                         makeFilteredGrid({{nullptr, fog}}, fog, {});
                     }});
    cases.push_back({"target", ErrorCode::InvalidOption, [&] {
                         makeFilteredGrid({{fog, fog}}, nullptr, {});
                     }});
    cases.push_back({"level set", ErrorCode::Unusable, [&] {
                         makeFilteredGrid({{fog, fog}}, model.grid, {});
                     }});
    using C = CompareOptions;
    const CompareInput input{"a", model, {}};
    const auto compare = [&](const C& options) { compareModels(input, {}, options); };
    for (int value : {0, 1, 101}) cases.push_back(with("`fresh`", &C::fresh, value, compare));
    ExemplarOptions process;
    process.kind = "clouds";
    cases.push_back(with("clouds", &C::process, std::optional<ExemplarOptions>(process), compare));
    using M = MakeOptions;
    const auto make = [](const M& options) { makeModel(options); };
    const auto pair = [](const M& options) { makePair(options); };
    M balls, grooves;
    balls.exemplar.kind = "balls";
    grooves.exemplar.kind = "grooves";
    for (double value : {0.0, -1.0, kNaN, kInfinite}) {
        cases.push_back(with("`voxelSize`", &M::voxelSize, value, make, balls));
        cases.push_back(with("`voxelSize`", &M::voxelSize, value, pair, grooves));
    }
    for (double value : {-1.0, 1.0, 1000.0, kNaN, kInfinite}) {
        balls.exemplar.feature = grooves.exemplar.feature = value;
        cases.push_back({"`feature`", ErrorCode::InvalidOption, [=] { make(balls); }});
        cases.push_back({"`feature`", ErrorCode::InvalidOption, [=] { pair(grooves); }});
    }
    balls.exemplar.feature = grooves.exemplar.feature = 0;
    balls.exemplar.resolution = grooves.exemplar.resolution = std::numeric_limits<int>::max();
    cases.push_back({"`resolution`", ErrorCode::InvalidOption, [=] { make(balls); }});
    cases.push_back({"`resolution`", ErrorCode::InvalidOption, [=] { pair(grooves); }});
    balls.exemplar.resolution = 64;
    balls.exemplar.size = {-8, 64, 64};
    cases.push_back({"`size`", ErrorCode::InvalidOption, [=] { make(balls); }});
    refuses(cases);
}

TEST_CASE("ModelOptions, ModelOutputOptions, boxes and pictures: fields out of their range are refused",
          "[pipeline][error]") {
    const LevelSet model = made();
    const test::TemporaryFolder folder;
    folder.write("a.obj", "v 0 0 0\n");
    using M = ModelOptions;
    const auto load = [&](const M& options) { loadModel(folder.path("a.obj"), options); };
    std::vector<Case> cases;
    for (double value : {-1.0, kNaN, kInfinite})
        cases.push_back(with("`voxelSize`", &M::voxelSize, value, load));
    for (int value : {-1, 1, 100001}) cases.push_back(with("`resolution`", &M::resolution, value, load));
    for (double value : {0.0, -3.0, kNaN, 1e9})
        cases.push_back(with("`halfWidth`", &M::halfWidth, value, load));
    cases.push_back(with("`iso`", &M::iso, std::optional<double>(kNaN), load));
    SolidOptions shell;
    shell.open = OpenMesh::Shell;
    for (double value : {0.0, -1.0, kNaN, kInfinite}) {
        shell.thickness = value;
        cases.push_back(with("`thickness`", &M::solid, shell, load));
    }
    HeightOptions heights;
    heights.base = -1;
    cases.push_back(with("`base`", &M::heights, heights, load));
    heights.base = 0;
    heights.height = kNaN;
    cases.push_back(with("`height`", &M::heights, heights, load));
    VolumeOptions volume;
    volume.threshold = kNaN;
    cases.push_back(with("`threshold`", &M::volume, volume, load));
    volume.threshold.reset();
    volume.labels = {{2, 1}};
    cases.push_back(with("`labels`", &M::volume, volume, load));
    using W = ModelOutputOptions;
    const auto write = [&](const W& options) {
        OutputSet outputs;
        writeModel(model, {folder.path("a.vdb")}, options, outputs);
    };
    for (double value : {-0.1, 2.0, kNaN})
        cases.push_back(with("`adaptivity`", &W::adaptivity, value, write));
    for (double value : {0.0, 101.0, kNaN}) cases.push_back(with("`spacing`", &W::spacing, value, write));
    for (double value : {-1.0, kNaN}) cases.push_back(with("`height`", &W::height, value, write));
    cases.push_back(with("`extraGrids`", &W::extraGrids, {GridPtr()}, write));
    cases.push_back({"`halfWidth`", ErrorCode::InvalidOption, [&] { withHalfWidth(model, kNaN); }});
    cases.push_back({"`voxelSize`", ErrorCode::InvalidOption, [&] { resampled(model, kNaN); }});
    cases.push_back({"`box`", ErrorCode::InvalidOption, [&] { cropModel(model, IndexBox()); }});
    cases.push_back({"null", ErrorCode::InvalidOption, [&] { modelFromGrids("a.vdb", {GridPtr()}); }});
    VdbReadOptions iso;
    iso.iso = kInfinite;
    cases.push_back({"`iso`", ErrorCode::InvalidOption, [&] { modelFromGrids("a.vdb", {model.grid}, iso); }});
    using P = PreviewOptions;
    const auto picture = [&](const P& options) { renderPreview(*model.grid, options); };
    for (int value : {0, -1, 8193}) cases.push_back(with("`width`", &P::width, value, picture));
    for (int value : {0, 65}) cases.push_back(with("`samples`", &P::samples, value, picture));
    for (double value : {0.0, kNaN, kInfinite})
        cases.push_back(with("`view`", &P::view, Vec3d{0, 0, value}, picture));
    cases.push_back(
        with("`directions`", &P::directions, GridConstPtr(model.grid), picture, {}, ErrorCode::BadData));
    using S = SliceOptions;
    const auto slice = [&](const S& options) { renderSlice(*model.grid, model.domain, options); };
    for (int value : {-1, 3}) cases.push_back(with("`axis`", &S::axis, value, slice));
    for (double value : {-0.1, 1.1, kNaN}) cases.push_back(with("`fraction`", &S::fraction, value, slice));
    cases.push_back({"`box`", ErrorCode::InvalidOption, [&] { renderSlice(*model.grid, IndexBox()); }});
    refuses(cases);
}

TEST_CASE("fields and blocks: what block search and synthesis cannot work on is refused",
          "[pipeline][error]") {
    const auto field = std::make_shared<const BrickField>(test::ballsField({24, 24, 24}, 1, 4));
    const auto moved = std::make_shared<const BrickField>(BrickField(IndexBox::cube({1, 0, 0}, 24), 1.f));
    const auto broken = std::make_shared<const BrickField>(
        test::fieldFrom({24, 24, 24}, [](const Index3& p) { return p.x == 3 ? float(kNaN) : float(p.y); }));
    const BrickField small(IndexBox::fromSize({8, 8, 8}), 1.f);
    using I = BlockIndexOptions;
    const auto build = [&](const I& options) { BlockIndex::build(field, options); };
    std::vector<Case> cases;
    for (int value : {-1, 0, 3, 257}) cases.push_back(with("`block`", &I::block, value, build));
    cases.push_back(with("`block` 25", &I::block, 25, build, {}, ErrorCode::Unusable));
    cases.push_back(with("`mask`", &I::mask, &small, build, {}, ErrorCode::ShapeMismatch));
    cases.push_back({"exemplar", ErrorCode::InvalidOption, [] { BlockIndex::build(nullptr, {}); }});
    cases.push_back({"begins at", ErrorCode::ShapeMismatch, [&] { BlockIndex::build(moved, {}); }});
    cases.push_back({"NaN", ErrorCode::BadData, [&] { BlockIndex::build(broken, {}); }});
    const BlockIndex index = BlockIndex::build(field, [] {
        I o;
        o.block = 8;
        return o;
    }());
    std::vector<float> samples(512, float(kNaN));
    BlockQuery nothing, wrong;
    wrong.samples = samples.data();
    cases.push_back({"`samples`", ErrorCode::InvalidOption, [&] { index.match(nothing); }});
    cases.push_back({"`samples`", ErrorCode::BadData, [&] { index.match(wrong); }});
    cases.push_back({"`samples`", ErrorCode::InvalidOption, [&] { index.matchAll({nothing}); }});
    cases.push_back(
        {"`samples`", ErrorCode::InvalidOption, [&] { matchBlocksLinearly(*field, 8, nothing); }});
    cases.push_back({"`count`", ErrorCode::InvalidOption, [&] { index.match(nothing, 0); }});
    using B = BlockSynthesisOptions;
    B target;
    target.size = {32, 24, 24};
    const auto blocks = [&](const B& options) { synthesizeBlocks({field}, options); };
    cases.push_back(with("`size`", &B::size, Index3{1 << 30, 24, 24}, blocks, target));
    cases.push_back(with("`drift`", &B::drift, -1, blocks, target));
    cases.push_back(with("`exemplarMap`", &B::exemplarMap, &small, blocks, target, ErrorCode::ShapeMismatch));
    cases.push_back(with("`masks` 1", &B::masks, {&small}, blocks, target, ErrorCode::ShapeMismatch));
    cases.push_back(with("`guide`", &B::guide, &small, blocks, target));
    cases.push_back(with("`known`", &B::known, &small, blocks, target));
    cases.push_back(
        {"at least one exemplar", ErrorCode::InvalidOption, [&] { synthesizeBlocks({}, target); }});
    cases.push_back({"exemplar 1", ErrorCode::InvalidOption, [&] { synthesizeBlocks({nullptr}, target); }});
    cases.push_back({"begins at", ErrorCode::ShapeMismatch, [&] { synthesizeBlocks({moved}, target); }});
    cases.push_back({"NaN", ErrorCode::BadData, [&] { synthesizeBlocks({broken}, target); }});
    refuses(cases);
}
