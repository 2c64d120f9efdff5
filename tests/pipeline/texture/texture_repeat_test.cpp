#include "libvdbsynth/pipeline/texture/texture_repeat.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/pipeline/texture/texture_outputs.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture_makers.h"

using namespace vdbsynth;

namespace {

void write(const TextureShape& shape, const TextureResult& result, const TextureSample& sample,
           const std::string& path) {
    OutputSet outputs;
    writeTextured(shape, result, {sample}, {path}, {}, outputs);
    outputs.commit();
}

std::string squareMap(const test::TemporaryFolder& folder, const TextureSample& sample) {
    const TextureShape shape = test::shapeOf(test::squareMesh(9));
    write(shape, test::flatResult(shape, sample), sample, folder.path("map.ply"));
    return folder.path("map.ply");
}

}  // namespace

TEST_CASE("repeatTexture: the run's own sample gives the same file", "[pipeline]") {
    const test::TemporaryFolder folder;
    const TextureSample sample = test::rampSample(16, 16, 1);
    const std::string path = squareMap(folder, sample);
    CHECK(isTextureMap(path));
    TextureMap map = readTextureMap(path);
    CHECK(map.result.texel == 1);
    REQUIRE(map.samples.size() == 1);
    CHECK(map.samples[0].name == "ramp.png");
    CHECK(map.maps == std::vector<std::string>{"map0"});
    std::vector<TextureSample> samples{sample};
    repeatTexture(map, samples);
    write(map.shape, map.result, samples[0], folder.path("again.ply"));
    CHECK(test::contentOf(folder.path("again.ply")) == test::contentOf(path));
}

TEST_CASE("repeatTexture: a sample of another size is read at scaled coordinates", "[pipeline]") {
    const test::TemporaryFolder folder;
    TextureMap map = readTextureMap(squareMap(folder, test::rampSample(16, 16, 1)));
    CHECK(map.result.smooth);
    std::vector<TextureSample> samples{test::rampSample(32, 32)};
    test::Said said;
    repeatTexture(map, samples, said.ctx);
    CHECK(said.noted("scaled by 2 and 2"));
    CHECK(said.noted("its map map0 is left out"));
    CHECK(map.result.texel == 0.5);
    for (std::size_t i = 0; i < map.shape.site.size(); ++i) {
        if (map.shape.site[i].x < 1 || map.shape.site[i].x > 7) continue;
        REQUIRE(double(map.result.sites.values[3 * i]) ==
                Approx(double(map.shape.site[i].x) / 16).margin(0.01));
    }
    samples.push_back(samples[0]);
    CHECK(test::thrownBy([&] { repeatTexture(map, samples); }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("readTextureMap: what texture did not write is an error", "[pipeline][error]") {
    const test::TemporaryFolder folder;
    writeMesh(folder.path("plain.ply"), MeshFormat::Ply, test::boxMesh({0, 0, 0}, {1, 1, 1}));
    CHECK_FALSE(isTextureMap(folder.path("plain.ply")));
    CHECK_FALSE(isTextureMap("a.obj"));
    CHECK(test::thrownBy([&] { readTextureMap(folder.path("plain.ply")); }).code == int(ErrorCode::BadData));
    const std::string good = test::contentOf(squareMap(folder, test::rampSample(16, 16)));
    const auto thrownWith = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        folder.write("bad.ply", text);
        return test::thrownBy([&] { readTextureMap(folder.path("bad.ply")); }).code;
    };
    CHECK(thrownWith("property float source_u", "property float source_x") == int(ErrorCode::BadData));
    CHECK(thrownWith("sample 16", "sample -1") == int(ErrorCode::BadData));
    CHECK(thrownWith("texel 1", "texel x") == int(ErrorCode::BadData));
}

TEST_CASE("sampleComments: a line for each sample, map and the texel", "[pipeline][fast]") {
    TextureResult result;
    result.texel = 0.5;
    result.smooth = false;
    CHECK(sampleComments(result, {test::rampSample(4, 6, 1)}) ==
          std::vector<std::string>{"vdbsynth:texel 0.5", "vdbsynth:reading nearest",
                                   "vdbsynth:sample 4 6 mirror ramp.png", "vdbsynth:map map0"});
}
