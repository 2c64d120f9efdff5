#include "libvdbsynth/base/checked_product.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace vdbsynth;

namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

}  // namespace

TEST_CASE("checkedProduct: products that fit are exact", "[base][fast]") {
    CHECK(checkedProduct({}) == 1);
    CHECK(checkedProduct({7}) == 7);
    CHECK(checkedProduct({3, 5, 7}) == 105);
    CHECK(checkedProduct({kMost, 1}) == kMost);
    CHECK(checkedProduct({std::int64_t(1) << 31, std::int64_t(1) << 31}) == std::int64_t(1) << 62);
}

TEST_CASE("checkedProduct: what wraps or is negative is nothing, a zero is zero wherever it stands",
          "[base][error]") {
    CHECK_FALSE(checkedProduct({std::int64_t(1) << 32, std::int64_t(1) << 31}));
    CHECK_FALSE(checkedProduct({std::int64_t(1) << 60, 16}));  // 2^64, which wraps to 0
    CHECK_FALSE(checkedProduct({kMost, kMost, kMost}));
    CHECK_FALSE(checkedProduct({-1, -1}));
    CHECK_FALSE(checkedProduct({0, -1}));
    CHECK_FALSE(checkedProduct({std::numeric_limits<std::int64_t>::min()}));
    CHECK(checkedProduct({kMost, kMost, 0}) == 0);
    CHECK(checkedProduct({0, kMost, kMost}) == 0);
}

TEST_CASE("productFits: compares with what is there", "[base][fast]") {
    CHECK(productFits({10, 10}, 100));
    CHECK_FALSE(productFits({10, 10}, 99));
    CHECK_FALSE(productFits({-10, -10}, 1000));
    CHECK(productFits({kMost}, std::numeric_limits<std::uint64_t>::max()));
    CHECK_FALSE(productFits({kMost, 2}, std::numeric_limits<std::uint64_t>::max()));
}
