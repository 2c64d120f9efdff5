#include "libvdbsynth/pipeline/render/render.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/render/picture_row.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/render/slice.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;

namespace {

ShownModel ballOf(float radius, const std::string& name = "ball") {
    openvdb::initialize();
    ShownModel shown;
    shown.name = name;
    const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, {0, 0, 0}, 1.f, 3.f);
    shown.model.grid = grid;
    shown.model.domain = solidBox(*grid, name);
    return shown;
}

ShownModel fog() {
    openvdb::initialize();
    ShownModel shown;
    shown.name = "fog";
    shown.fog = openvdb::FloatGrid::create(0.f);
    shown.fog->fill(openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}), 0.5f);
    return shown;
}

RenderOptions small() {
    RenderOptions options;
    options.size = {48, 32};
    return options;
}

std::vector<Picture> drawn(const std::vector<ShownModel>& models, const RenderOptions& options,
                           const RunContext& ctx = {}) {
    std::vector<Picture> pictures;
    renderModels(
        models.size(), [&](std::size_t i) { return models[i]; }, options,
        [&](int number, const Picture& picture) {
            pictures.push_back(picture);
            CHECK(number == int(pictures.size()));
        },
        ctx);
    return pictures;
}

void refuses(const std::vector<ShownModel>& models, const RenderOptions& options, ErrorCode code,
             const std::string& says, const RunContext& ctx = {}) {
    const test::Thrown thrown = test::thrownBy([&] { drawn(models, options, ctx); });
    INFO(says << " / " << thrown.message);
    CHECK(thrown.code == int(code));
    CHECK(test::contains(thrown.message, says));
}

}  // namespace

TEST_CASE("renderModels: one model is its preview, whatever is given", "[pipeline][oracle]") {
    const ShownModel ball = ballOf(8);
    RenderOptions options = small();
    PreviewOptions alone;
    alone.width = 48;
    alone.height = 32;
    alone.view = usualView(UpAxis::Z);
    CHECK(drawn({ball}, options).front().pixels == renderPreview(*ball.model.grid, alone).pixels);
    options.view = alone.view = {0.3, 1, 0.5};
    options.up = alone.up = UpAxis::Y;
    options.ground = alone.ground = false;
    options.samples = alone.samples = 1;
    REQUIRE(parseBackground("transparent", options.background));
    alone.background = options.background;
    const Picture clear = drawn({ball}, options).front();
    CHECK(clear.channels == 4);
    CHECK(clear.pixels == renderPreview(*ball.model.grid, alone).pixels);
    // The model's own up axis, and what the options say instead.
    ShownModel upright = ball;
    upright.up = UpAxis::Y;
    options = small();
    const std::vector<std::uint8_t> own = drawn({upright}, options).front().pixels;
    CHECK(own != drawn({ball}, options).front().pixels);
    options.up = UpAxis::Z;
    CHECK(drawn({upright}, options).front().pixels == drawn({ball}, options).front().pixels);
}

TEST_CASE("renderModels: slices are those of renderSlice, with captions", "[pipeline][oracle]") {
    const ShownModel ball = ballOf(8);
    RenderOptions options = small();
    options.slice = {0, 0.25};
    SliceOptions alone;
    alone.width = 48;
    alone.height = 32;
    alone.axis = 0;
    alone.fraction = 0.25;
    Picture slice = renderSlice(*ball.model.grid, ball.model.domain, alone);
    CHECK(drawn({ball}, options).front().pixels == slice.pixels);
    options.captions = {"x"};
    const Picture captioned = drawn({ball}, options).front();
    CHECK(captioned.pixels != slice.pixels);
    labelPicture(slice, "x", /* boxed= */ true);
    CHECK(captioned.pixels == slice.pixels);
}

TEST_CASE("renderModels: rows, one scale, turntables", "[pipeline][property]") {
    const std::vector<ShownModel> models{ballOf(4), ballOf(8), ballOf(4)};
    RenderOptions options = small();
    const Picture first = drawn({models[0]}, options).front();
    Picture row = drawn(models, options).front();
    CHECK(row.width == 3 * 48);
    CHECK(std::equal(first.pixels.begin(), first.pixels.begin() + 48 * 3, row.pixels.begin()));
    options.columns = 2;
    row = drawn(models, options).front();
    CHECK(row.width == 2 * 48);
    CHECK(row.height == 2 * 32);
    // Balls of any size look the same but at one scale.
    options = small();
    options.ground = false;
    const auto halves = [&](bool sameScale) {
        options.sameScale = sameScale;
        const Picture both = drawn({models[0], models[1]}, options).front();
        int different = 0;
        for (std::size_t y = 0; y < 32; ++y)
            for (std::size_t x = 0; x < 48 * 3; ++x)
                different += std::abs(both.pixels[y * 288 + x] - both.pixels[y * 288 + 144 + x]) > 60;
        return different;
    };
    CHECK(halves(false) * 4 < halves(true));
    options = small();
    options.turntable = 3;
    const std::vector<Picture> turn = drawn({models[0]}, options);
    REQUIRE(turn.size() == 3);
    CHECK(turn[1].width == 48);
    CHECK(turn[0].pixels != turn[1].pixels);  // the light stands, the ball's voxels turn
}

TEST_CASE("renderModels: colours, wires, streaks and fog change the picture", "[pipeline]") {
    ShownModel ball = ballOf(8);
    RenderOptions options = small();
    const std::vector<std::uint8_t> clay = drawn({ball}, options).front().pixels;
    const auto blue = openvdb::Vec3SGrid::create(openvdb::Vec3f(0.1f, 0.2f, 0.9f));
    blue->fill(openvdb::CoordBBox({-12, -12, -12}, {12, 12, 12}), openvdb::Vec3f(0.1f, 0.2f, 0.9f));
    blue->setName("tint");
    ball.attributes = {blue};
    CHECK(drawn({ball}, options).front().pixels == clay);  // it has not the usual name
    options.color = "tint";
    const std::vector<std::uint8_t> tinted = drawn({ball}, options).front().pixels;
    const std::size_t middle = (16 * 48 + 24) * 3;
    CHECK(tinted[middle + 2] > tinted[middle] + 40);
    options.color = "none";
    CHECK(drawn({ball}, options).front().pixels == clay);
    options = small();
    options.directions = blue;
    CHECK(drawn({ball}, options).front().pixels != clay);
    options = small();
    options.wireframe = true;
    const std::vector<std::uint8_t> level = drawn({ball}, options).front().pixels;
    CHECK(level != clay);
    MeshingOptions coarse;
    coarse.adaptivity = 1;
    ball.model.source = std::make_shared<Mesh>(levelSetToMesh(*ball.model.grid, coarse));
    CHECK(drawn({ball}, options).front().pixels != level);
    CHECK(drawn({fog()}, small()).front().pixels != clay);
    CHECK(drawn({fog(), ball}, small()).front().width == 96);
}

TEST_CASE("renderModels: errors, before a model is asked for where that is possible", "[pipeline][error]") {
    RenderOptions options = small();
    options.samples = 0;
    const auto never = [](std::size_t) -> ShownModel { throw std::logic_error("asked for"); };
    const auto untaken = [](int, const Picture&) {};
    CHECK(test::thrownBy([&] { renderModels(1, never, options, untaken); }).code ==
          int(ErrorCode::InvalidOption));
    options = small();
    options.color = "Cd";
    refuses({ballOf(5, "a.vdb")}, options, ErrorCode::BadData,
            "`color` Cd: not in a.vdb, which has no attributes");
    options = small();
    options.wireframe = true;
    refuses({fog()}, options, ErrorCode::InvalidOption, "`wireframe`: fog is fog, which has no surface");
    options = small();
    options.slice.emplace();
    refuses({fog()}, options, ErrorCode::InvalidOption, "`slice`: fog is fog");
    options = small();
    const auto along = openvdb::Vec3SGrid::create(openvdb::Vec3f(1, 0, 0));
    options.directions = along;
    refuses({fog()}, options, ErrorCode::InvalidOption, "`directions`: fog is fog");
    options = small();
    options.size = {8192, 16};
    refuses(std::vector<ShownModel>(9, ballOf(3)), options, ErrorCode::InvalidOption,
            "`size`: the row would be");
    const std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    refuses({ballOf(5)}, small(), ErrorCode::Cancelled, "", stopped);
    options = small();
    options.slice.emplace();
    refuses({ballOf(5)}, options, ErrorCode::Cancelled, "", stopped);
}

TEST_CASE("renderModels: same bits for any number of threads, captions without letters are said",
          "[pipeline][determinism]") {
    RenderOptions options = small();
    options.captions = {"\xcf\x80", "b"};
    std::string said;
    RunContext one;
    one.threads = 1;
    one.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
    RunContext many;
    many.threads = 7;
    const std::vector<ShownModel> models{ballOf(6), fog()};
    CHECK(drawn(models, options, one).front().pixels == drawn(models, options, many).front().pixels);
    CHECK(test::contains(said, "characters without a letter"));
    CHECK_FALSE(test::contains(said, "caption b"));
}
