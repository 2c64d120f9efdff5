#include "libvdbsynth/vdb/level_set.h"

#include <catch2/catch.hpp>

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <functional>

#include "tests/support/comma_locale.h"

using namespace vdbsynth;

namespace {

FloatGridPtr ball() {
    return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.f, openvdb::Vec3f(0.f), 1.f, 3.f);
}

std::string hashAfter(const std::function<void(openvdb::FloatGrid&)>& change) {
    const FloatGridPtr grid = ball();
    change(*grid);
    return levelSetHash(*grid);
}

}  // namespace

TEST_CASE("levelSetHash: the same grid has the same hash, whatever its name and metadata",
          "[vdb][property]") {
    const std::string hash = levelSetHash(*ball());
    CHECK(hash.size() == 32);
    CHECK(levelSetHash(*ball()) == hash);
    CHECK(levelSetHash(*ball()->deepCopy()) == hash);
    CHECK(hashAfter([](auto& grid) {
              grid.setName("other");
              grid.insertMeta("note", openvdb::StringMetadata("x"));
          }) == hash);
    // A leaf that holds nothing but background.
    CHECK(hashAfter([](auto& grid) {
              grid.tree().touchLeaf(openvdb::Coord(400, 0, 0));
              grid.tree().prune();
          }) == hash);
}

TEST_CASE("levelSetHash: a value, an active state, a tile, the background or the transform change it",
          "[vdb][property]") {
    const std::string hash = levelSetHash(*ball());
    const openvdb::Coord on(6, 0, 0), off(0, 0, 0);
    const std::pair<const char*, std::function<void(openvdb::FloatGrid&)>> changes[] = {
        {"value", [&](auto& grid) { grid.tree().setValue(on, 0.125f); }},
        {"value of an inactive voxel",
         [&](auto& grid) { grid.tree().setValueOff(openvdb::Coord(1, 1, 1), -1.f); }},
        {"topology", [&](auto& grid) { grid.tree().setActiveState(on, false); }},
        {"topology of a leaf", [&](auto& grid) { grid.tree().setActiveState(off, true); }},
        {"tile", [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 0, 0), -3.f, false); }},
        {"active tile", [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 0, 0), 3.f, true); }},
        {"place of a tile",
         [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 8, 0), -3.f, false); }},
        {"value of a tile",
         [&](auto& grid) { grid.tree().addTile(1, openvdb::Coord(64, 0, 0), -2.f, false); }},
        {"background", [&](auto& grid) { grid.tree().root().setBackground(4.f, false); }},
        {"voxel size",
         [&](auto& grid) { grid.setTransform(openvdb::math::Transform::createLinearTransform(0.5)); }},
        {"place in the world",
         [&](auto& grid) { grid.transform().postTranslate(openvdb::Vec3d(0, 0, 1e-9)); }},
    };
    std::vector<std::string> seen{hash};
    for (const auto& [what, change] : changes) {
        CAPTURE(what);
        const std::string changed = hashAfter(change);
        CHECK(std::find(seen.begin(), seen.end(), changed) == seen.end());
        seen.push_back(changed);
    }
}

TEST_CASE("boxText, parseBox: a box comes back, in a host with a decimal comma too", "[vdb][property]") {
    const IndexBox box{{-1234567, 0, 5}, {1234567, 268435456, 5}};
    const auto check = [&] {
        CHECK(boxText(box) == "-1234567,0,5,1234567,268435456,5");
        IndexBox back;
        CHECK(parseBox(boxText(box), back));
        CHECK(back == box);
    };
    check();
    const test::CommaLocale host;
    check();
}

TEST_CASE("parseBox: what is not six numbers in order is refused and changes nothing", "[vdb][error]") {
    IndexBox box{{1, 2, 3}, {4, 5, 6}};
    for (const char* text : {"", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,6,", "1,2,3,4,5,6 ", " 1,2,3,4,5,6",
                             "1,2,3,0,5,6", "1,2,3,4,5,4294967302", "1,2,3,4,5,268435457",
                             "-268435457,2,3,4,5,6", "1,2,,4,5,6", "1.0,2,3,4,5,6"}) {
        CAPTURE(text);
        CHECK_FALSE(parseBox(text, box));
        CHECK(box == IndexBox{{1, 2, 3}, {4, 5, 6}});
    }
}
