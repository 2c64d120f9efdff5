#include "libvdbsynth/points/point_cells.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

std::vector<std::uint32_t> nearOf(const PointCells& cells, const Vec3d& place) {
    std::vector<std::uint32_t> numbers;
    cells.near(place, [&](std::uint32_t number) { numbers.push_back(number); });
    return numbers;
}

}  // namespace

TEST_CASE("PointCells: cells in their order, numbers in that of adding, by hand") {
    PointCells cells(2);
    CHECK(nearOf(cells, {0, 0, 0}).empty());
    cells.add({1, 1, 1}, 7);
    cells.add({-1, 1, 1}, 5);
    cells.add({0.5, 0, 0}, 3);
    cells.add({4, 1, 1}, 9);  // two cells from the first
    CHECK(nearOf(cells, {1, 1, 1}) == std::vector<std::uint32_t>{5, 7, 3});
    CHECK(nearOf(cells, {3, 1, 1}) == std::vector<std::uint32_t>{7, 3, 9});
    CHECK(nearOf(cells, {100, 1, 1}).empty());
}

TEST_CASE("PointCells: all points within a side are found once each, as by looking at all") {
    const test::PointShape sphere = test::spiralSphere(2000, 10);
    const double side = 1.7;
    const PointCells cells(sphere.point, side);
    for (std::uint64_t n = 0; n < 200; ++n) {
        Random random(3, n);
        const Vec3d place{random.uniform(-11, 11), random.uniform(-11, 11), random.uniform(-11, 11)};
        std::vector<std::uint32_t> found = nearOf(cells, place);
        std::sort(found.begin(), found.end());
        REQUIRE(std::unique(found.begin(), found.end()) == found.end());
        for (std::uint32_t p = 0; p < sphere.point.size(); ++p)
            if (length(cast<double>(sphere.point[p]) - place) < side)
                REQUIRE(std::binary_search(found.begin(), found.end(), p));
    }
}

TEST_CASE("PointCells: anyNear asks no more after the first that holds") {
    PointCells cells(1);
    for (std::uint32_t n = 0; n < 5; ++n) cells.add({0.5, 0.5, 0.5}, n);
    std::vector<std::uint32_t> asked;
    CHECK(cells.anyNear({0, 0, 0}, [&](std::uint32_t n) {
        asked.push_back(n);
        return n == 2;
    }));
    CHECK(asked == std::vector<std::uint32_t>{0, 1, 2});
    CHECK(!cells.anyNear({0, 0, 0}, [](std::uint32_t) { return false; }));
}

TEST_CASE("PointCells: places far out, and a side that is refused") {
    PointCells cells(1e-3);
    const Vec3d far{1e30, -1e30, 3e38};
    cells.add(far, 1);
    CHECK(nearOf(cells, far) == std::vector<std::uint32_t>{1});
    for (const double side : {0.0, -1.0, std::nan("")})
        CHECK(test::thrownBy([&] { PointCells{side}; }).code == int(ErrorCode::InvalidOption));
}
