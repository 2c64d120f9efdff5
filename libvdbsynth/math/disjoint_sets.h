#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Sets of numbered elements that are merged step by step [tarjan1975], with path halving and the lowest
/// number as root.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count = 0) {
        for (std::size_t i = 0; i < count; ++i) add();
    }
    /// Adds one element, alone in its set.
    void add() { mParents.push_back(std::uint32_t(mParents.size())); }
    /// The lowest element of i's set.
    std::uint32_t root(std::uint32_t i) {
        while (mParents[i] != i) i = mParents[i] = mParents[mParents[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        mParents[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> mParents;
};

}  // namespace vdbsynth
