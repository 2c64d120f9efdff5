#include "libvdbsynth/render/streaks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

TEST_CASE("Streaks: nearly constant along the field, of many values across it", "[render]") {
    openvdb::initialize();
    const auto field = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    field->fill(openvdb::CoordBBox({0, 0, 0}, {63, 63, 3}), openvdb::Vec3f(2, 0, 0), true);
    Streaks streaks(field);
    double along = 0, across = 0;
    for (int i = 20; i < 40; ++i)
        for (int j = 20; j < 40; ++j) {
            const double here = streaks.at({double(i), double(j), 1});
            CHECK((here >= 0 && here <= 1));
            along += std::abs(streaks.at({i + 1.0, double(j), 1}) - here);
            across += std::abs(streaks.at({double(i), j + 1.0, 1}) - here);
        }
    CHECK(across > 3 * along);
    CHECK(across > 0.15 * 400);
    CHECK(streaks.at({100, 0, 0}) < 0);
    Streaks copy(streaks);
    CHECK(copy.at({30, 30, 1}) == streaks.at({30, 30, 1}));
}

TEST_CASE("Streaks: other grids are refused", "[render][error]") {
    const test::Thrown thrown = test::thrownBy([] { Streaks{openvdb::FloatGrid::create()}; });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "vectors of floats"));
    CHECK(test::thrownBy([] { Streaks{nullptr}; }).code == int(ErrorCode::InvalidOption));
}
