#include "libvdbsynth/render/slice.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

const std::uint8_t* pixelAt(const Picture& picture, int x, int y) {
    return &picture.pixels[std::size_t(y * picture.width + x) * 3];
}

bool isWarm(const Picture& picture, int x, int y) {
    return pixelAt(picture, x, y)[0] > pixelAt(picture, x, y)[2] + 8;
}

}  // namespace

TEST_CASE("renderSlice: inside is warm, outside cool, the zero level black", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.5, 3, "sphere");
    SliceOptions options;
    options.width = options.height = 208;
    const Picture picture = renderSlice(*grid, {{-20, -20, -20}, {19, 19, 19}}, options);
    CHECK(isWarm(picture, 104, 104));
    CHECK_FALSE(isWarm(picture, 4, 4));
    // 5 pixels a voxel, and 20 voxels to the surface from the middle.
    CHECK(int(pixelAt(picture, 206, 101)[0]) < 60);
    RunContext one;
    one.threads = 1;
    CHECK(renderSlice(*grid, {{-20, -20, -20}, {19, 19, 19}}, options, one).pixels == picture.pixels);
}

TEST_CASE("renderSlice: the scale bar is as long as it says", "[vdb][oracle]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.5, 3, "sphere");
    SliceOptions options;
    options.width = options.height = 400;
    const IndexBox box{{-20, -20, -20}, {19, 19, 19}};
    const Picture with = renderSlice(*grid, box, options);
    options.scaleBar = false;
    const Picture without = renderSlice(*grid, box, options);
    // 40 voxels of 0.5 over 400 pixels less 4 %: 0.052 a pixel, so a bar of 5 is 96 pixels.
    int longest = 0;
    for (int y = 300; y < 400; ++y) {
        int run = 0;
        for (int x = 0; x < 400; ++x) {
            const bool dark = pixelAt(with, x, y)[0] < 30 && pixelAt(without, x, y)[0] > 60;
            run = dark ? run + 1 : 0;
            longest = std::max(longest, run);
        }
    }
    CHECK(longest == Approx(96).margin(2));
}

TEST_CASE("roundLength: 1, 2 or 5 times a power of ten", "[render][oracle]") {
    CHECK(roundLength(7) == 5);
    CHECK(roundLength(5) == 5);
    CHECK(roundLength(4.9) == 2);
    CHECK(roundLength(1) == 1);
    CHECK(roundLength(0.3) == Approx(0.2));
    CHECK(roundLength(1999) == 1000);
    CHECK(roundLength(2.1e-7) == Approx(2e-7));
}

TEST_CASE("renderSlice: options out of range are named", "[vdb][error]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 3), 1, 3, "sphere");
    SliceOptions slice;
    slice.fraction = 2;
    CHECK(test::contains(test::thrownBy([&] {
                             renderSlice(*grid, {{0, 0, 0}, {1, 1, 1}}, slice);
                         }).message,
                         "`fraction`"));
}
