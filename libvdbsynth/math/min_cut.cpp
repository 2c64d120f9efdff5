#include "libvdbsynth/math/min_cut.h"

#include "libvdbsynth/base/error.h"

// To compilers, Boost seems to read an iterator before it is set.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include <algorithm>

namespace vdbsynth {
namespace {

using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                 boost::no_property, std::uint32_t, std::uint32_t>;
using GraphEdge = boost::graph_traits<Graph>::edge_descriptor;

// Every connection as two arcs, each the reverse of the other, sorted by source node.
class Network {
public:
    explicit Network(std::uint32_t nodes) : mNodes(nodes) {}

    void reserve(std::size_t connections) { mArcs.reserve(2 * connections); }

    void connect(std::uint32_t from, std::uint32_t to, std::int64_t forth, std::int64_t reverse = 0) {
        mArcs.push_back({from, to, forth, mArcs.size() + 1});
        mArcs.push_back({to, from, reverse, mArcs.size() - 1});
    }

    // 1 for nodes that still reach the sink at maximum flow.
    std::vector<std::uint8_t> reachingSink(std::uint32_t source, std::uint32_t sink) const {
        std::vector<std::size_t> order(mArcs.size());
        std::vector<std::uint32_t> begin(std::size_t(mNodes) + 1, 0);
        for (const Arc& arc : mArcs) ++begin[arc.from + 1];
        for (std::size_t v = 0; v < mNodes; ++v) begin[v + 1] += begin[v];
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1), at(mArcs.size());
        for (std::size_t i = 0; i < mArcs.size(); ++i) {
            at[i] = next[mArcs[i].from]++;
            order[at[i]] = i;
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
        std::vector<std::int64_t> capacity, residual(mArcs.size());
        ends.reserve(mArcs.size());
        capacity.reserve(mArcs.size());
        for (std::size_t i : order) {
            ends.emplace_back(mArcs[i].from, mArcs[i].to);
            capacity.push_back(mArcs[i].capacity);
        }
        const Graph graph(boost::edges_are_sorted, ends.begin(), ends.end(), mNodes);
        std::vector<GraphEdge> back, into(mNodes);
        back.reserve(mArcs.size());
        for (std::size_t i : order) back.push_back(GraphEdge(mArcs[i].to, at[mArcs[i].back]));
        std::vector<boost::default_color_type> side(mNodes);
        std::vector<std::uint32_t> distance(mNodes);
        using boost::make_iterator_property_map;
        const auto number = get(boost::edge_index, graph);
        const auto vertex = get(boost::vertex_index, graph);
        boost::boykov_kolmogorov_max_flow(graph, make_iterator_property_map(capacity.begin(), number),
                                          make_iterator_property_map(residual.begin(), number),
                                          make_iterator_property_map(back.begin(), number),
                                          make_iterator_property_map(into.begin(), vertex),
                                          make_iterator_property_map(side.begin(), vertex),
                                          make_iterator_property_map(distance.begin(), vertex), vertex,
                                          source, sink);
        std::vector<std::uint8_t> beyond(mNodes);
        for (std::size_t v = 0; v < mNodes; ++v) beyond[v] = side[v] == boost::white_color;
        return beyond;
    }

private:
    struct Arc {
        std::uint32_t from, to;
        std::int64_t capacity;
        std::size_t back;
    };
    std::uint32_t mNodes;
    std::vector<Arc> mArcs;
};

}  // namespace

#pragma GCC diagnostic pop

std::vector<std::uint8_t> leastCostAnswers(const CutProblem& problem) {
    const std::uint32_t nodes = std::uint32_t(problem.yes.size()), source = nodes, sink = nodes + 1;
    for (const CutProblem::Edge& edge : problem.edges)
        if (edge.from >= nodes || edge.to >= nodes || edge.cost < 0)
            throw Error(ErrorCode::InvalidOption,
                        "a minimum-cut edge has an invalid node or a negative cost");
    // If no single node is cheaper as a yes, no set of nodes is.
    if (std::none_of(problem.yes.begin(), problem.yes.end(), [](std::int64_t y) { return y < 0; })) return {};
    Network network(nodes + 2);
    network.reserve(nodes + problem.edges.size());
    for (std::uint32_t i = 0; i < nodes; ++i) {
        const std::int64_t yes = problem.yes[i];
        if (yes > 0) network.connect(source, i, yes);
        if (yes < 0) network.connect(i, sink, -yes);
    }
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        const CutProblem::Edge& edge = problem.edges[e];
        // Callers name both directions one after the other: one pair of arcs holds them.
        const bool both = e + 1 < problem.edges.size() && problem.edges[e + 1].from == edge.to &&
                          problem.edges[e + 1].to == edge.from;
        const std::int32_t reverse = both ? problem.edges[e + 1].cost : 0;
        if (edge.cost > 0 || reverse > 0) network.connect(edge.from, edge.to, edge.cost, reverse);
        if (both) ++e;
    }
    std::vector<std::uint8_t> answers = network.reachingSink(source, sink);
    answers.resize(nodes);
    if (std::find(answers.begin(), answers.end(), 1) == answers.end()) answers.clear();
    return answers;
}

}  // namespace vdbsynth
