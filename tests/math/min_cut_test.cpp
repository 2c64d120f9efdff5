#include "libvdbsynth/math/min_cut.h"

#include <catch2/catch.hpp>

#include <limits>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

namespace {

std::int64_t costOf(const CutProblem& problem, const std::vector<std::uint8_t>& answers) {
    std::int64_t cost = 0;
    for (std::size_t i = 0; i < problem.yes.size(); ++i) cost += answers[i] ? problem.yes[i] : 0;
    for (const CutProblem::Edge& edge : problem.edges)
        cost += !answers[edge.from] && answers[edge.to] ? edge.cost : 0;
    return cost;
}

// The least cost, and the fewest that say yes at it, by looking at all answers.
std::pair<std::int64_t, int> leastByLooking(const CutProblem& problem) {
    std::pair<std::int64_t, int> least{std::numeric_limits<std::int64_t>::max(), 0};
    const std::size_t nodes = problem.yes.size();
    for (std::uint32_t bits = 0; bits < 1u << nodes; ++bits) {
        std::vector<std::uint8_t> answers;
        int yes = 0;
        for (std::size_t i = 0; i < nodes; ++i) answers.push_back(bits >> i & 1), yes += answers.back();
        least = std::min(least, {costOf(problem, answers), yes});
    }
    return least;
}

CutProblem randomProblem(std::uint64_t seed) {
    Random random(seed, 0);
    CutProblem problem;
    const std::uint32_t nodes = 1 + random.below(9);
    for (std::uint32_t i = 0; i < nodes; ++i) problem.yes.push_back(std::int64_t(random.below(21)) - 10);
    for (std::uint32_t k = random.below(25); k > 0; --k)
        problem.edges.push_back({random.below(nodes), random.below(nodes), std::int32_t(random.below(8))});
    return problem;
}

}  // namespace

TEST_CASE("leastCostAnswers: by hand", "[math]") {
    CutProblem problem;
    problem.yes = {-5, 3, 4};
    problem.edges = {{1, 0, 4}, {2, 1, 2}};
    // Alone the first gains 5 and pays 4 to the second, with the second it gains 5 - 3 - 2: 1 is as good as
    // 0 is not, and fewer is better.
    CHECK(leastCostAnswers(problem) == std::vector<std::uint8_t>{1, 0, 0});
    problem.edges[0].cost = 6;
    CHECK(leastCostAnswers(problem).empty());
    problem.yes[1] = 0;
    CHECK(leastCostAnswers(problem) == std::vector<std::uint8_t>{1, 1, 0});
}

TEST_CASE("leastCostAnswers: what looking at all answers finds", "[math][oracle]") {
    int some = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        const CutProblem problem = randomProblem(seed);
        std::vector<std::uint8_t> answers = leastCostAnswers(problem);
        some += !answers.empty();
        answers.resize(problem.yes.size(), 0);
        int yes = 0;
        for (std::uint8_t answer : answers) yes += answer;
        CAPTURE(seed);
        REQUIRE(std::make_pair(costOf(problem, answers), yes) == leastByLooking(problem));
    }
    CHECK(some > 100);
}

TEST_CASE("leastCostAnswers: nothing to ask, and edges to nowhere", "[math][error]") {
    CHECK(leastCostAnswers({}).empty());
    CutProblem problem;
    problem.yes = {-1};
    problem.edges = {{0, 1, 1}};
    CHECK_THROWS_AS(leastCostAnswers(problem), Error);
    problem.edges = {{0, 0, -1}};
    CHECK_THROWS_AS(leastCostAnswers(problem), Error);
    problem.edges.clear();
    CHECK(leastCostAnswers(problem) == std::vector<std::uint8_t>{1});
}
