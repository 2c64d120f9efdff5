#include "tools/vdb_synth/progress.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;
using namespace vdbsynth::cli;

TEST_CASE("a line says the stage, its share and how long it still takes", "[tools]") {
    CHECK(progressText({"sweep", 1, 2}, 20) == "sweep, 50 %, 20 s left");
    CHECK(progressText({"sweep", 1, 4}, 100) == "sweep, 25 %, 5 min left");
    CHECK(progressText({"sweep", 1, 100}, 100) == "sweep, 1 %");
    CHECK(progressText({"sweep\n", 2, 2}, 100).find('\n') == std::string::npos);
}

TEST_CASE("stages are recorded in order, one that continues once", "[tools]") {
    ProgressLog log(ProgressStyle::Off);
    for (const char* stage : {"a", "a", "b"}) log.update({stage, 1, 2});
    const std::vector<StageRecord>& stages = log.finish();
    REQUIRE(stages.size() == 2);
    CHECK(stages[0].name == "a");
    CHECK(stages[1].name == "b");
    CHECK(stages[1].peakBytes > 0);
}
