#include "libvdbsynth/render/fog.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <limits>

using namespace vdbsynth;

namespace {

// A ball of density that thins out towards its radius.
openvdb::FloatGrid::Ptr cloud(int radius, double voxel) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0.f);
    for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
            for (int z = -radius; z <= radius; ++z) {
                const double r = std::sqrt(double(x * x + y * y + z * z)) / radius;
                if (r < 1) grid->tree().setValueOn({x, y, z}, float(1 - r));
            }
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    return grid;
}

Picture drawn(const openvdb::FloatGrid& grid, const PreviewOptions& options, const RunContext& ctx = {}) {
    const auto drawing = drawingOfFog(grid, options, ctx);
    const Framing framing = framed(drawing->outline(), {options.view}, options.up, 1);
    return drawing->drawn(framing.cameras.front(), ctx);
}

PreviewOptions clear() {
    PreviewOptions options;
    options.width = options.height = 80;
    options.background.kind = Background::Kind::Transparent;
    options.ground = false;
    return options;
}

}  // namespace

TEST_CASE("drawingOfFog: thick in its middle, thin at its edge, nothing beside it", "[vdb][oracle]") {
    const auto grid = cloud(20, 0.1);
    const Picture picture = drawn(*grid, clear());
    const auto opacity = [&](int x, int y) { return int(picture.pixels[std::size_t(y * 80 + x) * 4 + 3]); };
    CHECK(opacity(40, 40) > 230);
    CHECK(opacity(1, 1) == 0);
    CHECK((opacity(40, 8) > 5 && opacity(40, 8) < 200));
    for (int y = 41; y < 78; ++y) CHECK(opacity(40, y + 1) <= opacity(40, y) + 2);
    RunContext one;
    one.threads = 1;
    CHECK(drawn(*grid, clear(), one).pixels == picture.pixels);
}

TEST_CASE("drawingOfFog: the unit of densities and of the world does not matter", "[vdb][property]") {
    const auto grid = cloud(16, 1);
    const Picture picture = drawn(*grid, clear());
    const auto other = cloud(16, 1e-3);
    for (auto it = other->beginValueOn(); it; ++it) it.setValue(*it * 250);
    const Picture same = drawn(*other, clear());
    int most = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        most = std::max(most, std::abs(int(picture.pixels[i]) - int(same.pixels[i])));
    CHECK(most <= 2);
}

TEST_CASE("drawingOfFog: density makes it thicker, the side from the light is brighter", "[vdb]") {
    const auto grid = cloud(20, 1);
    PreviewOptions options = clear();
    options.density = 0.03;
    const Picture thin = drawn(*grid, options);
    options.density = 1;
    const Picture thick = drawn(*grid, options);
    const auto pixel = [](const Picture& picture, int x, int y) {
        return &picture.pixels[std::size_t(y * 80 + x) * 4];
    };
    CHECK(pixel(thin, 40, 40)[3] < pixel(thick, 40, 40)[3] - 60);
    CHECK(pixel(thick, 25, 25)[0] > pixel(thick, 55, 58)[0] + 25);
}

TEST_CASE("drawingOfFog: its shadow lies on the ground", "[vdb]") {
    const auto grid = cloud(20, 1);
    PreviewOptions options = clear();
    options.background.kind = Background::Kind::Plain;
    const Picture floating = drawn(*grid, options);
    options.ground = true;
    const Picture standing = drawn(*grid, options);
    std::size_t darker = 0;
    for (std::size_t i = 0; i < floating.pixels.size(); ++i) {
        CHECK(standing.pixels[i] <= floating.pixels[i]);
        darker += standing.pixels[i] + 20 < floating.pixels[i];
    }
    CHECK(darker > 600);
}

TEST_CASE("drawingOfFog: what is no fog is refused", "[vdb][error]") {
    openvdb::initialize();
    const auto empty = openvdb::FloatGrid::create(0.f);
    CHECK(test::thrownBy([&] { drawingOfFog(*empty); }).code == int(ErrorCode::EmptyInput));
    const auto nothing = cloud(5, 1);
    for (auto it = nothing->beginValueOn(); it; ++it) it.setValue(-1);
    CHECK(test::thrownBy([&] { drawingOfFog(*nothing); }).code == int(ErrorCode::EmptyInput));
    const auto broken = cloud(5, 1);
    broken->tree().setValueOn({0, 0, 0}, std::numeric_limits<float>::quiet_NaN());
    CHECK(test::thrownBy([&] { drawingOfFog(*broken); }).code == int(ErrorCode::BadData));
}
