#include "libvdbsynth/search/feature_index.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

namespace {

std::vector<float> randomRows(std::size_t count, std::size_t dimension, std::uint64_t seed) {
    std::vector<float> rows;
    for (std::uint64_t r = 0; r < count; ++r) {
        Random random(seed, r);
        for (std::size_t k = 0; k < dimension; ++k) rows.push_back(float(random.uniform(-1, 1)));
    }
    return rows;
}

}  // namespace

TEST_CASE("FeatureIndex: the nearest equals a linear scan's", "[search][property]") {
    for (std::size_t dimension : {3u, 8u, 17u}) {
        const std::vector<float> rows = randomRows(900, dimension, 1), queries = randomRows(60, dimension, 2);
        const FeatureIndex index(rows, dimension);
        REQUIRE(index.size() == 900);
        for (std::size_t q = 0; q < 60; ++q) {
            const float* query = queries.data() + q * dimension;
            const FeatureMatch expected = nearestLinearly(rows, dimension, query),
                               found = index.nearest(query, 1e9f);
            CHECK(found.row == expected.row);
            CHECK(found.squared == Approx(expected.squared));
            CHECK(index.squaredTo(query, found.row) == Approx(expected.squared));
        }
    }
}

TEST_CASE("FeatureIndex: nothing beyond the bound, and never worse than epsilon allows",
          "[search][property]") {
    const std::vector<float> rows = randomRows(2000, 6, 3), queries = randomRows(100, 6, 4);
    const FeatureIndex index(rows, 6);
    for (std::size_t q = 0; q < 100; ++q) {
        const float* query = queries.data() + q * 6;
        const FeatureMatch exact = nearestLinearly(rows, 6, query);
        CHECK(index.nearest(query, exact.squared * 0.99f).row == -1);
        CHECK(index.nearest(query, exact.squared * 1.01f).row == exact.row);
        for (float epsilon : {1.f, 4.f}) {
            const FeatureMatch near = index.nearest(query, 1e9f, epsilon);
            REQUIRE(near.row >= 0);
            CHECK(near.squared <= exact.squared * (1 + epsilon) * 1.0001f);
        }
    }
}

TEST_CASE("FeatureIndex: one row, equal rows, and the same answers from two builds", "[search]") {
    const FeatureIndex one(std::vector<float>{1, 2}, 2);
    const float at[2] = {1, 4};
    CHECK(one.nearest(at, 1e9f).row == 0);
    CHECK(one.nearest(at, 1e9f).squared == Approx(4));
    const FeatureIndex same(std::vector<float>(200, 0.5f), 2);
    const float there[2] = {0.5f, 0.5f};
    CHECK(same.nearest(there, 1e9f).squared == 0);
    const std::vector<float> rows = randomRows(3000, 9, 7), queries = randomRows(50, 9, 8);
    const FeatureIndex a(rows, 9), b(rows, 9);
    for (std::size_t q = 0; q < 50; ++q)
        CHECK(a.nearest(queries.data() + q * 9, 1e9f, 4).row ==
              b.nearest(queries.data() + q * 9, 1e9f, 4).row);
}
