#include "libvdbsynth/synth/target_size.h"

#include <catch2/catch.hpp>

#include <array>
#include <type_traits>

using namespace vdbsynth;

TEST_CASE("TargetSize: each axis has its own unit", "[synth]") {
    const TargetSize mixed(Extent::multiple(2), Extent::voxels(96), Extent::multiple(1.5));
    CHECK(mixed[0].over(40) == 80);
    CHECK(mixed[1].over(40) == 96);
    CHECK(mixed[2].over(40) == 60);
    CHECK(mixed.text() == "2x,96,1.5x");
    CHECK(TargetSize::voxels(128, 128, 64)[2].over(16) == 64);
    CHECK(TargetSize::multiples(1, 2, 3).text() == "1x,2x,3x");
    CHECK_FALSE(TargetSize::voxels(1, 2, 3)[0].isMultiple());
}

TEST_CASE("TargetSize: numbers without a unit are none", "[synth]") {
    CHECK_FALSE(std::is_constructible_v<Extent, int>);
    CHECK_FALSE(std::is_constructible_v<Extent, double>);
    CHECK_FALSE(std::is_constructible_v<TargetSize, int, int, int>);
    CHECK_FALSE(std::is_constructible_v<TargetSize, double, double, double>);
    CHECK_FALSE(std::is_assignable_v<TargetSize, std::array<double, 3>>);
}
