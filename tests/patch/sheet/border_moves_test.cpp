#include "libvdbsynth/patch/sheet/border_moves.h"

#include "libvdbsynth/base/random.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("spreadMoves: the first of those near each other stay, with their moves") {
    BorderMoves found{{{0, 0, 0}, {0.5, 0, 0}, {1.2, 0, 0}, {0, 3, 0}},
                      {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}};
    const BorderMoves kept = spreadMoves(found, 1);
    REQUIRE(kept.centres.size() == 3);
    CHECK(kept.moves[0].x == 1);
    CHECK(kept.moves[1].x == 3);
    CHECK(kept.moves[2].x == 4);
    CHECK(spreadMoves({}, 1).centres.empty());
}

TEST_CASE("spreadMoves: of many at most 192, farther apart") {
    BorderMoves found;
    for (std::size_t n = 0; n < 3000; ++n) {
        Random random(1, n);
        found.centres.push_back({random.uniform(0, 40), random.uniform(0, 40), 0});
        found.moves.push_back({});
    }
    const BorderMoves kept = spreadMoves(found, 1);
    CHECK(kept.centres.size() <= 192);
    CHECK(kept.centres.size() > 90);
    for (std::size_t a = 0; a < kept.centres.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) REQUIRE(length(kept.centres[a] - kept.centres[b]) >= 1);
}

TEST_CASE("warpAtBorders: by hand, one centre that moves") {
    const BorderMoves moves{{{0, 0, 0}}, {{0.5, 0, 0}}};
    const BorderWarp warp = warpAtBorders(moves, 4, {{0, 0, 0}, {2, 0, 0}, {9, 0, 0}});
    REQUIRE(warp.places.size() == 3);
    CHECK(warp.warped);
    CHECK_FALSE(warp.shrunk);
    CHECK(warp.centres == 1);
    // Of 0.5 the smoothing leaves 0.5 / 1.02; half the radius away phi is 0.1875.
    const double moved = 0.5 / 1.02;
    CHECK(warp.places[0].place.x == Approx(moved));
    CHECK(warp.places[1].place.x == Approx(2 + 0.1875 * moved));
    CHECK(warp.places[2].place.x == 9);
    CHECK(warp.before == Approx(1));
    CHECK(warp.after == Approx(1 - 2 * moved));
}

TEST_CASE("warpAtBorders: a move that folds is shrunk, and said to be") {
    const BorderMoves moves{{{0, 0, 0}}, {{3, 0, 0}}};
    std::vector<Vec3d> places;
    for (int n = -20; n <= 20; ++n) places.push_back({0.1 * n, 0, 0});
    const BorderWarp warp = warpAtBorders(moves, 2, places);
    CHECK(warp.warped);
    CHECK(warp.shrunk);
    for (const WarpedPlace& warped : warp.places) CHECK(determinant(warped.jacobian) > 0.2);
}

TEST_CASE("warpAtBorders: without moves or a radius all stay") {
    const BorderMoves moves{{{0, 0, 0}}, {{0.5, 0, 0}}};
    for (const BorderWarp& warp : {warpAtBorders({}, 4, {{1, 2, 3}}), warpAtBorders(moves, 0, {{1, 2, 3}})}) {
        CHECK_FALSE(warp.warped);
        CHECK(warp.centres == 0);
        REQUIRE(warp.places.size() == 1);
        CHECK(warp.places[0].place.x == 1);
        CHECK(determinant(warp.places[0].jacobian) == 1);
    }
}
