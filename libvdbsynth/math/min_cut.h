#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A yes or no for each of a number of nodes, and the costs of combinations. Costs are whole numbers, so that
/// sums are exact.
struct CutProblem {
    /// Cost of `from` being no while `to` is yes.
    struct Edge {
        std::uint32_t from = 0, to = 0;
        std::int32_t cost = 0;  ///< at least 0
    };

    std::vector<std::int64_t> yes;  ///< [node] cost of yes minus cost of no
    std::vector<Edge> edges;
};

/// The answers with the least total cost, by a minimum cut: the maximum flow of [boykov2004]. Of several such
/// answers the one with the fewest yes nodes.
/// @return [node] 1 for yes. Empty if all are no
/// @throw Error InvalidOption (an edge with an invalid node or a negative cost)
/// @par Cost    O(nodes + edges) memory, about 100 bytes per edge; time near linear if few answers are open
/// @par Repeats same bits
std::vector<std::uint8_t> leastCostAnswers(const CutProblem& problem);

}  // namespace vdbsynth
