#include "libvdbsynth/pipeline/fill/fill.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"

#include <cstdlib>

using namespace vdbsynth;

namespace {

// A texture, or an object, of any distances, with the inside of a box taken away.
LevelSet carved(const IndexBox& domain, bool texture, const std::optional<IndexBox>& away,
                const std::function<float(const Index3&)>& distance) {
    openvdb::initialize();
    const BrickField field =
        BrickField::generate(domain.expanded(6), {}, [&](const IndexBox& brick, float* samples) {
            for (int x = brick.min.x; x <= brick.max.x; ++x)
                for (int y = brick.min.y; y <= brick.max.y; ++y)
                    for (int z = brick.min.z; z <= brick.max.z; ++z) {
                        float d = distance({x, y, z});
                        if (away) {
                            float inside = -1e9f;
                            for (int axis = 0; axis < 3; ++axis) {
                                const int c = Index3{x, y, z}[axis];
                                inside = std::max(
                                    {inside, float(away->min[axis] - c), float(c - away->max[axis])});
                            }
                            d = std::max(d, 0.5f - inside);
                        }
                        *samples++ = std::clamp(d, -4.f, 4.f);
                    }
        });
    LevelSet model = modelFromField(field, 4, false, 0, domain, 1, "carved", "");
    model.domainRecorded = texture;
    return model;
}

// Voxels that differ in bits or state beyond the reach of the hole; and how many there are within.
std::pair<std::size_t, std::size_t> changes(const LevelSet& before, const LevelSet& after,
                                            const LevelSet& hole) {
    const auto a = before.grid->getConstAccessor(), b = after.grid->getConstAccessor(),
               h = hole.grid->getConstAccessor();
    std::size_t beyond = 0, within = 0;
    const IndexBox box = before.domain.expanded(8);
    for (int x = box.min.x; x <= box.max.x; ++x)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int z = box.min.z; z <= box.max.z; ++z) {
                const openvdb::Coord c(x, y, z);
                const bool same = a.getValue(c) == b.getValue(c) && a.isValueOn(c) == b.isValueOn(c);
                (h.getValue(c) >= 3 ? beyond : within) += !same;
            }
    return {beyond, within};
}

}  // namespace

TEST_CASE("fillHoles: attributes are kept outside the hole and copied inside it", "[pipeline][property]") {
    const IndexBox domain{{0, 0, 0}, {95, 95, 39}}, box{{36, 40, 8}, {59, 63, 36}};
    LevelSet partial = carved(domain, true, IndexBox{{37, 41, 9}, {58, 62, 35}},
                              [](const Index3& p) { return float(p.z) - 19.7f; });
    auto place = openvdb::Vec3IGrid::create(openvdb::Vec3i(-1));
    place->setName("place");
    for (auto it = partial.grid->cbeginValueOn(); it; ++it)
        place->tree().setValueOn(it.getCoord(), it.getCoord().asVec3i());
    auto old = openvdb::Vec3IGrid::create();
    old->setName("source");
    partial.attributes = {place, old};
    partial.source = std::make_shared<const Mesh>();
    const LevelSet hole = boxHole(partial, box);
    const FillResult result = fillHoles(partial, hole, nullptr);
    REQUIRE(result.model.attributes.size() == 1);
    const std::vector<GridPtr> grids = sourceMapGrids(result.map, *result.model.grid);
    REQUIRE(grids.size() == 5);
    CHECK(result.model.source == nullptr);  // a mesh that has the hole
    const auto carried = openvdb::gridPtrCast<openvdb::Vec3IGrid>(result.model.attributes[0]),
               source = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grids[0]);
    CHECK(source->activeVoxelCount() > 1000);
    std::size_t exact = 0;
    for (auto it = source->cbeginValueOn(); it; ++it) {
        REQUIRE(hole.grid->tree().getValue(it.getCoord()) < 0);
        REQUIRE(hole.grid->tree().getValue(openvdb::Coord(*it)) >= 0);  // from outside the hole
        exact += carried->tree().getValue(it.getCoord()) == *it;
    }
    CHECK(double(exact) > 0.8 * double(source->activeVoxelCount()));
    for (auto it = place->cbeginValueOn(); it; ++it)
        if (hole.grid->tree().getValue(it.getCoord()) > 0)
            REQUIRE(carried->tree().getValue(it.getCoord()) == *it);
}

TEST_CASE("fillHoles: a notch in a slab becomes flat, and all else keeps its bits", "[pipeline][oracle]") {
    const IndexBox domain{{0, 0, 0}, {95, 95, 39}}, box{{36, 40, 8}, {59, 63, 36}};
    const auto slab = [](const Index3& p) { return float(p.z) - 19.7f; };
    const LevelSet partial = carved(domain, true, IndexBox{{37, 41, 9}, {58, 62, 35}}, slab);
    const LevelSet whole = carved(domain, true, std::nullopt, slab);
    const LevelSet hole = boxHole(partial, box);
    const FillResult result = fillHoles(partial, hole, nullptr);
    const auto [beyond, within] = changes(partial, result.model, hole);
    CHECK(beyond == 0);
    CHECK(within > 1000);
    CHECK(result.model.domain == domain);
    CHECK(measureBand(*result.model.grid).missingNeighbours == 0);
    CHECK(summarize(levelSetToMesh(*result.model.grid)).closedManifold());
    const auto filled = result.model.grid->getConstAccessor(), right = whole.grid->getConstAccessor();
    float worst = 0;
    for (int x = 36; x < 60; ++x)
        for (int y = 40; y < 64; ++y)
            for (int z = 17; z < 23; ++z)
                worst = std::max(worst, std::abs(filled.getValue({x, y, z}) - right.getValue({x, y, z})));
    CHECK(worst < 0.25f);
    RunContext one;
    one.threads = 1;
    CHECK(levelSetHash(*fillHoles(partial, hole, nullptr, {}, one).model.grid) ==
          levelSetHash(*result.model.grid));
}

TEST_CASE("fillHoles: a hole in other voxels and of another band, beyond three voxels all bits stay",
          "[pipeline][property]") {
    const IndexBox domain{{0, 0, 0}, {95, 95, 39}};
    const auto slab = [](const Index3& p) { return float(p.z) - 19.7f; };
    const LevelSet partial = carved(domain, true, IndexBox{{40, 44, 12}, {55, 59, 30}}, slab);
    const openvdb::Vec3f middle(47.6f, 51.6f, 20.3f);
    const float radius = 16;
    for (const float voxel : {0.5f, 1.f, 1.37f})
        for (const float band : {2.f, 8.f}) {
            INFO(voxel << " " << band);
            LevelSet hole;
            hole.grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, middle, voxel, band);
            hole.domain = solidBox(*hole.grid, "the hole");
            stampLevelSet(hole);
            const FillResult result = fillHoles(partial, hole, nullptr);
            const auto a = partial.grid->getConstAccessor(), b = result.model.grid->getConstAccessor();
            std::size_t beyond = 0, within = 0;
            forEachVoxel(domain.expanded(8), [&](const Index3& p) {
                const openvdb::Coord c(p.x, p.y, p.z);
                const bool same = a.getValue(c) == b.getValue(c) && a.isValueOn(c) == b.isValueOn(c);
                const bool far = (c.asVec3s() - middle).length() > radius + 3 + 0.1f;
                (far ? beyond : within) += !same;
            });
            CHECK(beyond == 0);
            CHECK(within > 300);
            // The slab is whole again.
            const float level = b.getValue({48, 52, 20});
            CHECK(level == Approx(0.3).margin(0.3));
        }
}

TEST_CASE("fillHoles: what is cut out of a texture is about as full again, from itself or from an exemplar",
          "[pipeline][property]") {
    openvdb::initialize();
    MakeOptions make;
    make.exemplar.kind = "sponge";
    make.exemplar.resolution = 96;
    const LevelSet whole = makeModel(make);
    const IndexBox box{{36, 36, 36}, {59, 59, 59}};
    const BrickField field = gatherBricks(*whole.grid, whole.domain.expanded(6), 1, 3);
    const IndexBox away = box.expanded(-1);
    const LevelSet partial = carved(whole.domain, true, away, [&](const Index3& p) {
        return field.at(p - whole.domain.expanded(6).min);
    });
    RunContext ctx;
    ctx.seed = 5;
    const LevelSet other = makeModel(make, ctx);
    const auto solidShare = [&](const LevelSet& model) {
        const auto values = model.grid->getConstAccessor();
        double solid = 0;
        for (int x = box.min.x; x <= box.max.x; ++x)
            for (int y = box.min.y; y <= box.max.y; ++y)
                for (int z = box.min.z; z <= box.max.z; ++z) solid += values.getValue({x, y, z}) < 0;
        return solid / double(box.volume());
    };
    CHECK(solidShare(partial) < 0.2);
    for (const LevelSet* exemplar : {static_cast<const LevelSet*>(nullptr), &other}) {
        const LevelSet hole = boxHole(partial, box);
        const FillResult result = fillHoles(partial, hole, exemplar);
        CHECK(changes(partial, result.model, hole).first == 0);
        CHECK(solidShare(result.model) == Approx(0.5).margin(0.15));
        const BandQuality band = measureBand(*result.model.grid);
        CHECK(band.gradientErrorMean < 0.05);
        CHECK(band.missingNeighbours == 0);
        if (const char* folder = std::getenv("VDBSYNTH_KEEP"))
            writeVdb(std::string(folder) + (exemplar ? "/other.vdb" : "/own.vdb"), {result.model.grid}, {});
    }
}

TEST_CASE("holesAtOpenEdges: round what closed the loops, and the face of a box with a hole is a face again",
          "[pipeline][property]") {
    openvdb::initialize();
    LevelSet partial;
    partial.grid = meshToLevelSet(test::boxMesh({-30, -30, -14}, {30, 30, 14}), 1, 3, "box");
    partial.domain = solidBox(*partial.grid, "box");
    // The mesh of the same box without what is within 6 of the middle of its top.
    Mesh open = levelSetToMesh(*partial.grid);
    const auto near = [&](std::uint32_t v) { return length(open.points[v] - Vec3f{0, 0, 14}) < 6; };
    open.quads.erase(std::remove_if(open.quads.begin(), open.quads.end(),
                                    [&](const Quad& q) { return near(q[0]) || near(q[2]); }),
                     open.quads.end());
    open.triangles.erase(std::remove_if(open.triangles.begin(), open.triangles.end(),
                                        [&](const Triangle& t) { return near(t[0]) || near(t[1]); }),
                         open.triangles.end());
    partial.source = std::make_shared<const Mesh>(open);
    const LevelSet hole = holesAtOpenEdges(partial);
    CHECK(hole.grid->tree().getValue({0, 0, 14}) < 0);
    CHECK(hole.grid->tree().getValue({0, 0, 15}) < 0);
    CHECK(hole.grid->tree().getValue({0, 0, 5}) == 3.f);
    CHECK(hole.grid->tree().getValue({14, 0, 14}) == 3.f);
    const FillResult result = fillHoles(partial, hole, nullptr);
    CHECK(changes(partial, result.model, hole).first == 0);
    CHECK(solidVoxels(*result.model.grid) == Approx(solidVoxels(*partial.grid)).epsilon(0.005));
    CHECK(summarize(levelSetToMesh(*result.model.grid)).closedManifold());
}

TEST_CASE("fillHoles: nothing to fill, nothing to fill from, no mesh, cancelled",
          "[pipeline][error][cancel]") {
    const IndexBox domain{{0, 0, 0}, {47, 47, 39}};
    const auto slab = [](const Index3& p) { return float(p.z) - 19.7f; };
    const LevelSet partial = carved(domain, true, std::nullopt, slab);
    const auto thrown = [&](const IndexBox& box) {
        return test::thrownBy([&] { fillHoles(partial, boxHole(partial, box), nullptr); });
    };
    const test::Thrown away = thrown({{400, 0, 0}, {420, 20, 20}});
    CHECK(away.code == int(ErrorCode::Unusable));
    CHECK(test::contains(away.message, "outside the model's domain"));
    CHECK(thrown({{-5, -5, -5}, {60, 60, 60}}).code == int(ErrorCode::Unusable));
    CHECK(test::contains(test::thrownBy([&] { holesAtOpenEdges(partial); }).message, "`hole`: needs a mesh"));
    LevelSet closed = partial;
    closed.source = std::make_shared<const Mesh>(test::sphereMesh(5, 1));
    CHECK(test::contains(test::thrownBy([&] { holesAtOpenEdges(closed); }).message, "no open edges"));
    const std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    const LevelSet hole = boxHole(partial, {{20, 20, 10}, {27, 27, 30}});
    CHECK(test::thrownBy([&] { fillHoles(partial, hole, nullptr, {}, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
