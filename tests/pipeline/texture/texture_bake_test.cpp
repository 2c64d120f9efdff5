#include "libvdbsynth/pipeline/texture/texture_bake.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>

#include "libvdbsynth/io/raster_file.h"
#include "tests/support/contexts.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture_makers.h"

using namespace vdbsynth;

namespace {

// The picture that a square of 8 units over the whole of its own coordinates bakes to.
Raster baked(const TextureShape& shape, const TextureSample& sample, const std::string& name, int size,
             int bits, const RunContext& ctx = {}) {
    const test::TemporaryFolder folder;
    OutputSet outputs;
    bakeTexture(shape, test::flatResult(shape, sample), {sample}, folder.path(name), size, bits, outputs,
                ctx);
    outputs.commit();
    return readRaster(folder.path(name));
}

}  // namespace

TEST_CASE("bakeTexture: a flat square bakes to the sample itself", "[pipeline]") {
    const TextureShape shape = test::shapeOf(test::squareMesh(9));
    const TextureSample sample = test::rampSample(8, 8);
    const Raster picture = baked(shape, sample, "a.exr", 32, 8);
    REQUIRE(picture.size.x == 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 2; x < 30; ++x) {
            const float* rgb = &picture.values[3 * picture.index(x, y, 0)];
            REQUIRE(double(rgb[0]) == Approx((x + 0.5) / 32).margin(0.02));  // u is x
            if (y > 1 && y < 30) REQUIRE(double(rgb[1]) == Approx(1 - (y + 0.5) / 32).margin(0.02));
        }
    CHECK(baked(shape, sample, "a.png", 32, 16).white == 65535);
    CHECK(baked(shape, sample, "a.png", 32, 8).white == 255);
}

TEST_CASE("bakeTexture: charts are padded, the rest is black", "[pipeline]") {
    Mesh mesh = test::squareMesh(9);
    for (float& uv : mesh.attributes[0].values) uv = 0.4f + 0.2f * uv;
    TextureSample sample = test::rampSample(8, 8);
    std::fill(sample.image.values.begin(), sample.image.values.end(), 0.5f);
    const Raster picture = baked(test::shapeOf(mesh), sample, "a.exr", 100, 8);
    const auto at = [&](int x, int y) { return picture.values[3 * picture.index(x, y, 0)]; };
    CHECK(at(50, 50) == Approx(0.5));
    CHECK(at(40 - kBakePadding, 50) == Approx(0.5));
    CHECK(at(59 + kBakePadding, 50) == Approx(0.5));
    CHECK(at(40 - kBakePadding - 1, 50) == 0);
    CHECK(at(0, 0) == 0);
}

TEST_CASE("bakeTexture: normals turn with the target's coordinates", "[pipeline]") {
    Mesh mesh = test::squareMesh(9);
    // The target's own coordinates run a quarter turn ahead: its u is y, its v is -x.
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        mesh.attributes[0].values[2 * i] = mesh.points[i].y / 8;
        mesh.attributes[0].values[2 * i + 1] = 1 - mesh.points[i].x / 8;
    }
    TextureSample sample = test::rampSample(8, 8);
    sample.maps.push_back({"normal", 3, 3, 255});
    sample.image.channels = 6;
    sample.image.values.clear();
    for (int i = 0; i < 64; ++i)  // tilted by 0.6 towards +u of the sample, x
        sample.image.values.insert(sample.image.values.end(), {0, 0, 0, 0.8f, 0.5f, 0.9f});
    const Raster picture = baked(test::shapeOf(mesh), sample, "n_normal.exr", 16, 8);
    const float* n = &picture.values[3 * picture.index(8, 8, 0)];
    CHECK(n[0] == Approx(0.5).margin(1e-4));  // nothing along the target's u
    CHECK(n[1] == Approx(0.2).margin(1e-4));  // x is its -v
    CHECK(n[2] == Approx(0.9));
}

TEST_CASE("bakedMap: the name's end chooses the map", "[pipeline][fast]") {
    TextureSample sample = test::rampSample(4, 4);
    sample.maps.push_back({"roughness", 3, 1, 255});
    CHECK(bakedMap("a/steel_roughness.png", sample).name == "roughness");
    CHECK(bakedMap("roughness.<UDIM>.exr", sample).name == "roughness");
    CHECK(bakedMap("roughness_2.png", sample).name == "Cd");
    CHECK(bakedMap("albedo.png", sample).name == "Cd");
}

TEST_CASE("bakeTexture: a picture for each tile by <UDIM>, else a warning", "[pipeline]") {
    Mesh mesh = test::squareMesh(9);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.attributes[0].values[2 * i] *= 2;
    const TextureShape shape = test::shapeOf(mesh);
    const TextureSample sample = test::rampSample(8, 8);
    const test::TemporaryFolder folder;
    OutputSet outputs;
    bakeTexture(shape, test::flatResult(shape, sample), {sample}, folder.path("a.<UDIM>.exr"), 16, 8,
                outputs);
    outputs.commit();
    CHECK(folder.fileCount() == 2);
    const Raster left = readRaster(folder.path("a.1001.exr")), right = readRaster(folder.path("a.1002.exr"));
    CHECK(left.values[3 * left.index(8, 8, 0)] == Approx(0.25).margin(0.04));
    CHECK(right.values[3 * right.index(8, 8, 0)] == Approx(0.75).margin(0.04));
    test::Said said;
    baked(shape, sample, "b.exr", 16, 8, said.ctx);
    CHECK(said.warned("reach beyond the picture"));
}

TEST_CASE("bakeTexture: no coordinates, none inside, too much memory", "[pipeline][error]") {
    Mesh mesh = test::squareMesh(3);
    const TextureSample sample = test::rampSample(8, 8);
    RunContext little;
    little.maxMemory = 1000;
    CHECK(test::thrownBy([&] { baked(test::shapeOf(mesh), sample, "a.png", 64, 8, little); }).code ==
          int(ErrorCode::Memory));
    for (float& uv : mesh.attributes[0].values) uv += 50;
    CHECK(test::thrownBy([&] { baked(test::shapeOf(mesh), sample, "a.png", 64, 8); }).code ==
          int(ErrorCode::Unusable));
    mesh.attributes.clear();
    CHECK(test::contains(test::thrownBy([&] { baked(test::shapeOf(mesh), sample, "a.png", 64, 8); }).message,
                         "no texture coordinates"));
    const TextureShape shape = test::shapeOf(test::squareMesh(9));
    CHECK(baked(shape, sample, "a.exr", 64, 8, test::onThreads(1)).values ==
          baked(shape, sample, "a.exr", 64, 8, test::onThreads(3)).values);
}
