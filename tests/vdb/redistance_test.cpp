#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/mesh_conversion.h"
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

TEST_CASE("rebuildLevelSet: a cavity without a way out stays a cavity", "[vdb][property]") {
    const BrickField shell = test::fieldFrom({48, 48, 48}, [](const Index3& p) {
        const double d = length(Vec3d{p.x - 23.5, p.y - 23.5, p.z - 23.5});
        return std::clamp(float(std::abs(d - 14) - 5), -3.f, 3.f);
    });
    const FloatGridPtr field = scatterBricks(shell, {0, 0, 0}, 1.f, 3.f);
    const FloatGridPtr grid = rebuildLevelSet(*field, 3.f, "shell");
    CHECK(grid->getConstAccessor().getValue({23, 23, 23}) == 3.f);
    CHECK(solidVoxels(*grid) == Approx(solidVoxels(*field)).epsilon(0.001));
    CHECK(test::thrownBy([&] { rebuildLevelSet(*openvdb::FloatGrid::create(3.f), 3.f, "nothing"); }).code ==
          int(ErrorCode::EmptyInput));
}

TEST_CASE("widenBand: wide distances agree with the true ones, and the narrow band's with itself",
          "[vdb][oracle]") {
    const FloatGridPtr grid =
        scatterBricks(ballField({64, 64, 64}, {31.5, 31.5, 31.5}, 18, 3), {-5, 0, 7}, 0.25f, 3.f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    const BrickField wide = widenBand(*grid, {{-5, 0, 7}, {58, 63, 70}}, {}, 8.f);
    for (int i = 0; i < 64; ++i) {
        const double d = std::clamp(std::abs(i - 31.5) - 18.0, -8.0, 8.0);
        CHECK(double(wide.at({i, 31, 32})) == Approx(d).margin(0.06));
    }
}

TEST_CASE("closeAndRebuild, widenBand: a thin bar's distances stay as they are, others are made anew",
          "[vdb][oracle]") {
    // A bar of radius 1.4: a mesh of its zero level is a tenth of a voxel thinner.
    const auto bar = [](float slope) {
        return test::fieldFrom({40, 40, 40}, [=](const Index3& p) {
            const double d = std::hypot(p.y - 19.3, p.z - 19.6) - 1.4;
            return float(std::clamp(slope * d, -8.0, 8.0));
        });
    };
    const auto like = openvdb::FloatGrid::create(3.f);
    const FloatGridPtr grid = closeAndRebuild(bar(1), {0, 0, 0}, kAllCut, 3.f, *like, "bar");
    const BrickField own = bar(1), wide = widenBand(*grid, {{0, 0, 0}, {39, 39, 39}}, kAllCut, 8.f);
    std::size_t kept = 0, all = 0;
    for (int x = 8; x < 32; ++x)
        for (int y = 0; y < 40; ++y)
            for (int z = 0; z < 40; ++z) {
                const float expected = own.at({x, y, z});
                if (std::abs(expected) >= 1) continue;
                ++all;
                kept += std::abs(grid->tree().getValue({x, y, z}) - expected) < 1e-4f &&
                                std::abs(wide.at({x, y, z}) - expected) < 1e-4f
                            ? 1
                            : 0;
            }
    CHECK(all > 300);
    CHECK(double(kept) > 0.85 * double(all));  // not beside the axis, where the gradient has a kink
    // A field of half the slope is no distance: its values come from the mesh.
    const FloatGridPtr anew = closeAndRebuild(bar(0.5f), {0, 0, 0}, kAllCut, 3.f, *like, "bar");
    double slope = 0;
    for (int x = 8; x < 32; ++x)
        slope += double(anew->tree().getValue({x, 19, 23}) - anew->tree().getValue({x, 19, 22})) / 24;
    CHECK(slope == Approx(1).margin(0.05));
}

TEST_CASE("widenBand: caps of a clipped model do not count", "[vdb][property]") {
    // A rod along x, clipped at both ends; without its caps it goes on for ever.
    const BrickField rod = test::fieldFrom({40, 40, 40}, [](const Index3& p) {
        return std::clamp(float(std::sqrt((p.y - 19.5) * (p.y - 19.5) + (p.z - 19.5) * (p.z - 19.5)) - 9),
                          -3.f, 3.f);
    });
    const BrickField closed = closeField(rod, rod.box(), kAllCut, 3.f);
    const FloatGridPtr grid = scatterBricks(closed, {0, 0, 0}, 1.f, 3.f);
    CHECK(grid->getConstAccessor().getValue({0, 19, 19}) == -0.5f);
    const BrickField wide = widenBand(*grid, {{0, 0, 0}, {39, 39, 39}}, kAllCut, 8.f);
    for (int x = 0; x < 40; ++x) CHECK(double(wide.at({x, 19, 19})) == Approx(-8).margin(0.6));
    const BrickField capped = widenBand(*grid, {{0, 0, 0}, {39, 39, 39}}, {}, 8.f);
    CHECK(double(capped.at({0, 19, 19})) == Approx(-0.5).margin(0.05));
}

TEST_CASE("closeAndRebuild: clipped at the domain, closed, valid", "[vdb][property]") {
    const BrickField field = ballField({40, 40, 40}, {20, 20, 20}, 24, 8);
    const auto like = openvdb::FloatGrid::create(3.f);
    like->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    const FloatGridPtr grid = closeAndRebuild(field, {10, -3, 0}, kAllCut, 3.f, *like, "ball");
    CHECK(voxelSizeOf(*grid) == 0.5);
    const IndexBox solid = solidBox(*grid, "ball");
    CHECK(solid == IndexBox{{10, -3, 0}, {49, 36, 39}});
    CHECK(summarize(levelSetToMesh(*grid)).closedManifold());
    CHECK(measureBand(*grid).gradientErrorMean < 0.05);
}
