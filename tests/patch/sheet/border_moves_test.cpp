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
