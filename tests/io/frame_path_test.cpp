#include "libvdbsynth/io/frame_path.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("atFrame: signs and printf's form, as many digits at least", "[io]") {
    CHECK(atFrame("a/shot.####.vdb", 7) == "a/shot.0007.vdb");
    CHECK(atFrame("shot#.vdb", 12) == "shot12.vdb");
    CHECK(atFrame("shot_%04d.vdb", 12) == "shot_0012.vdb");
    CHECK(atFrame("shot%d.vdb", 12) == "shot12.vdb");
    CHECK(atFrame("shot.####.vdb", 123456) == "shot.123456.vdb");
    CHECK(atFrame("plain.vdb", 3) == "plain.vdb");
}

TEST_CASE("namesFrames: a place for a number, and no other sign of per cent", "[io]") {
    CHECK(namesFrames("turn.####.png"));
    CHECK(namesFrames("%3d.obj"));
    CHECK_FALSE(namesFrames("100%done.vdb"));
    CHECK_FALSE(namesFrames("plain.vdb"));
    CHECK_FALSE(namesFrames(""));
}
