#include "libvdbsynth/pipeline/synth/synth.h"

#include <openvdb/tools/LevelSetPlatonic.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "tests/support/made_models.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

using namespace vdbsynth;
using test::made;
using test::sized;

TEST_CASE("synthesize: the result fills its domain, is valid, closed and about as full as the exemplar",
          "[pipeline][property]") {
    for (const char* kind : {"balls", "grid", "weave"}) {
        INFO(kind);
        const LevelSet exemplar = made(kind);
        const SynthResult result = synthesize(exemplar, sized(2, 1.5, 1));
        const IndexBox domain = result.model.domain;
        CHECK(domain.min == exemplar.domain.min);
        CHECK(domain.size() == Index3{80, 60, exemplar.domain.size().z});
        CHECK(result.model.domainRecorded);
        CHECK(domain.contains(solidBox(*result.model.grid, "result")));
        CHECK(result.model.grid->background() == 3.f);
        const BandQuality quality = measureBand(*result.model.grid);
        CHECK(quality.gradientErrorMean < 0.1);
        CHECK(quality.missingNeighbours == 0);
        CHECK(summarize(levelSetToMesh(*result.model.grid)).closedManifold());
        const double before = solidVoxels(*exemplar.grid) / double(exemplar.domain.volume());
        CHECK(solidVoxels(*result.model.grid) / double(domain.volume()) == Approx(before).epsilon(0.2));
    }
}

TEST_CASE("synthesize: a draft is valid, closed, about as full, of the size asked for and searched less",
          "[pipeline][property]") {
    for (const char* kind : {"balls", "grid"}) {
        INFO(kind);
        const LevelSet exemplar = made(kind, 48);
        SynthOptions options = sized(2, 1, 1);
        options.size[1] = Extent::multiple(1.3);
        const SynthResult full = synthesize(exemplar, options);
        options.draft = true;
        const SynthResult draft = synthesize(exemplar, options);
        CHECK(draft.model.domain == full.model.domain);
        CHECK(voxelSizeOf(*draft.model.grid) == voxelSizeOf(*full.model.grid));
        CHECK(draft.stats.exact < full.stats.exact);
        CHECK(draft.model.domain.contains(solidBox(*draft.model.grid, "draft")));
        const BandQuality quality = measureBand(*draft.model.grid);
        CHECK(quality.gradientErrorMean < 0.1);
        CHECK(quality.missingNeighbours == 0);
        CHECK(summarize(levelSetToMesh(*draft.model.grid)).closedManifold());
        const double before = solidVoxels(*exemplar.grid) / double(exemplar.domain.volume());
        CHECK(solidVoxels(*draft.model.grid) / double(draft.model.domain.volume()) ==
              Approx(before).epsilon(0.2));
    }
}

TEST_CASE(
    "synthesize: a draft of an exemplar too small for half the resolution says so and is the full result",
    "[pipeline][fast]") {
    LevelSet exemplar = made("balls", 16, 8);
    exemplar.domain = IndexBox{{0, 0, 0}, {13, 13, 13}};
    SynthOptions options = sized(2, 1, 1);
    const SynthResult full = synthesize(exemplar, options);
    options.draft = true;
    RunContext ctx;
    std::string said;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Note) said += text;
    };
    const SynthResult draft = synthesize(exemplar, options, ctx);
    CHECK(test::contains(said, "`draft`"));
    CHECK(levelSetHash(*draft.model.grid) == levelSetHash(*full.model.grid));
}

TEST_CASE("synthesize: an object keeps its faces and grows in between", "[pipeline][property]") {
    openvdb::initialize();
    LevelSet object;
    object.grid = meshToLevelSet(test::boxMesh({-10.1f, -6.1f, -5.1f}, {10.1f, 6.1f, 5.1f}), 0.25, 3, "box");
    object.domain = solidBox(*object.grid, "box");
    stampLevelSet(object);
    const SynthResult result = synthesize(object, sized(2, 1, 1));
    const IndexBox solid = solidBox(*result.model.grid, "result");
    CHECK(solid == result.model.domain);
    CHECK(solid.size() == Index3{object.domain.size().x * 2, object.domain.size().y, object.domain.size().z});
    CHECK(solidVoxels(*result.model.grid) == Approx(2 * solidVoxels(*object.grid)).epsilon(0.02));
}

TEST_CASE("synthesize: a tiling result fills its domain and goes on at the other side",
          "[pipeline][property]") {
    const LevelSet exemplar = made("balls", 48);
    SynthOptions options;
    options.size = TargetSize::voxels(80, 80, 48);
    options.border = {Border::Tile, Border::Tile, Border::Cut};
    const SynthResult result = synthesize(exemplar, options);
    CHECK(result.model.domain.size() == Index3{80, 80, 48});
    CHECK(result.model.domain.min == exemplar.domain.min);
    CHECK(result.model.domain.contains(solidBox(*result.model.grid, "result")));
    // Voxels that change sides between a plane and the next: at the border about as many as inside.
    const auto values = result.model.grid->getConstAccessor();
    const auto changes = [&](int from, int to) {
        int count = 0;
        for (int y = 0; y < 80; ++y)
            for (int z = 0; z < 48; ++z)
                count += (values.getValue({from, y, z}) < 0) != (values.getValue({to, y, z}) < 0);
        return count;
    };
    double inside = 0;
    for (int x = 0; x + 1 < 80; ++x) inside += changes(x, x + 1) / 79.0;
    CHECK(changes(79, 0) < 1.5 * inside);
    CHECK(levelSetHash(*repeatMap(result.map, {&exemplar}).grid) == levelSetHash(*result.model.grid));
    options.method = SynthesisMethod::Exact;
    CHECK(test::contains(test::thrownBy([&] { synthesize(exemplar, options); }).message, "`border` tile"));
}

TEST_CASE("synthesize: sizes in voxels, an exemplar box, a mask", "[pipeline][property]") {
    const LevelSet exemplar = made("balls", 64);
    SynthOptions options;
    options.size = {Extent::voxels(70), Extent::voxels(50), Extent::multiple(1)};
    options.exemplarBox = IndexBox{{4, 4, 4}, {43, 43, 35}};
    options.exemplarMask = boxMask({{4, 4, 4}, {30, 43, 35}}, 1);
    options.block = 8;
    const SynthResult result = synthesize(exemplar, options);
    CHECK(result.model.domain == IndexBox{{4, 4, 4}, {73, 53, 35}});
    const PatchMap& patches = result.map.patches;
    for (const Index3& source : patches.source) REQUIRE(source.x + patches.block <= 27);
    options.exemplarMask = boxMask({{4, 4, 4}, {6, 6, 6}}, 1);
    CHECK(test::contains(test::thrownBy([&] { synthesize(exemplar, options); }).message, "`exemplarMask`"));
}

TEST_CASE("synthesize: a mask in other voxels, and a solid as a mask", "[pipeline][property]") {
    const LevelSet exemplar = made("balls", 64);
    SynthOptions options;
    options.size = {Extent::voxels(70), Extent::voxels(50), Extent::multiple(1)};
    options.block = 8;
    options.exemplarMask = boxMask({{4, 4, 4}, {30, 43, 35}}, 1);
    const std::string own = levelSetHash(*synthesize(exemplar, options).model.grid);
    // The same box in halves of voxels: those nearest to the centres 4 to 30.
    options.exemplarMask = boxMask({{8, 8, 8}, {61, 87, 71}}, 0.5);
    CHECK(levelSetHash(*synthesize(exemplar, options).model.grid) == own);
    // A box as a level set, not its band.
    FloatGridPtr solid = openvdb::tools::createLevelSetBox<openvdb::FloatGrid>(
        openvdb::BBoxd({3.5, 3.5, 3.5}, {30.5, 43.5, 35.5}),
        *openvdb::math::Transform::createLinearTransform(0.7), 2);
    options.exemplarMask = solid;
    CHECK(levelSetHash(*synthesize(exemplar, options).model.grid) == own);
}

TEST_CASE("synthesize: attributes are transferred through the map, and repeated", "[pipeline][property]") {
    LevelSet exemplar = made("balls", 40);
    // A number that tells the voxel it lies on, and a colour; and a grid of an old source map, which stays
    // behind.
    auto place = openvdb::FloatGrid::create(-1.f);
    place->setName("place");
    auto colour = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    colour->setName("Cd");
    for (auto it = exemplar.grid->cbeginValueOn(); it; ++it) {
        const openvdb::Coord c = it.getCoord();
        place->tree().setValueOn(c, float(c.x() + 100 * c.y() + 10000 * c.z()));
        colour->tree().setValueOn(c, openvdb::Vec3f(0.1f, 0.2f, 0.3f));
    }
    auto old = openvdb::Vec3IGrid::create();
    old->setName("source");
    exemplar.attributes = {place, colour, old};
    const SynthResult result = synthesize(exemplar, sized(2, 1.5, 1));
    REQUIRE(result.model.attributes.size() == 2);
    CHECK(result.model.attributes[1]->getName() == "Cd");
    const auto carried = openvdb::gridPtrCast<openvdb::FloatGrid>(result.model.attributes[0]);
    const auto source =
        openvdb::gridPtrCast<openvdb::Vec3IGrid>(sourceMapGrids(result.map, *result.model.grid)[0]);
    std::size_t exact = 0, all = 0;
    for (auto it = source->cbeginValueOn(); it; ++it, ++all) {
        const openvdb::Vec3i from = *it;
        exact +=
            carried->tree().getValue(it.getCoord()) == float(from.x() + 100 * from.y() + 10000 * from.z());
    }
    CHECK(double(exact) > 0.8 * double(all));
    CHECK(double(carried->activeVoxelCount()) > 0.95 * double(all));
    const LevelSet again = repeatMap(result.map, {&exemplar});
    REQUIRE(again.attributes.size() == 2);
    CHECK(openvdb::gridPtrCast<openvdb::FloatGrid>(again.attributes[0])->activeVoxelCount() ==
          carried->activeVoxelCount());
}

TEST_CASE("synthesize: numbers and vectors that come along can be means of all that had a say",
          "[pipeline][oracle]") {
    LevelSet exemplar = made("balls", 40);
    // What is copied lies on a ramp or is one vector everywhere; a class number cannot be a mean.
    auto ramp = openvdb::FloatGrid::create(0.f);
    ramp->setName("ramp");
    auto up = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    up->setName("up");
    auto number = openvdb::Int32Grid::create(0);
    number->setName("number");
    for (auto it = exemplar.grid->cbeginValueOn(); it; ++it) {
        ramp->tree().setValueOn(it.getCoord(), float(it.getCoord().x()));
        up->tree().setValueOn(it.getCoord(), openvdb::Vec3f(0, 0, 2));
        number->tree().setValueOn(it.getCoord(), it.getCoord().x());
    }
    exemplar.attributes = {ramp, up, number};
    const SynthOptions copying = sized(2, 1.5, 1);
    SynthOptions blending = copying;
    blending.carried = AttributeValues::Blended;
    const SynthResult copies = synthesize(exemplar, copying), blends = synthesize(exemplar, blending);
    REQUIRE(blends.model.attributes.size() == 3);
    const auto copied = openvdb::gridPtrCast<openvdb::FloatGrid>(copies.model.attributes[0]),
               blended = openvdb::gridPtrCast<openvdb::FloatGrid>(blends.model.attributes[0]);
    CHECK(copied->activeVoxelCount() == blended->activeVoxelCount());
    std::size_t means = 0;
    for (auto it = blended->cbeginValueOn(); it; ++it) {
        const openvdb::Coord c = it.getCoord();
        means += std::abs(*it - std::round(*it)) > 1e-3f ? 1 : 0;
        // By hand: no voxel of the ramp is off, so a mean over the voters' own places, where all are active.
        double sum = 0, total = 0;
        bool all = true;
        for (const Source& source : votingSources(blends.map, {c.x(), c.y(), c.z()})) {
            const Index3 from = nearestVoxel(source);
            const openvdb::Coord place(from.x, from.y, from.z);
            all = all && ramp->tree().isValueOn(place);
            sum += double(source.weight) * from.x;
            total += double(source.weight);
        }
        if (all) REQUIRE(double(*it) == Approx(sum / total).margin(1e-3));
    }
    CHECK(means > 100);
    const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(blends.model.attributes[1]);
    for (auto it = vectors->cbeginValueOn(); it; ++it)
        REQUIRE((*it - openvdb::Vec3f(0, 0, 2)).length() < 1e-5f);
    const auto integers = openvdb::gridPtrCast<openvdb::Int32Grid>(blends.model.attributes[2]),
               same = openvdb::gridPtrCast<openvdb::Int32Grid>(copies.model.attributes[2]);
    for (auto it = integers->cbeginValueOn(); it; ++it) REQUIRE(*it == same->tree().getValue(it.getCoord()));
    RepeatOptions repeating;
    repeating.carried = AttributeValues::Blended;
    const LevelSet again = repeatMap(blends.map, {&exemplar}, repeating);
    const auto repeated = openvdb::gridPtrCast<openvdb::FloatGrid>(again.attributes[0]);
    for (auto it = blended->cbeginValueOn(); it; ++it)
        REQUIRE(repeated->tree().getValue(it.getCoord()) == *it);
}

TEST_CASE("synthesize: no part is smaller than the exemplar's smallest", "[pipeline][property]") {
    for (const char* kind : {"balls", "chainmail"}) {
        INFO(kind);
        const LevelSet exemplar = made(kind, 48);
        const auto parts = [](const LevelSet& model) {
            const IndexBox& box = model.domain;
            return findComponents(Occupancy::fromField(gatherBricks(
                                      *model.grid, box, float(1 / voxelSizeOf(*model.grid)), 3.f)),
                                  Neighbours::All);
        };
        const Components of = parts(exemplar);
        // Half a block a side is the largest island.
        std::uint64_t least = 8 * 8 * 8;
        if (!of.interior.empty()) least = std::min(least, of.interior.back());
        for (std::uint64_t seed : {1, 2, 3}) {
            RunContext ctx;
            ctx.seed = seed;
            const Components made = parts(synthesize(exemplar, sized(2, 2, 1), ctx).model);
            REQUIRE_FALSE(made.sizes.empty());
            if (!made.interior.empty()) CHECK(made.interior.back() >= least);
        }
    }
}

TEST_CASE("synthesize: same bits for any number of threads", "[pipeline][determinism]") {
    const LevelSet exemplar = made("fibres");
    const auto run = [&](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        return levelSetHash(*synthesize(exemplar, sized(1.5, 2, 1), ctx).model.grid);
    };
    CHECK(run(1) == run(2));
}

TEST_CASE("synthesize: too small, too large, terabytes, cancelled", "[pipeline][error][cancel]") {
    const LevelSet exemplar = made("grid");
    CHECK(test::contains(test::thrownBy([&] { synthesize(exemplar, sized(0.5, 1, 1)); }).message,
                         "smaller than the exemplar's domain (40)"));
    SynthOptions options = sized(2, 2, 2);
    options.block = 64;
    CHECK(test::thrownBy([&] { synthesize(exemplar, options); }).code == int(ErrorCode::Unusable));
    RunContext ctx;
    ctx.maxMemory = 2000000000;
    CHECK(test::thrownBy([&] { synthesize(exemplar, sized(1000, 1000, 1000), ctx); }).code ==
          int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { synthesize(exemplar, sized(2, 2, 2), ctx); }).code ==
          int(ErrorCode::Cancelled));
}
