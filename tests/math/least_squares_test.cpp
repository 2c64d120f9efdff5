#include "libvdbsynth/math/least_squares.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"

#include <cmath>

using namespace vdbsynth;

TEST_CASE("fitAffine: a line through points, by hand", "[math]") {
    const AffineMap map = fitAffine({0, 1, 2, 3}, 1, {5, 7, 9, 11});
    REQUIRE(map.weights.size() == 1);
    CHECK(map.weights[0] == Approx(2));
    CHECK(map.constant == Approx(5));
    const float x = 10;
    CHECK(map(&x) == Approx(25));
    // Points off the line on both sides alike leave it where it is.
    CHECK(fitAffine({0, 0, 2, 2}, 1, {4, 6, 8, 10}).weights[0] == Approx(2));
}

TEST_CASE("fitAffine: finds the map that made the values, over many parts of rows", "[math][property]") {
    constexpr std::size_t kLength = 7, kRows = 10000;
    std::vector<float> rows, values;
    for (std::uint64_t r = 0; r < kRows; ++r) {
        Random random(3, r);
        double value = 0.25;
        for (std::size_t k = 0; k < kLength; ++k) {
            rows.push_back(float(100 + random.normal()));
            value += (double(k) - 3) * double(rows.back());
        }
        values.push_back(float(value));
    }
    const AffineMap map = fitAffine(rows, kLength, values);
    for (std::size_t k = 0; k < kLength; ++k) CHECK(map.weights[k] == Approx(double(k) - 3).margin(1e-3));
}

TEST_CASE("fitAffine: no row beats it by another weight", "[math][property]") {
    std::vector<float> rows, values;
    for (std::uint64_t r = 0; r < 500; ++r) {
        Random random(4, r);
        rows.push_back(float(random.uniform()));
        rows.push_back(float(random.uniform()));
        values.push_back(float(std::sin(5 * double(rows[2 * r])) + random.normal() * 0.1));
    }
    const AffineMap map = fitAffine(rows, 2, values);
    const auto squares = [&](const AffineMap& of) {
        double sum = 0;
        for (std::size_t r = 0; r < values.size(); ++r)
            sum += std::pow(double(values[r] - of(rows.data() + 2 * r)), 2);
        return sum;
    };
    for (std::size_t k = 0; k < 2; ++k)
        for (float by : {-0.01f, 0.01f}) {
            AffineMap other = map;
            other.weights[k] += by;
            CHECK(squares(other) > squares(map));
        }
}

TEST_CASE("fitAffine: rows that are all alike give their values' mean", "[math]") {
    const AffineMap map = fitAffine({2, 3, 2, 3, 2, 3}, 2, {1, 2, 6});
    const float row[2] = {2, 3};
    CHECK(map(row) == Approx(3));
}
