#include "libvdbsynth/search/block_correlation.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <cmath>

#include "libvdbsynth/search/block_cost.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

struct Asked {
    std::vector<float> samples;
    std::vector<std::uint8_t> known;  // empty: everywhere
    BlockQuery query() const {
        BlockQuery query;
        query.samples = samples.data();
        query.known = known.empty() ? nullptr : known.data();
        return query;
    }
};

Asked ask(int block, std::uint64_t seed, bool masked) {
    Asked asked;
    for (std::uint64_t i = 0; i < std::uint64_t(block) * std::uint64_t(block) * std::uint64_t(block); ++i) {
        Random random(seed, i);
        asked.samples.push_back(float(random.uniform(-4, 5)));
        if (masked) asked.known.push_back(random.below(3) != 0);
    }
    return asked;
}

// Largest share of what is allowed by which a cost is off, over all positions; counts the positions.
double worstShare(const BrickField& exemplar, int block, const std::vector<Asked>& asked, std::size_t& seen,
                  const BlockCorrelation& correlation) {
    std::vector<BlockQuery> queries;
    for (const Asked& a : asked) queries.push_back(a.query());
    BlockCorrelation::Workspace workspace;
    double worst = 0;
    seen = 0;
    correlation.costs(queries[0], queries.size() > 1 ? &queries[1] : nullptr, workspace,
                      [&](int slot, int x, int y, const float* costs, int count, float off) {
                          const BlockQuery& query = queries[std::size_t(slot)];
                          for (int z = 0; z < count; ++z, ++seen) {
                              const double exact =
                                  blockCost(exemplar, {x, y, z}, block, query.samples, query.known,
                                            countKnown(query.known, block), 1e30);
                              worst = std::max(worst, std::abs(double(costs[z]) - exact) / double(off));
                          }
                      });
    return worst;
}

}  // namespace

TEST_CASE("BlockCorrelation: blockCost at every position, off by no more than is said", "[search][oracle]") {
    const std::vector<BrickField> exemplars{test::noiseField({19, 16, 21}, 1),
                                            test::ballsField({30, 26, 23}, 2, 4.f),
                                            BrickField(IndexBox::fromSize({17, 18, 19}), 2.f)};
    for (const BrickField& exemplar : exemplars)
        for (int block : {4, 7, 8}) {
            const BlockCorrelation correlation(exemplar, block);
            const Index3 size = exemplar.box().size();
            const std::size_t positions =
                std::size_t((size.x - block + 1) * (size.y - block + 1) * (size.z - block + 1));
            for (const auto& masks : {std::vector<bool>{false},
                                      {true},
                                      {false, false},
                                      {true, false},
                                      {false, true},
                                      {true, true}}) {
                INFO("block " << block << ", " << masks.size() << " queries");
                std::vector<Asked> asked;
                for (bool masked : masks) asked.push_back(ask(block, asked.size() + 1, masked));
                std::size_t seen = 0;
                const double worst = worstShare(exemplar, block, asked, seen, correlation);
                CHECK(seen == positions * masks.size());
                CHECK(worst <= 1);
            }
        }
}

TEST_CASE("BlockCorrelation: what may be off stays small beside the costs", "[search][property]") {
    const BrickField exemplar = test::ballsField({40, 40, 40}, 2, 5.f);
    const BlockCorrelation correlation(exemplar, 8);
    const Asked asked = ask(8, 1, true);
    BlockCorrelation::Workspace workspace;
    const BlockQuery query = asked.query();
    correlation.costs(query, nullptr, workspace,
                      [&](int, int, int, const float* costs, int count, float off) {
                          for (int z = 0; z < count; ++z) REQUIRE(off < 0.01f * costs[z]);
                      });
}

TEST_CASE("BlockCorrelation: the same bits for any number of threads, cancelled when asked",
          "[search][determinism][cancel]") {
    const BrickField exemplar = test::noiseField({33, 30, 31}, 7);
    const Asked asked = ask(8, 2, true);
    std::vector<std::vector<float>> found;
    for (int threads : {1, 2, 5}) {
        RunContext ctx;
        ctx.threads = threads;
        const BlockCorrelation correlation(exemplar, 8, ctx);
        found.emplace_back();
        BlockCorrelation::Workspace workspace;
        const BlockQuery query = asked.query();
        correlation.costs(query, nullptr, workspace,
                          [&](int, int, int, const float* costs, int count, float off) {
                              found.back().insert(found.back().end(), costs, costs + count);
                              found.back().push_back(off);
                          });
    }
    CHECK(found[0] == found[1]);
    CHECK(found[0] == found[2]);
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { BlockCorrelation(exemplar, 8, stopped); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("BlockCorrelation: memory is what was said before", "[search][property]") {
    const BrickField exemplar = test::noiseField({64, 48, 50}, 7);
    const BlockCorrelation correlation(exemplar, 8);
    const double said = BlockCorrelation::memoryNeeded({64, 48, 50}, 8);
    CHECK(double(correlation.memoryBytes()) < said);
    CHECK(double(correlation.memoryBytes()) > 0.5 * said);
    CHECK(correlation.work() == BlockCorrelation::work({64, 48, 50}));
    CHECK(BlockCorrelation::work({128, 96, 100}) > 7 * correlation.work());
}
