#include "libvdbsynth/pipeline/match/match.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

LevelSet made(const char* kind, std::uint64_t seed) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = 40;
    RunContext ctx;
    ctx.seed = seed;
    return makeModel(options, ctx);
}

}  // namespace

TEST_CASE("matchModel: a block of the exemplar finds itself at cost 0", "[pipeline][property]") {
    const LevelSet model = made("sponge", 1);
    MatchOptions options;
    options.block = 12;
    options.at = {9, 21, 14};
    options.count = 3;
    const MatchResult result = matchModel(model, model, options);
    REQUIRE(result.matches.size() == 3);
    CHECK(result.matches[0].position == options.at);
    CHECK(result.matches[0].cost == 0);
    CHECK(result.matches[1].cost > 0);
    CHECK(result.known == 12 * 12 * 12);
}

TEST_CASE("matchModel: under a mask only its samples count", "[pipeline][property]") {
    const LevelSet model = made("balls", 1), query = made("balls", 2);
    MatchOptions options;
    options.block = 8;
    options.at = {16, 16, 16};
    const double all = matchModel(model, query, options).matches[0].cost;
    options.mask = boxMask({{16, 16, 16}, {19, 23, 23}}, 1);
    const MatchResult masked = matchModel(model, query, options);
    CHECK(masked.known == 4 * 8 * 8);
    CHECK(masked.matches[0].cost < all);
    options.mask = boxMask({{0, 0, 0}, {1, 1, 1}}, 1);
    CHECK(test::contains(test::thrownBy([&] { matchModel(model, query, options); }).message, "`mask`"));
}

TEST_CASE("matchModel: a mask of other voxels, or a solid of any band", "[pipeline][property]") {
    const LevelSet model = made("balls", 1), query = made("balls", 2);
    MatchOptions options;
    options.block = 8;
    options.at = {16, 16, 16};
    options.mask = boxMask({{32, 32, 32}, {39, 47, 47}}, 0.5);
    CHECK(matchModel(model, query, options).known == 4 * 8 * 8);
    for (const float voxel : {0.5f, 1.37f})
        for (const float band : {2.f, 8.f}) {
            options.mask = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                3.2f, openvdb::Vec3f(20, 20, 20), voxel, band);
            // Places whole numbers apart with x^2 + y^2 + z^2 <= 10, but those on the ball's own facets.
            const std::size_t known = matchModel(model, query, options).known;
            CHECK(known >= 123);
            CHECK(known <= 147);
        }
}

TEST_CASE("matchModel: bad options are named", "[pipeline][error]") {
    const LevelSet model = made("grid", 1);
    MatchOptions options;
    options.block = 2;
    CHECK(test::contains(test::thrownBy([&] { matchModel(model, model, options); }).message, "`block` 2"));
    options.block = 41;
    CHECK(test::thrownBy([&] { matchModel(model, model, options); }).code == int(ErrorCode::Unusable));
    options.block = 16;
    options.at = {500, 0, 0};
    CHECK(test::contains(test::thrownBy([&] { matchModel(model, model, options); }).message,
                         "outside the query's domain"));
    options.at = {0, 0, 0};
    options.count = 0;
    CHECK(test::contains(test::thrownBy([&] { matchModel(model, model, options); }).message, "`count` 0"));
}
