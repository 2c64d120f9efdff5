#include "libvdbsynth/render/preview.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
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

TEST_CASE("renderSlice: inside is warm, outside cool, the zero level black", "[vdb][oracle]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.5, 3, "sphere");
    SliceOptions options;
    options.width = options.height = 208;
    const Picture picture = renderSlice(*grid, {{-20, -20, -20}, {19, 19, 19}}, options);
    CHECK(isModel(picture, 104, 104));
    CHECK_FALSE(isModel(picture, 4, 4));
}

TEST_CASE("renderPreview, renderSlice: options out of range are named", "[vdb][error]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 3), 1, 3, "sphere");
    PreviewOptions options;
    options.width = 3;
    CHECK(test::contains(test::thrownBy([&] { renderPreview(*grid, options); }).message,
                         "`width` 3, height 600"));
    options = {};
    options.view = {0, 0, 0};
    CHECK(test::contains(test::thrownBy([&] { renderPreview(*grid, options); }).message, "`view`"));
    SliceOptions slice;
    slice.fraction = 2;
    CHECK(test::contains(test::thrownBy([&] {
                             renderSlice(*grid, {{0, 0, 0}, {1, 1, 1}}, slice);
                         }).message,
                         "`fraction`"));
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
