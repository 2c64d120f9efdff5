// Level sets as clip tools leave them: the band ends at a box, and nothing says what lies beyond.
#include <openvdb/tools/Clip.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/read/level_set_repair.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/vdb/read/fields.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace vdbsynth;
using openvdb::FloatGrid;

namespace {

// Sheets that curve through all of space: in every box the solid is cut by all six faces.
double gyroid(const openvdb::Vec3d& p) {
    const openvdb::Vec3d q = p * 0.4;
    return (std::sin(q.x()) * std::cos(q.y()) + std::sin(q.y()) * std::cos(q.z()) +
            std::sin(q.z()) * std::cos(q.x())) /
           (1.5 * 0.4);
}

double rock(const openvdb::Vec3d& p) {
    return p.length() - 30 + 3 * std::sin(p.x() * 0.4) * std::sin(p.y() * 0.3) * std::sin(p.z() * 0.35);
}

double ground(const openvdb::Vec3d& p) {
    return p.z() - 4 * std::sin(p.x() * 0.2) * std::sin(p.y() * 0.15);
}

FloatGrid::Ptr bandOf(double (*field)(const openvdb::Vec3d&), int reach) {
    return test::bandGrid(field, reach, 0.1);
}

LevelSet read(const FloatGrid::Ptr& grid, std::string* said = nullptr) {
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) {
        if (said) *said += text + "\n";
    };
    return modelFromGrids("a.vdb", {grid}, {}, ctx);
}

// Voxels of a box inside the solid, by the unclipped field.
double solidIn(double (*field)(const openvdb::Vec3d&), const openvdb::CoordBBox& box) {
    double count = 0;
    for (auto it = box.begin(); it; ++it) count += field((*it).asVec3d()) < 0 ? 1 : 0;
    return count;
}

std::size_t openEdges(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    const auto take = [&](std::uint32_t a, std::uint32_t b) { ++edges[std::minmax(a, b)]; };
    for (const auto& f : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) take(f[i], f[(i + 1) % 3]);
    for (const auto& f : mesh.quads)
        for (std::size_t i = 0; i < 4; ++i) take(f[i], f[(i + 1) % 4]);
    std::size_t open = 0;
    for (const auto& [edge, count] : edges) open += count == 1 ? 1 : 0;
    return open;
}

FloatGrid::Ptr activeOnly(const FloatGrid& grid, const openvdb::CoordBBox& box) {
    const auto kept = FloatGrid::create(grid.background());
    kept->setTransform(grid.transform().copy());
    kept->setGridClass(grid.getGridClass());
    for (auto it = grid.cbeginValueOn(); it; ++it)
        if (box.isInside(it.getCoord())) kept->tree().setValueOn(it.getCoord(), *it);
    return kept;
}

// The three ways to clip.
FloatGrid::Ptr clippedBy(int way, const FloatGrid& grid, const openvdb::CoordBBox& box) {
    if (way == 0) return activeOnly(grid, box);
    const auto copy = grid.deepCopy();
    if (way == 1) {
        copy->clip(box);
        return copy;
    }
    const auto mask = openvdb::MaskGrid::create(false);
    mask->setTransform(grid.transform().copy());
    mask->denseFill(box, true, true);
    return openvdb::tools::clip(*copy, *mask);
}

}  // namespace

TEST_CASE("repairedField: what clip tools cut open is capped, whichever of them it was", "[vdb][property]") {
    struct Case {
        const char* name;
        double (*field)(const openvdb::Vec3d&);
        int reach;
        openvdb::CoordBBox box;
        const char* faces;
        bool deep = false;  // one side is amid the solid, away from its band
    };
    const char* all = "low x, high x, low y, high y, low z, high z";
    const std::vector<Case> cases{
        {"gyroid", gyroid, 40, {{-20, -17, -23}, {20, 21, 19}}, all},
        {"rock", rock, 40, {{-10, -40, -12}, {15, 40, 14}}, "low x, high x, low z, high z"},
        {"half", rock, 40, {{-40, -40, -40}, {40, 40, 7}}, "high z"},
        {"corner", rock, 40, {{5, 5, 5}, {40, 40, 40}}, "low x, low y, low z"},
        {"core", rock, 40, {{-9, -9, -9}, {9, 9, 40}}, "low x, high x, low y, high y, low z", true},
        {"ground", ground, 30, {{-24, -24, -12}, {25, 22, 12}}, "low x, high x, low y, high y, low z", true}};
    for (const Case& c : cases)
        for (int way = 0; way < 3; ++way) {
            const auto whole = bandOf(c.field, c.reach);
            const auto clipped = clippedBy(way, *whole, c.box);
            if (clipped->activeVoxelCount() == 0) continue;
            std::string said;
            const LevelSet model = read(clipped, &said);
            INFO(c.name << " way " << way << "\n" << said);
            // Where only the band is left, nothing tells how deep the solid goes beneath it.
            if (way > 0 || !c.deep) {
                CHECK(solidVoxels(*model.grid) == solidIn(c.field, c.box));
                CHECK(test::contains(said, std::string("cut open at ") + c.faces));
            }
            CHECK(openEdges(levelSetToMesh(*model.grid)) == 0);
            CHECK(measureBand(*model.grid).missingNeighbours == 0);
            CHECK(std::count(said.begin(), said.end(), '\n') == 1);
        }
}

TEST_CASE("repairedField: a few solids of many cut open are not left hollow", "[vdb][property]") {
    const auto balls = [](const openvdb::Vec3d& p) {
        openvdb::Vec3d q;
        for (int i = 0; i < 3; ++i) q[i] = p[i] - 14 * std::round(p[i] / 14);
        return std::max(q.length() - 6,
                        std::abs(p.x()) > 21 && std::abs(p.y()) > 7 ? 20 - q.length() : -99.0);
    };
    const openvdb::CoordBBox box({-50, -50, -50}, {28, 50, 50});
    const auto grid = activeOnly(*test::bandGrid(balls, 40, 0.1), box);
    std::string said;
    const LevelSet model = read(grid, &said);
    INFO(said);
    double solid = 0;
    for (auto it = openvdb::CoordBBox({-40, -40, -40}, {28, 40, 40}).begin(); it; ++it)
        solid += balls((*it).asVec3d()) < 0 ? 1 : 0;
    CHECK(solidVoxels(*model.grid) == Approx(solid).epsilon(0.001));
}

TEST_CASE("modelFromGrids: a cut-open level set is a texture whose domain ends at the cuts",
          "[vdb][property]") {
    const auto whole = bandOf(gyroid, 40);
    const openvdb::CoordBBox box({-20, -17, -23}, {20, 21, 19});
    const LevelSet cut = read(clippedBy(0, *whole, box));
    CHECK(cut.domainRecorded);
    CHECK(cut.domain == IndexBox{{-20, -17, -23}, {20, 21, 19}});
    // Cut at one side only: air stays around the others, so that those faces are no cuts.
    const LevelSet part = read(clippedBy(1, *bandOf(rock, 40), {{-40, -40, -40}, {40, 40, 7}}));
    const IndexBox solid = solidBox(*part.grid, "it");
    CHECK(part.domainRecorded);
    CHECK(part.domain.max.z == 7);
    CHECK((part.domain.min.z < solid.min.z && part.domain.min.x < solid.min.x &&
           part.domain.max.x > solid.max.x));
    // A clip of a model that records a domain: the domain ends at the clip.
    const auto recorded = bandOf(gyroid, 40);
    recorded->insertMeta(kDomainKey, openvdb::StringMetadata("-40,-17,-30,40,21,30"));
    const auto clipped = recorded->deepCopy();
    clipped->clip(box);
    CHECK(read(clipped).domain == IndexBox{{-20, -17, -23}, {20, 21, 19}});
    // An object stays an object, and so does one with a hole that is no plane.
    CHECK_FALSE(read(bandOf(rock, 40)).domainRecorded);
    const auto bitten = bandOf(rock, 40);
    for (auto it = bitten->beginValueAll(); it; ++it)
        if ((it.getCoord().asVec3d() - openvdb::Vec3d(0, 0, 30)).length() < 14) {
            it.setValue(bitten->background());
            it.setActiveState(false);
        }
    const LevelSet eaten = read(bitten);
    CHECK_FALSE(eaten.domainRecorded);
    CHECK(openEdges(levelSetToMesh(*eaten.grid)) == 0);
}
