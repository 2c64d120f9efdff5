#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A yes or no for each of a number of nodes, and what combinations cost. Costs are whole numbers, so that
/// sums are exact.
struct CutProblem {
    /// What node `from` being no while node `to` is yes costs.
    struct Edge {
        std::uint32_t from = 0, to = 0;
        std::int32_t cost = 0;  ///< at least 0
    };

    std::vector<std::int64_t> yes;  ///< [node] what a yes costs more than a no; under 0: less
    std::vector<Edge> edges;
};

/// The answers with the least sum of costs, by a minimum cut: the maximum flow of [boykov2004]. Of several
/// such answers the one with the fewest nodes that say yes.
/// @return [node] 1 for yes. Empty if no node does
/// @throw Error InvalidOption (an edge names a node that is none, or costs under 0)
/// @par Cost    O(nodes + edges) memory, about 100 bytes an edge; time near linear where few answers are open
/// @par Repeats same bits
std::vector<std::uint8_t> leastCostAnswers(const CutProblem& problem);

}  // namespace vdbsynth
