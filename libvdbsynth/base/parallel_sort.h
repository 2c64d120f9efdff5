#pragma once
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <vector>

namespace vdbsynth {

/// Sorts on all of the context's threads: fixed chunks, then rounds of merging neighbours.
/// @param less  a strict weak ordering; elements that are equal by it keep no particular order, so give one
///              that tells all apart where bits must repeat
/// @throw Error Cancelled (the elements are then in any order)
/// @par Cost    O(n log n), memory of half the elements once more
/// @par Repeats same order for any number of threads
template <typename T, typename Less = std::less<T>>
void parallelSort(const RunContext& ctx, std::vector<T>& elements, Less less = {}) {
    constexpr std::size_t kChunks = 16;
    const auto at = [&](std::size_t chunk) {
        return elements.begin() + std::ptrdiff_t(elements.size() * std::min(chunk, kChunks) / kChunks);
    };
    parallelFor(ctx, kChunks, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) std::sort(at(c), at(c + 1), less);
    });
    for (std::size_t width = 1; width < kChunks; width *= 2)
        parallelFor(ctx, kChunks / (2 * width), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m)
                std::inplace_merge(at(2 * m * width), at((2 * m + 1) * width), at((2 * m + 2) * width), less);
        });
}

}  // namespace vdbsynth
