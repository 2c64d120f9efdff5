#pragma once
#include <array>
#include <cstdint>

namespace vdbsynth {

/// Counter-based random numbers: Philox4x32-10 [salmon2011, section 3.3]. A stream is named by
/// (seed, element) and its n-th number is a pure function of the three, so a loop over elements
/// gives the same numbers in any order and on any number of threads.
class Random {
public:
    /// @param seed     the run's seed
    /// @param element  the element (voxel, block, ball ...) that draws
    /// @param purpose  separates the draws of two algorithms for one element
    Random(std::uint64_t seed, std::uint64_t element, std::uint32_t purpose = 0) noexcept;

    /// Next 32 random bits.
    std::uint32_t bits() noexcept;
    /// Uniform in [0, 1), 53 bits.
    double uniform() noexcept;
    /// Uniform in [low, high).
    double uniform(double low, double high) noexcept;
    /// Uniform in 0 .. count-1; `count` at least 1. Unbiased to 2^-32.
    std::uint32_t below(std::uint32_t count) noexcept;
    /// Mean 0, variance 1, nearly normal: the sum of twelve uniforms minus six. Needs no logarithm, whose
    /// last bit may differ between processors.
    double normal() noexcept;

private:
    std::array<std::uint32_t, 4> mCounter;
    std::array<std::uint32_t, 2> mKey;
    std::array<std::uint32_t, 4> mBlock{};
    int mUsed = 4;
};

/// The Philox4x32-10 bijection, public for its published test vectors.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) noexcept;

}  // namespace vdbsynth
