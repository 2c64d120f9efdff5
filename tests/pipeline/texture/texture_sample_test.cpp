#include "libvdbsynth/pipeline/texture/texture_sample.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

SampleImage waves(int side, double length) {
    SampleImage image{side, side, 1, false, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            image.values.push_back(
                float(std::sin(6.283185307179586 * x / length) + std::cos(6.283185307179586 * y / length)));
    return image;
}

std::string image(const test::TemporaryFolder& folder, const std::string& name, int width, int height,
                  int channels = 1) {
    std::vector<float> values;
    for (int i = 0; i < width * height * channels; ++i) values.push_back(float(i % 7) / 7);
    writeImagePng(folder.path(name), width, height, channels, 8, values);
    return folder.path(name);
}

}  // namespace

TEST_CASE("borderMismatch: whole waves tile, broken ones do not", "[pipeline][fast]") {
    CHECK(borderMismatch(waves(32, 8)) < kTileableMismatch);
    CHECK(borderMismatch(waves(32, 9.3)) > kTileableMismatch);
    CHECK(borderMismatch({4, 4, 1, false, std::vector<float>(16, 1.f)}) == 0);
    SampleImage step{4, 4, 1, false, std::vector<float>(16, 0.f)};
    step.values = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
    CHECK(borderMismatch(step) > kTileableMismatch);
}

TEST_CASE("readTextureSamples: rows from the bottom, 0 to 1, maps behind the colour", "[pipeline]") {
    const test::TemporaryFolder folder;
    std::vector<float> values(4 * 4 * 3, 0.f);
    values[0] = 1;  // red at the upper left
    writeImagePng(folder.path("c.png"), 4, 4, 3, 8, values);
    writeImageExr(folder.path("h.exr"), 4, 4, 1, std::vector<float>(16, 7.f));
    const auto samples =
        readTextureSamples({{folder.path("c.png"), {{"height", folder.path("h.exr")}}}}, Tiling::Yes);
    REQUIRE(samples.size() == 1);
    const TextureSample& sample = samples[0];
    CHECK(sample.name == "c.png");
    CHECK(sample.image.channels == 4);
    CHECK(sample.image.tileable);
    CHECK(sample.image.texel(0, 3)[0] == 1);
    CHECK(sample.image.texel(0, 0)[0] == 0);
    CHECK(sample.image.texel(2, 2)[3] == 7);  // real values as they are
    REQUIRE(sample.maps.size() == 2);
    CHECK(sample.maps[1].name == "height");
    CHECK(sample.maps[1].first == 3);
    // Grey is three times the same.
    const auto grey = readTextureSamples({{image(folder, "g.png", 5, 4), {}}}, Tiling::No);
    CHECK(grey[0].image.texel(1, 3)[0] == grey[0].image.texel(1, 3)[2]);
    CHECK(grey[0].image.texel(1, 3)[1] == Approx(1.0 / 7).margin(0.003));
}

TEST_CASE("readTextureSamples: what no sample can be is an error of one line", "[pipeline][error]") {
    const test::TemporaryFolder folder;
    const auto thrown = [&](const std::vector<SampleFiles>& files) {
        return test::thrownBy([&] { readTextureSamples(files, Tiling::Auto); });
    };
    const std::string good = image(folder, "good.png", 8, 8);
    CHECK(thrown({{image(folder, "one.png", 1, 1), {}}}).code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown({{image(folder, "thin.png", 3, 9), {}}}).message, "3 x 9"));
    CHECK(thrown({{folder.write("empty.png", ""), {}}}).code == int(ErrorCode::BadData));
    CHECK(thrown({{folder.path("none.png"), {}}}).code == int(ErrorCode::Io));
    std::vector<float> holes(16, 0.5f);
    holes[5] = std::nanf("");
    writeGreyPng(folder.path("holes.png"), 4, 4, holes);
    CHECK(test::contains(thrown({{folder.path("holes.png"), {}}}).message, "1 of its 4 x 4 pixels"));
    const test::Thrown size = thrown({{good, {{"rough", image(folder, "other.png", 8, 9)}}}});
    CHECK(size.code == int(ErrorCode::ShapeMismatch));
    CHECK(test::contains(size.message, "8 x 9"));
    CHECK(thrown({{good, {{"Cd", good}}}}).code == int(ErrorCode::InvalidOption));
    CHECK(thrown({{good, {{"a", good}, {"a", good}}}}).code == int(ErrorCode::InvalidOption));
    CHECK(thrown({{good, {{"a", good}}}, {good, {}}}).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("requireMapNames: names alone decide", "[pipeline][error]") {
    CHECK_NOTHROW(requireMapNames({{"a.png", {{"roughness", "b.png"}, {"normal", "c.png"}}}}));
    CHECK(test::contains(test::thrownBy([] {
                             requireMapNames({{"a.png", {{"source_u", "b.png"}}}});
                         }).message,
                         "`channel` source_u=b.png"));
}
