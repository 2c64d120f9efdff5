#include "libvdbsynth/math/disjoint_sets.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

TEST_CASE("DisjointSets: the lowest number is the root, whatever the order of joins", "[math][property]") {
    DisjointSets a(6), b(6);
    a.join(5, 3);
    a.join(3, 1);
    b.join(1, 3);
    b.join(1, 5);
    for (std::uint32_t i = 0; i < 6; ++i) CHECK(a.root(i) == b.root(i));
    CHECK(a.root(5) == 1);
    CHECK(a.root(4) == 4);
    a.add();
    CHECK(a.root(6) == 6);
}

TEST_CASE("DisjointSets: as labels that every join renames", "[math][oracle]") {
    constexpr std::uint32_t kCount = 300;
    DisjointSets sets(kCount);
    std::vector<std::uint32_t> labels;
    for (std::uint32_t i = 0; i < kCount; ++i) labels.push_back(i);
    Random random(4, 1);
    for (int step = 0; step < 250; ++step) {
        const std::uint32_t a = random.below(kCount), b = random.below(kCount);
        sets.join(a, b);
        const std::uint32_t low = std::min(labels[a], labels[b]), high = std::max(labels[a], labels[b]);
        std::replace(labels.begin(), labels.end(), high, low);
        if (step % 25 != 0) continue;
        for (std::uint32_t i = 0; i < kCount; ++i) REQUIRE(sets.root(i) == labels[i]);
    }
    std::ptrdiff_t largest = 0;
    for (std::uint32_t label : labels)
        largest = std::max(largest, std::count(labels.begin(), labels.end(), label));
    CHECK(largest > 10);
}

TEST_CASE("DisjointSets: joins again and with itself change nothing, long chains have one root",
          "[math][degenerate]") {
    DisjointSets none;
    none.add();
    none.join(0, 0);
    CHECK(none.root(0) == 0);
    constexpr std::uint32_t kLong = 20000;
    DisjointSets chain(kLong);
    for (std::uint32_t i = kLong - 1; i > 0; --i) chain.join(i, i - 1);
    chain.join(kLong - 1, 0);
    for (std::uint32_t i = 0; i < kLong; i += 97) REQUIRE(chain.root(i) == 0);
}
