#include "libvdbsynth/vdb/convert/trilinear.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/vdb/coord.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

openvdb::FloatGrid::Ptr gridOf(const IndexBox& box, const std::function<float(const Index3&)>& value) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(100.f);
    auto accessor = grid->getAccessor();
    forEachVoxel(box, [&](const Index3& p) { accessor.setValue(toCoord(p), value(p)); });
    return grid;
}

Vec3d placeIn(const IndexBox& box, std::uint64_t i) {
    Random random(4, i);
    return {random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
            random.uniform(box.min.z, box.max.z)};
}

}  // namespace

TEST_CASE("TrilinearSampler: a trilinear function and its gradient, at negative places too",
          "[vdb][oracle]") {
    const auto value = [](double x, double y, double z) {
        return 2 * x - 3 * y + 0.5 * z + 0.25 * x * y * z;
    };
    const IndexBox box{{-9, -8, -7}, {7, 8, 9}};
    const auto grid = gridOf(box, [&](const Index3& p) { return float(value(p.x, p.y, p.z)); });
    TrilinearSampler sampler(*grid);
    for (std::uint64_t i = 0; i < 500; ++i) {
        const Vec3d p = placeIn(box, i);
        Vec3d gradient;
        REQUIRE(sampler.sample(p, gradient) == Approx(value(p.x, p.y, p.z)).margin(1e-4));
        REQUIRE(gradient.x == Approx(2 + 0.25 * p.y * p.z).margin(1e-4));
        REQUIRE(gradient.y == Approx(-3 + 0.25 * p.x * p.z).margin(1e-4));
        REQUIRE(gradient.z == Approx(0.5 + 0.25 * p.x * p.y).margin(1e-4));
    }
}

TEST_CASE("TrilinearSampler: as the sampling of bricks, the gradient that of differences within a cell",
          "[vdb][oracle]") {
    const BrickField field = test::noiseField({12, 12, 12}, 1);
    const auto grid = gridOf(field.box(), [&](const Index3& p) { return field.at(p); });
    TrilinearSampler sampler(*grid);
    for (std::uint64_t i = 0; i < 500; ++i) {
        Vec3d p = placeIn(field.box(), i);
        for (int axis = 0; axis < 3; ++axis)  // away from the faces of cells, where the gradient jumps
            p[axis] = std::floor(p[axis]) + std::clamp(p[axis] - std::floor(p[axis]), 0.01, 0.99);
        Vec3d gradient, ignored;
        REQUIRE(sampler.sample(p, gradient) == Approx(sampleTrilinear(field, cast<float>(p))).margin(1e-5));
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d low = p, high = p;
            low[axis] -= 1e-3;
            high[axis] += 1e-3;
            const double slope = (sampler.sample(high, ignored) - sampler.sample(low, ignored)) / 2e-3;
            REQUIRE(gradient[axis] == Approx(slope).margin(1e-6));
        }
    }
}

TEST_CASE("TrilinearSampler: the voxel's own value at its centre, the background outside",
          "[vdb][degenerate]") {
    const auto grid =
        gridOf({{0, 0, 0}, {1, 1, 1}}, [](const Index3& p) { return float(p.x + 2 * p.y + 4 * p.z); });
    TrilinearSampler sampler(*grid);
    Vec3d gradient;
    CHECK(sampler.sample({1, 0, 1}, gradient) == 5);
    CHECK(sampler.sample({0.5, 0.5, 0.5}, gradient) == 3.5);
    CHECK(sampler.sample({-50.5, 0, 3}, gradient) == 100);
    CHECK(length(gradient) == 0);
    CHECK(sampler.sample({-0.5, 0, 0}, gradient) == 50);
    CHECK(gradient.x == -100);
    CHECK(sampler.accessor().getValue({1, 1, 1}) == 7);
}
