#include "libvdbsynth/pipeline/patch/patch.h"

#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/patch_sources.h"
#include "tests/support/said.h"

using namespace vdbsynth;

TEST_CASE("makePatchSheet: points reach beyond the sheet on all sides", "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource();
    PatchOptions options;
    options.width = 60;
    options.depth = 50;
    const PatchSheet sheet = makePatchSheet(source, options);
    CHECK(sheet.width == 60);
    CHECK(sheet.border > 0);
    float low = 0, high = 0;
    for (const Vec3f& point : sheet.result.sheet.points) {
        low = std::min(low, point.x);
        high = std::max(high, point.x);
    }
    CHECK(double(low) < -0.9 * sheet.border);
    CHECK(double(high) > 60 + 0.9 * sheet.border);
}

TEST_CASE("makePatchSheet: a tile is a whole number of steps, said", "[pipeline][patch]") {
    const PatchSource source = test::eggCrateSource();
    PatchOptions options;
    options.width = 60.3;
    options.depth = 50;
    options.tile = true;
    test::Said said;
    const PatchSheet sheet = makePatchSheet(source, options, said.ctx);
    const double step = sheet.result.step;
    CHECK(std::abs(sheet.width / step - std::round(sheet.width / step)) < 1e-9);
    CHECK(said.noted("to tile"));
}

TEST_CASE("makePatchSheet: a bad option is refused before any work", "[pipeline][patch]") {
    PatchOptions options;
    CHECK(test::contains(test::thrownBy([&] { makePatchSheet(test::eggCrateSource(), options); }).message,
                         "`size`"));
}
