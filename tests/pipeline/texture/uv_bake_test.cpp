#include "libvdbsynth/pipeline/texture/uv_bake.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("withoutTile: what stands before the tile's word") {
    CHECK(withoutTile("height.<UDIM>") == "height.");
    CHECK(withoutTile("height") == "height");
}

TEST_CASE("bakeOntoUv: pixels of a triangle, padding around, nothing beyond") {
    const test::TemporaryFolder folder;
    const std::vector<Triangle> triangles{{0, 1, 2}};
    const std::vector<float> uv{0.25f, 0.25f, 0.75f, 0.25f, 0.25f, 0.75f};
    OutputSet outputs;
    const std::string path = folder.path("out.exr");
    CHECK(bakeOntoUv(
              {"test", triangles, uv}, path, {64, 8, 1},
              [](std::size_t, const BakeWeights& w, float* out) { out[0] = 1 + w[1]; }, outputs) == 1);
    outputs.commit();
    const Raster raster = readRaster(path);
    REQUIRE(raster.size.x == 64);
    const auto at = [&](int x, int y) { return double(raster.values[std::size_t(y * 64 + x)]); };
    // Row 0 is the top; the triangle's right angle is at a quarter from the lower left.
    CHECK(at(16, 47) == Approx(1 + 0.5 / 32).margin(1e-4));
    CHECK(at(30, 47) == Approx(1 + 14.5 / 32).margin(1e-4));
    CHECK(at(12, 47) > 0);  // padding
    CHECK(at(2, 47) == 0);
    CHECK(at(60, 10) == 0);

    const std::vector<float> far{3, 3, 4, 3, 3, 4};
    OutputSet none;
    CHECK_THROWS_AS(bakeOntoUv(
                        {"test", triangles, far}, path, {64, 8, 1},
                        [](std::size_t, const BakeWeights&, float* out) { out[0] = 1; }, none),
                    Error);
}
