#include "libvdbsynth/vdb/redistance.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

BrickField ballField(const Index3& size, const Vec3d& centre, double radius, float limit, float slope = 1.f) {
    return test::fieldFrom(size, [=](const Index3& p) {
        const double d = length(Vec3d{double(p.x), double(p.y), double(p.z)} - centre) - radius;
        return std::clamp(float(d) * slope, -limit, limit);
    });
}

}  // namespace

TEST_CASE("rebuildLevelSet: a field of the wrong slope becomes a distance field", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr field =
        scatterBricks(ballField({48, 48, 48}, {23.3, 24.1, 23.8}, 15, 3, 0.4f), {0, 0, 0}, 1.f, 3.f);
    const FloatGridPtr grid = rebuildLevelSet(*field, 3.f, "ball");
    const BandQuality quality = measureBand(*grid);
    CHECK(quality.gradientErrorMean < 0.02);
    CHECK(quality.missingNeighbours == 0);
    CHECK(quality.finite);
    // OpenVDB's band expansion looks at neighbours' polygons only, so a few outer voxels are up to half a
    // voxel off.
    std::size_t all = 0, close = 0;
    for (auto it = grid->cbeginValueOn(); it; ++it) {
        const openvdb::Vec3d p = grid->indexToWorld(it.getCoord());
        const double error = std::abs(double(*it) - ((p - openvdb::Vec3d(23.3, 24.1, 23.8)).length() - 15));
        REQUIRE(error < 1);
        if (std::abs(*it) < 1) REQUIRE(error < 0.06);
        ++all;
        close += error < 0.06 ? 1 : 0;
    }
    CHECK(double(close) > 0.98 * double(all));
}

TEST_CASE("rebuildLevelSet: what is rebuilt in parts is what it is in one", "[vdb][oracle]") {
    // Two rods far apart: together they are long enough for parts, whose borders run through the first.
    const auto rods = [](int length) {
        return test::fieldFrom({length, 40, 40}, [](const Index3& p) {
            const auto rod = [&](double begin, double end) {
                const double along = std::max(begin - p.x, p.x - end);
                return std::max(along, std::hypot(p.y - 19.5, p.z - 19.5) - 12 + 3 * std::sin(p.x * 0.2));
            };
            return float(std::clamp(std::min(rod(6, 200), rod(420, 470)), -3.0, 3.0));
        });
    };
    const auto rebuilt = [&](int length) {
        return rebuildLevelSet(*scatterBricks(rods(length), {-5, 3, 2}, 1.f, 3.f), 3.f, "rods");
    };
    const FloatGridPtr one = rebuilt(210), parts = rebuilt(480);
    const auto expected = one->getConstAccessor(), got = parts->getConstAccessor();
    std::size_t active = 0, wrong = 0;
    for (int x = -8; x < 205; ++x)
        for (int y = 0; y < 46; ++y)
            for (int z = 0; z < 46; ++z) {
                const openvdb::Coord at(x, y, z);
                active += expected.isValueOn(at) ? 1 : 0;
                wrong +=
                    expected.getValue(at) != got.getValue(at) || expected.isValueOn(at) != got.isValueOn(at)
                        ? 1
                        : 0;
            }
    CHECK(active > 20000);
    CHECK(wrong == 0);
    CHECK(parts->activeVoxelCount() > one->activeVoxelCount());
    CHECK(got.getValue({440, 22, 21}) == -3.f);
}

TEST_CASE("rebuildLevelSet: solid stays solid, and nothing has no surface", "[vdb][property][error]") {
    const FloatGridPtr field =
        scatterBricks(ballField({48, 48, 48}, {23.3, 24.1, 23.8}, 15, 3, 0.4f), {-9, 4, 0}, 1.f, 3.f);
    CHECK(solidVoxels(*rebuildLevelSet(*field, 3.f, "ball")) == solidVoxels(*field));
    const test::Thrown thrown =
        test::thrownBy([&] { rebuildLevelSet(*openvdb::FloatGrid::create(3.f), 3.f, "nothing"); });
    CHECK(thrown.code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(thrown.message, "nothing has no surface"));
}
