#include "libvdbsynth/base/random.h"

namespace vdbsynth {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) noexcept {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = std::uint64_t(0xD2511F53u) * counter[0];
        const std::uint64_t product1 = std::uint64_t(0xCD9E8D57u) * counter[2];
        counter = {std::uint32_t(product1 >> 32) ^ counter[1] ^ key[0], std::uint32_t(product1),
                   std::uint32_t(product0 >> 32) ^ counter[3] ^ key[1], std::uint32_t(product0)};
        key[0] += 0x9E3779B9u;
        key[1] += 0xBB67AE85u;
    }
    return counter;
}

Random::Random(std::uint64_t seed, std::uint64_t element, std::uint32_t purpose) noexcept
    : mCounter{0, purpose, std::uint32_t(element), std::uint32_t(element >> 32)},
      mKey{std::uint32_t(seed), std::uint32_t(seed >> 32)} {}

std::uint32_t Random::bits() noexcept {
    if (mUsed == 4) {
        mBlock = philox(mCounter, mKey);
        ++mCounter[0];
        mUsed = 0;
    }
    return mBlock[std::size_t(mUsed++)];
}

double Random::uniform() noexcept {
    const std::uint64_t high = bits() >> 5;
    const std::uint64_t low = bits() >> 6;
    return double((high << 26) | low) * 0x1.0p-53;
}

double Random::uniform(double low, double high) noexcept {
    return low + (high - low) * uniform();
}

std::uint32_t Random::below(std::uint32_t count) noexcept {
    return std::uint32_t((std::uint64_t(bits()) * count) >> 32);
}

double Random::normal() noexcept {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
}

}  // namespace vdbsynth
