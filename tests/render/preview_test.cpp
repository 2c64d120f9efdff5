#include "libvdbsynth/render/preview.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

bool isModel(const Picture& picture, int x, int y) {
    const std::uint8_t* p = &picture.pixels[std::size_t(y * picture.width + x) * 3];
    return p[0] > p[2] + 8;  // the model is warm, the background cool
}

}  // namespace

TEST_CASE("renderPreview: a sphere is a disk in the middle that leaves a margin", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.5, 3, "sphere");
    PreviewOptions options;
    options.width = 160;
    options.height = 120;
    const Picture picture = renderPreview(*grid, options);
    REQUIRE(picture.pixels.size() == 160 * 120 * 3);
    CHECK(isModel(picture, 80, 60));
    CHECK_FALSE(isModel(picture, 2, 2));
    CHECK_FALSE(isModel(picture, 80, 1));
    int left = 0, right = 0;
    for (int x = 0; x < 160; ++x) {
        if (!isModel(picture, x, 60)) continue;
        if (!left) left = x;
        right = x;
    }
    CHECK(left + right == Approx(160).margin(3));
    CHECK(right - left > 50);
    RunContext one;
    one.threads = 1;
    CHECK(renderPreview(*grid, options, one).pixels == picture.pixels);
}

TEST_CASE("renderPreview: options out of range are named", "[vdb][error]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 3), 1, 3, "sphere");
    PreviewOptions options;
    options.width = 3;
    CHECK(test::contains(test::thrownBy([&] { renderPreview(*grid, options); }).message,
                         "`width` 3, height 600"));
    options = {};
    options.view = {0, 0, 0};
    CHECK(test::contains(test::thrownBy([&] { renderPreview(*grid, options); }).message, "`view`"));
    options = {};
    options.density = 0;
    CHECK(test::contains(test::thrownBy([&] { renderPreview(*grid, options); }).message, "`density`"));
    options = {};
    options.colours = grid;
    CHECK(test::thrownBy([&] { renderPreview(*grid, options); }).code == int(ErrorCode::BadData));
}

TEST_CASE("renderPreview: directions are streaks along them", "[vdb]") {
    openvdb::initialize();
    // Seen from above: a slab's top, directions along x.
    const FloatGridPtr grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {60, 60, 6}), 1, 3, "slab");
    openvdb::Vec3SGrid::Ptr field = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    field->setTransform(grid->transform().copy());
    for (auto value = grid->cbeginValueOn(); value; ++value)
        field->tree().setValueOn(value.getCoord(), openvdb::Vec3f(2, 0, 0));
    PreviewOptions options;
    options.width = options.height = 200;
    options.view = {0, 0, 1};
    options.samples = 1;
    options.directions = field;
    const Picture picture = renderPreview(*grid, options);
    const auto red = [&](int x, int y) { return int(picture.pixels[std::size_t(y * 200 + x) * 3]); };
    double along = 0, across = 0;
    for (int y = 60; y < 140; ++y)
        for (int x = 60; x < 140; ++x) {
            along += std::abs(red(x + 4, y) - red(x, y));
            across += std::abs(red(x, y + 4) - red(x, y));
        }
    CHECK(across > 2.5 * along);
    CHECK(across > 80 * 80 * 10);
    PreviewOptions plain = options;
    plain.directions = nullptr;
    CHECK(renderPreview(*grid, plain).pixels != picture.pixels);
    RunContext one;
    one.threads = 1;
    CHECK(renderPreview(*grid, options, one).pixels == picture.pixels);
    options.directions = grid;
    const test::Thrown thrown = test::thrownBy([&] { renderPreview(*grid, options); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "vectors of floats"));
}

TEST_CASE("renderPreview: the model fills the frame", "[vdb][property]") {
    const FloatGridPtr grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {10, 80, 20}), 1, 3, "bar");
    PreviewOptions options;
    options.width = 200;
    options.height = 150;
    options.ground = false;
    for (const Vec3d& view : {Vec3d{1, -1.6, 0.9}, Vec3d{-2, 0.3, -1}}) {
        options.view = view;
        const Picture picture = renderPreview(*grid, options);
        int left = 200, right = 0, top = 150, bottom = 0;
        for (int y = 0; y < 150; ++y)
            for (int x = 0; x < 200; ++x) {
                if (!isModel(picture, x, y)) continue;
                left = std::min(left, x);
                right = std::max(right, x);
                top = std::min(top, y);
                bottom = std::max(bottom, y);
            }
        CHECK(std::max((right - left) / 200.0, (bottom - top) / 150.0) > 0.88);
        CHECK(std::min({left / 200.0, top / 150.0, 1 - right / 200.0, 1 - bottom / 150.0}) > 0.02);
    }
}

TEST_CASE("renderPreview: a clear background has opacity, the ground's shadow too", "[vdb]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.5, 3, "sphere");
    PreviewOptions options;
    options.width = options.height = 120;
    options.background.kind = Background::Kind::Transparent;
    const Picture picture = renderPreview(*grid, options);
    REQUIRE(picture.channels == 4);
    const auto pixel = [&](int x, int y) { return &picture.pixels[std::size_t(y * 120 + x) * 4]; };
    CHECK(int(pixel(60, 60)[3]) == 255);
    CHECK(int(pixel(2, 2)[3]) == 0);
    int shadow = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x)
            shadow += pixel(x, y)[3] > 60 && pixel(x, y)[3] < 250 && pixel(x, y)[0] == 0;
    CHECK(shadow > 100);
    options.ground = false;
    const Picture floating = renderPreview(*grid, options);
    int between = 0, soft = 0;
    for (std::size_t i = 3; i < floating.pixels.size(); i += 4) {
        between += floating.pixels[i] > 0 && floating.pixels[i] < 255;
        soft += floating.pixels[i] > 0 && floating.pixels[i] < 255 && floating.pixels[i - 3] > 20;
    }
    CHECK((between > 50 && between < 600));  // the silhouette alone
    CHECK(soft == between);                  // in the model's colour, not darkened
}

TEST_CASE("renderPreview: colours are those of the grid, in the light", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {40, 40, 40}), 1, 3, "cube");
    const auto colours = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    for (auto value = grid->cbeginValueOn(); value; ++value)
        colours->tree().setValueOn(value.getCoord(), value.getCoord().x() < 20 ? openvdb::Vec3f(1, 0, 0)
                                                                               : openvdb::Vec3f(0, 0.6f, 0));
    PreviewOptions options;
    options.width = options.height = 100;
    options.view = {0, -1, 0};
    options.colours = colours;
    const Picture picture = renderPreview(*grid, options);
    const auto pixel = [&](int x, int y) { return &picture.pixels[std::size_t(y * 100 + x) * 3]; };
    CHECK(pixel(30, 50)[0] > 3 * pixel(30, 50)[1]);
    CHECK(pixel(70, 50)[1] > 2 * pixel(70, 50)[0]);
}

TEST_CASE("renderPreview: wires darken the edges of faces", "[vdb]") {
    const Mesh box = test::boxMesh({0, 0, 0}, {40, 40, 40});
    const FloatGridPtr grid = meshToLevelSet(box, 1, 3, "cube");
    PreviewOptions options;
    options.width = options.height = 120;
    options.view = {0.01, -1, 0.01};
    const Picture plain = renderPreview(*grid, options);
    options.wires = &box;
    const Picture wired = renderPreview(*grid, options);
    std::size_t darker = 0;
    for (std::size_t i = 0; i < plain.pixels.size(); i += 3) {
        CHECK(wired.pixels[i] <= plain.pixels[i]);
        darker += plain.pixels[i] > wired.pixels[i] + 40;
    }
    CHECK((darker > 250 && darker < 900));  // four sides of about 100 pixels
    RunContext one;
    one.threads = 1;
    CHECK(renderPreview(*grid, options, one).pixels == wired.pixels);
}

TEST_CASE("drawingOf: one drawing serves many cameras, with the same pictures as alone", "[vdb][property]") {
    const FloatGridPtr grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {40, 20, 10}), 1, 3, "box");
    PreviewOptions options;
    options.width = options.height = 64;
    const auto drawing = drawingOf(*grid, options);
    const Framing framing =
        framed(drawing->outline(), turntableViews(options.view, options.up, 5), options.up, 1);
    const Picture first = drawing->drawn(framing.cameras[0]), third = drawing->drawn(framing.cameras[2]);
    CHECK(first.pixels != third.pixels);
    CHECK(drawing->drawn(framing.cameras[0]).pixels == first.pixels);
}
