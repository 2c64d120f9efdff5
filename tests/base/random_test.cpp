#include "libvdbsynth/base/random.h"

#include <catch2/catch.hpp>

#include <vector>

using namespace vdbsynth;

TEST_CASE("philox: the published test vectors of Random123", "[base][oracle]") {
    using Four = std::array<std::uint32_t, 4>;
    CHECK(philox({0, 0, 0, 0}, {0, 0}) == Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
          Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
          Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Random: a stream depends on seed, element and purpose only", "[base][determinism]") {
    Random a(5, 9, 1), b(5, 9, 1);
    for (int i = 0; i < 10; ++i) CHECK(a.bits() == b.bits());
    CHECK(Random(5, 9, 1).bits() != Random(6, 9, 1).bits());
    CHECK(Random(5, 9, 1).bits() != Random(5, 10, 1).bits());
    CHECK(Random(5, 9, 1).bits() != Random(5, 9, 2).bits());
}

TEST_CASE("Random: uniform, below and normal have the right range and moments", "[base][property]") {
    double sum = 0, normals = 0, squares = 0;
    std::vector<int> counts(7, 0);
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
        Random random(1, std::uint64_t(i));
        const double u = random.uniform();
        REQUIRE((u >= 0 && u < 1));
        sum += u;
        const std::uint32_t k = random.below(7);
        REQUIRE(k < 7);
        ++counts[k];
        const double n = random.normal();
        normals += n;
        squares += n * n;
    }
    CHECK(sum / kDraws == Approx(0.5).margin(0.01));
    CHECK(normals / kDraws == Approx(0).margin(0.03));
    CHECK(squares / kDraws == Approx(1).margin(0.04));
    for (int count : counts) CHECK(count == Approx(kDraws / 7.0).epsilon(0.1));
}
