#include "libvdbsynth/pipeline/relief/relief_extract.h"

#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/contexts.h"
#include "tests/support/level_sets.h"
#include "tests/support/said.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// A ball of 12 units in voxels of a half, with bumps.
LevelSet bumpyBall(double bump) {
    openvdb::initialize();
    const BrickField field = test::fieldFrom({65, 65, 65}, [=](const Index3& p) {
        const double x = p.x - 32, y = p.y - 32, z = p.z - 32;
        const double h = bump * sine(0.8 * x) * sine(0.8 * y) * sine(0.8 * z);
        return float(std::clamp((std::sqrt(x * x + y * y + z * z) - 24 - h) / 1.3, -3.0, 3.0));
    });
    LevelSet model;
    model.grid = scatterBricks(field, {-32, -32, -32}, 0.5f, 3.f);
    model.grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    model.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    model.domain = solidBox(*model.grid, "the ball");
    return model;
}

// A wave along x over a domain that cuts it.
LevelSet cutWave() {
    openvdb::initialize();
    const BrickField field = test::fieldFrom({96, 64, 40}, [](const Index3& p) {
        const double h = 1.5 * sine(2 * kPi * p.x / 16),
                     slope = 1.5 * 2 * kPi / 16 * cosine(2 * kPi * p.x / 16);
        return float(std::clamp((p.z - 20 - h) / std::sqrt(1 + slope * slope), -3.0, 3.0));
    });
    LevelSet model;
    model.grid = scatterBricks(closeField(field, field.box(), kAllCut, 3), {0, 0, 0}, 1.f, 3.f);
    model.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    model.domain = field.box();
    model.domainRecorded = true;
    stampLevelSet(model);
    return model;
}

ReliefExtractOptions withRadius(double radius, std::optional<double> strength = {}) {
    ReliefExtractOptions options;
    options.baseRadius = radius;
    options.strength = strength;
    return options;
}

// The largest difference of two level sets' distances where either is within a voxel of its surface. [voxels]
double farthest(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    double most = 0;
    const auto other = b.getConstAccessor();
    for (auto it = a.cbeginValueOn(); it; ++it)
        if (std::abs(*it) < a.voxelSize()[0])
            most = std::max(most, std::abs(double(*it) - double(other.getValue(it.getCoord()))));
    return most / a.voxelSize()[0];
}

// Voxels farther than a tenth from one surface that are on the other side of the other.
std::size_t differences(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    std::size_t count = 0;
    const auto other = b.getConstAccessor();
    for (auto it = a.cbeginValueOn(); it; ++it)
        count += std::abs(*it) > 0.1 * a.voxelSize()[0] && (*it < 0) != (other.getValue(it.getCoord()) < 0);
    return count;
}

}  // namespace

TEST_CASE("extractRelief: base and relief add up to the scan", "[pipeline][property]") {
    const LevelSet model = bumpyBall(1.2);
    const ReliefExtraction result = extractRelief(model, withRadius(1.5, 1.0));
    CHECK(result.base.grid->getName() == "base");
    CHECK(result.base.grid->getGridClass() == openvdb::GRID_LEVEL_SET);
    CHECK(result.relief->getName() == "relief");
    CHECK(result.surface.grid->getName() == "surface");
    CHECK(result.radius == 1.5);
    CHECK(result.statistics.sq > 0.2);
    CHECK(differences(*result.surface.grid, *model.grid) == 0);
    CHECK(differences(*model.grid, *result.surface.grid) == 0);
    // The base is a ball again.
    CHECK(solidVoxels(*result.base.grid) == Approx(4. / 3 * kPi * 24 * 24 * 24).epsilon(0.01));
}

TEST_CASE("extractRelief: relief is active in the base's band, in world units", "[pipeline]") {
    const ReliefExtraction result = extractRelief(bumpyBall(1.2), withRadius(1.5));
    const auto relief = openvdb::gridConstPtrCast<openvdb::FloatGrid>(result.relief);
    REQUIRE(relief);
    CHECK_FALSE(result.surface.grid);
    CHECK(relief->activeVoxelCount() == result.base.grid->activeVoxelCount());
    float most = 0;
    for (auto it = relief->cbeginValueOn(); it; ++it) most = std::max(most, std::abs(*it));
    CHECK(double(most) ==
          Approx(0.5 * std::max(result.statistics.highest, -result.statistics.lowest)).margin(0.1));
}

TEST_CASE("extractRelief: strength 0 is the base", "[pipeline]") {
    const ReliefExtraction result = extractRelief(bumpyBall(1.2), withRadius(1.5, 0.0));
    CHECK(farthest(*result.surface.grid, *result.base.grid) < 1e-3);
}

TEST_CASE("extractRelief: of a cut wave the base is flat up to the cuts", "[pipeline]") {
    const ReliefExtraction result = extractRelief(cutWave(), withRadius(8, 1.0));
    CHECK(result.recorded);
    CHECK(result.base.domainRecorded);
    CHECK(result.statistics.sq == Approx(1.5 / std::sqrt(2.0)).epsilon(0.05));
    CHECK(result.statistics.sku == Approx(1.5).epsilon(0.03));
    const auto base = result.base.grid->getConstAccessor();
    for (const int x : {20, 48, 75}) {
        CHECK(base.getValue({x, 32, 22}) > 1.5f);
        CHECK(base.getValue({x, 32, 18}) < -1.5f);
    }
}

TEST_CASE("extractRelief: a plain ball has no relief, which is said", "[pipeline]") {
    test::Said said;
    const ReliefExtraction result = extractRelief(bumpyBall(0), withRadius(2), said.ctx);
    CHECK(result.statistics.sq < 0.05);
    CHECK(said.warned("no relief"));
}

TEST_CASE("extractRelief: a base that pinches a neck is said", "[pipeline]") {
    openvdb::initialize();
    // Two balls and a thin bar between them.
    const BrickField field = test::fieldFrom({120, 50, 50}, [](const Index3& p) {
        const auto ball = [&](double x) {
            return std::sqrt((p.x - x) * (p.x - x) + (p.y - 25.) * (p.y - 25.) + (p.z - 25.) * (p.z - 25.)) -
                   18;
        };
        const double bar = std::max(std::sqrt((p.y - 25.) * (p.y - 25.) + (p.z - 25.) * (p.z - 25.)) - 2,
                                    std::abs(p.x - 60.) - 40);
        return float(std::clamp(std::min({ball(25), ball(95), bar}), -3.0, 3.0));
    });
    LevelSet model;
    model.grid = scatterBricks(field, {0, 0, 0}, 1.f, 3.f);
    model.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    model.domain = solidBox(*model.grid, "the bar");
    test::Said said;
    const ReliefExtraction result = extractRelief(model, withRadius(5), said.ctx);
    CHECK(result.scanCounts.solids == 1);
    CHECK(result.baseCounts.solids == 2);
    CHECK(said.warned("solid parts 1 to 2"));
    CHECK(said.warned("`baseRadius`"));
}

TEST_CASE("extractRelief: without a radius the spectrum decides", "[pipeline]") {
    const ReliefExtraction result = extractRelief(cutWave(), withRadius(0));
    CHECK(result.scale.gap);
    CHECK(result.radius == result.scale.radius);
    CHECK(result.radius * kCutOff > 16);
}

TEST_CASE("extractRelief: options and models out of range are refused", "[pipeline][error]") {
    const LevelSet model = bumpyBall(1);
    const auto refused = [&](const ReliefExtractOptions& options, const char* field) {
        const test::Thrown thrown = test::thrownBy([&] { extractRelief(model, options); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, field));
    };
    refused(withRadius(-1), "`baseRadius`");
    refused(withRadius(std::nan("")), "`baseRadius`");
    refused(withRadius(0.3), "`baseRadius`");
    refused(withRadius(1, 101.0), "`strength`");
    ReliefExtractOptions narrow;
    narrow.halfWidth = 1;
    refused(narrow, "`halfWidth`");
    CHECK(test::thrownBy([&] { extractRelief({}, {}); }).code == int(ErrorCode::InvalidOption));
    RunContext little;
    little.maxMemory = 1000;
    CHECK(test::thrownBy([&] { extractRelief(model, withRadius(2), little); }).code ==
          int(ErrorCode::Memory));
}

TEST_CASE("extractRelief: same bits for any number of threads, and cancels", "[pipeline][determinism]") {
    const LevelSet model = bumpyBall(1.2);
    const ReliefExtraction one = extractRelief(model, withRadius(1.5, 2.0), test::onThreads(1)),
                           many = extractRelief(model, withRadius(1.5, 2.0), test::onThreads(8));
    CHECK(levelSetHash(*one.base.grid) == levelSetHash(*many.base.grid));
    CHECK(levelSetHash(*one.surface.grid) == levelSetHash(*many.surface.grid));
    CHECK(levelSetHash(*openvdb::gridConstPtrCast<openvdb::FloatGrid>(one.relief)) ==
          levelSetHash(*openvdb::gridConstPtrCast<openvdb::FloatGrid>(many.relief)));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              extractRelief(model, withRadius(2), ctx);
          }).code == int(ErrorCode::Cancelled));
}
