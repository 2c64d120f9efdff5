#include "libvdbsynth/search/block_correlation.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

struct Case {
    std::string name;
    BrickField field;
};

std::vector<Case> exemplars() {
    std::vector<Case> cases;
    cases.push_back({"noise", test::noiseField({18, 16, 20}, 1)});
    cases.push_back({"smooth", test::ballsField({26, 24, 28}, 2, 4.f)});
    cases.push_back({"mostly constant", test::ballsField({40, 32, 36}, 3, 2.f, 2)});
    cases.push_back({"constant", BrickField(IndexBox::fromSize({20, 17, 18}), 2.f)});
    cases.push_back({"periodic", test::periodicField({21, 20, 22}, 5)});
    cases.push_back({"few values", test::fieldFrom({20, 20, 20}, [](const Index3& p) {
                         return float(
                             Random(8, std::uint64_t((p.x / 4 * 100 + p.y / 4) * 100 + p.z / 4)).below(2));
                     })});
    return cases;
}

// A query of one of several kinds: cut from the exemplar, with noise, from elsewhere, constant.
std::vector<float> querySamples(const BrickField& field, int block, std::uint64_t seed) {
    Random random(seed, 0);
    const Index3 size = field.box().size();
    const Index3 corner{int(random.below(std::uint32_t(size.x - block + 1))),
                        int(random.below(std::uint32_t(size.y - block + 1))),
                        int(random.below(std::uint32_t(size.z - block + 1)))};
    std::vector<float> samples(std::size_t(block * block * block));
    field.readBox(corner, {block, block, block}, samples.data());
    const std::uint32_t kind = random.below(4);
    for (float& sample : samples) {
        if (kind == 1) sample += float(random.uniform(-0.3, 0.3));
        if (kind == 2) sample = float(random.uniform(-2, 2));
        if (kind == 3) sample = 2.f;
    }
    return samples;
}

std::vector<std::uint8_t> octantMask(int block, int octant) {
    std::vector<std::uint8_t> known;
    for (int x = 0; x < block; ++x)
        for (int y = 0; y < block; ++y)
            for (int z = 0; z < block; ++z)
                known.push_back(((x >= block / 2) * 4 + (y >= block / 2) * 2 + (z >= block / 2)) != octant);
    return known;
}

void requireSame(const std::vector<BlockMatch>& a, const std::vector<BlockMatch>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        REQUIRE(a[i].cost == b[i].cost);
        REQUIRE(a[i].position == b[i].position);
    }
}

std::shared_ptr<const BrickField> ballIn(int side) {
    return std::make_shared<const BrickField>(test::fieldFrom({side, side, side}, [](const Index3& p) {
        const float x = float(p.x) - 20, y = float(p.y) - 20, z = float(p.z) - 20;
        return std::clamp(std::sqrt(x * x + y * y + z * z) - 8, -4.f, 4.f);
    }));
}

BlockSearchOptions by(BlockSearchWay way, int count) {
    BlockSearchOptions options;
    options.way = way;
    options.count = count;
    return options;
}

}  // namespace

TEST_CASE("BlockIndex: the best K equal those of a linear scan, ties by position", "[search][property]") {
    for (const Case& c : exemplars()) {
        const auto field = std::make_shared<const BrickField>(c.field);
        for (int block : {4, 5, 7, 8, 12}) {
            BlockIndexOptions options;
            options.block = block;
            const BlockIndex index = BlockIndex::build(field, options);
            for (std::uint64_t seed = 0; seed < 12; ++seed) {
                INFO(c.name << ", block " << block << ", seed " << seed);
                const std::vector<float> samples =
                    querySamples(c.field, block, seed * 31 + std::uint64_t(block));
                BlockQuery query;
                query.samples = samples.data();
                const int count = seed % 3 == 0 ? 1 : int(seed);
                const auto exact = matchBlocksLinearly(c.field, block, query, count);
                for (BlockSearchWay way :
                     {BlockSearchWay::Planned, BlockSearchWay::Bounds, BlockSearchWay::Correlation})
                    requireSame(index.match(query, by(way, count)), exact);
            }
        }
    }
}

TEST_CASE("BlockIndex: exact under any mask, inside any box of candidates, with any hints",
          "[search][property]") {
    for (const Case& c : exemplars()) {
        const auto field = std::make_shared<const BrickField>(c.field);
        for (int block : {6, 8}) {
            BlockIndexOptions options;
            options.block = block;
            const BlockIndex index = BlockIndex::build(field, options);
            for (std::uint64_t seed = 0; seed < 16; ++seed) {
                INFO(c.name << ", block " << block << ", seed " << seed);
                Random random(seed, 1);
                const std::vector<float> samples = querySamples(c.field, block, seed * 17 + 5);
                std::vector<std::uint8_t> known = octantMask(block, int(seed % 8));
                if (seed % 4 == 1)
                    for (std::uint8_t& k : known) k = random.below(2) != 0;
                if (seed % 4 == 2) known.assign(known.size(), seed % 8 == 2);
                BlockQuery query;
                query.samples = samples.data();
                query.known = known.data();
                const Index3 last = index.positions().max;
                if (seed % 2) {
                    for (int axis = 0; axis < 3; ++axis) {
                        const int a = int(random.below(std::uint32_t(last[axis] + 1))),
                                  b = int(random.below(std::uint32_t(last[axis] + 1)));
                        query.candidates.min[axis] = std::min(a, b);
                        query.candidates.max[axis] = std::max(a, b);
                    }
                }
                for (int h = 0; h < 3; ++h)
                    query.hints.push_back(
                        {int(random.below(40)) - 5, int(random.below(30)) - 5, int(random.below(30)) - 5});
                const auto exact = matchBlocksLinearly(c.field, block, query, 3);
                for (BlockSearchWay way :
                     {BlockSearchWay::Planned, BlockSearchWay::Bounds, BlockSearchWay::Correlation})
                    requireSame(index.match(query, by(way, 3)), exact);
            }
        }
    }
}

TEST_CASE("BlockIndex: with an exemplar mask only blocks wholly inside it are found", "[search][property]") {
    const BrickField field = test::ballsField({28, 28, 28}, 5, 3.f);
    const BrickField mask =
        test::fieldFrom({28, 28, 28}, [](const Index3& p) { return p.x < 17 && p.y > 5 ? 1.f : 0.f; });
    BlockIndexOptions options;
    options.block = 8;
    options.mask = &mask;
    const BlockIndex index = BlockIndex::build(std::make_shared<const BrickField>(field), options);
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const std::vector<float> samples = querySamples(field, 8, seed);
        BlockQuery query;
        query.samples = samples.data();
        const std::vector<BlockMatch> found = index.match(query, 4);
        requireSame(found, matchBlocksLinearly(field, 8, query, 4, &mask));
        requireSame(found, index.match(query, by(BlockSearchWay::Correlation, 4)));
        for (const BlockMatch& match : found) CHECK((match.position.x <= 9 && match.position.y >= 6));
    }
    const BrickField nothing(field.box(), 0.f);
    options.mask = &nothing;
    const test::Thrown thrown =
        test::thrownBy([&] { BlockIndex::build(std::make_shared<const BrickField>(field), options); });
    CHECK(thrown.code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown.message, "`exemplarMask`"));
}

TEST_CASE("BlockIndex: constant regions and repeats are one node", "[search][property]") {
    BlockIndexOptions options;
    options.block = 8;
    const auto constant =
        std::make_shared<const BrickField>(BrickField(IndexBox::fromSize({40, 40, 40}), 1.f));
    CHECK(BlockIndex::build(constant, options).nodeCount() == 1);
    const auto periodic = std::make_shared<const BrickField>(test::periodicField({24, 24, 24}, 5));
    CHECK(BlockIndex::build(periodic, options).nodeCount() == 125);
    const auto half = std::make_shared<const BrickField>(
        test::fieldFrom({48, 16, 16}, [](const Index3& p) { return p.x < 24 ? -3.f : 3.f; }));
    // Two constant nodes and one for each way the step can lie in the block.
    CHECK(BlockIndex::build(half, options).nodeCount() == 9);
}

TEST_CASE("BlockIndex: on a distance field most costs are never computed", "[search][property]") {
    const auto field = std::make_shared<const BrickField>(test::ballsField({48, 48, 48}, 6, 8.f, 20));
    BlockIndexOptions options;
    options.block = 16;
    const BlockIndex index = BlockIndex::build(field, options);
    const BrickField other = test::ballsField({48, 48, 48}, 7, 8.f, 20);
    BlockSearchCounts counts;
    for (int i = 0; i < 10; ++i) {
        std::vector<float> samples(16 * 16 * 16);
        other.readBox({i * 3, i * 2, 30 - i}, {16, 16, 16}, samples.data());
        BlockQuery query;
        query.samples = samples.data();
        index.match(query, 1, &counts);
    }
    CHECK(counts.exact < 10 * 33 * 33 * 33 / 50);
}

TEST_CASE("BlockIndex: the same index and answers for any number of threads", "[search][determinism]") {
    const auto field = std::make_shared<const BrickField>(test::ballsField({40, 40, 40}, 9, 4.f));
    const std::vector<float> samples = querySamples(*field, 8, 1);
    std::vector<std::vector<BlockMatch>> answers;
    std::vector<std::size_t> bytes;
    for (int threads : {1, 2, 8}) {
        RunContext ctx;
        ctx.threads = threads;
        BlockIndexOptions options;
        options.block = 8;
        const BlockIndex index = BlockIndex::build(field, options, ctx);
        BlockQuery query;
        query.samples = samples.data();
        answers.push_back(index.match(query, 20));
        bytes.push_back(index.memoryBytes());
    }
    requireSame(answers[0], answers[1]);
    requireSame(answers[0], answers[2]);
    CHECK(bytes[0] == bytes[1]);
    CHECK(bytes[0] == bytes[2]);
}

TEST_CASE("BlockIndex: bad options and cancel", "[search][error][cancel]") {
    const auto field = std::make_shared<const BrickField>(test::noiseField({10, 10, 10}, 1));
    BlockIndexOptions options;
    options.block = 3;
    CHECK(test::contains(test::thrownBy([&] { BlockIndex::build(field, options); }).message,
                         "`block` 3: must be"));
    options.block = 11;
    const test::Thrown larger = test::thrownBy([&] { BlockIndex::build(field, options); });
    CHECK(larger.code == int(ErrorCode::Unusable));
    CHECK(test::contains(larger.message, "`block` 11: larger than the exemplar"));
    options.block = 10;
    const BlockIndex whole = BlockIndex::build(field, options);
    const std::vector<float> samples = test::samplesOf(*field);
    BlockQuery query;
    query.samples = samples.data();
    CHECK(whole.match(query, 5).size() == 1);
    CHECK(whole.match(query).front().cost == 0);
    CHECK(test::thrownBy([&] { whole.match(query, 0); }).code == int(ErrorCode::InvalidOption));
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { BlockIndex::build(field, options, ctx); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("BlockIndex: a mostly empty field costs what its surface costs", "[search][property]") {
    BlockIndexOptions options;
    options.block = 8;
    const BlockIndex small = BlockIndex::build(ballIn(48), options);
    const BlockIndex large = BlockIndex::build(ballIn(160), options);
    CHECK(large.nodeCount() == small.nodeCount());
    CHECK(large.memoryBytes() - large.exemplar().memoryBytes() <
          3 * (small.memoryBytes() - small.exemplar().memoryBytes()));
    RunContext ctx;
    ctx.maxMemory = 100000;
    const test::Thrown thrown = test::thrownBy([&] { BlockIndex::build(ballIn(48), options, ctx); });
    CHECK(thrown.code == int(ErrorCode::Memory));
    CHECK(test::contains(thrown.message, "`exemplarBox`"));
}

TEST_CASE("BlockIndex: where bounds leave too much correlation goes on, where memory allows it",
          "[search][property]") {
    const BrickField source = test::noiseField({44, 40, 42}, 3);
    const auto field = std::make_shared<const BrickField>(source);
    BlockIndexOptions options;
    options.block = 8;
    const BlockIndex index = BlockIndex::build(field, options);
    const std::size_t bytes = index.memoryBytes();
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 77));
    BlockQuery query;
    query.samples = samples.data();
    BlockSearchCounts counts;
    requireSame(index.match(query, 2, &counts), matchBlocksLinearly(source, 8, query, 2));
    CHECK(counts.transforms == 1);
    CHECK(index.memoryBytes() > bytes + std::size_t(source.box().volume()) * 16);
    // A block that is there is found by bounds.
    std::vector<float> there(512);
    source.readBox({3, 4, 5}, {8, 8, 8}, there.data());
    query.samples = there.data();
    counts = {};
    CHECK(index.match(query, 1, &counts).front().cost == 0);
    CHECK(counts.transforms == 0);
}

TEST_CASE("BlockIndex: no transforms where they would need more memory than there may be", "[search]") {
    const auto field = ballIn(48);  // mostly empty: the index is small, transforms are not
    BlockIndexOptions options;
    options.block = 8;
    const std::size_t bytes = BlockIndex::build(field, options).memoryBytes();
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 77));
    BlockQuery query;
    query.samples = samples.data();
    const double both = double(bytes) + BlockCorrelation::memoryNeeded({48, 48, 48}, 8);
    for (bool enough : {true, false}) {
        RunContext ctx;
        ctx.maxMemory = std::uint64_t(both * (enough ? 1.01 : 0.99));
        const BlockIndex index = BlockIndex::build(field, options, ctx);
        BlockSearchCounts counts;
        requireSame(index.match(query, by(BlockSearchWay::Correlation, 2), &counts),
                    matchBlocksLinearly(*field, 8, query, 2));
        CHECK(counts.transforms == (enough ? 1u : 0u));
    }
}

TEST_CASE("BlockIndex: within a tolerance, no answer is further off than promised", "[search][property]") {
    for (const Case& c : exemplars()) {
        const auto field = std::make_shared<const BrickField>(c.field);
        BlockIndexOptions options;
        options.block = 8;
        const BlockIndex index = BlockIndex::build(field, options);
        for (double tolerance : {0.05, 0.5, 2.0})
            for (std::uint64_t seed = 0; seed < 8; ++seed) {
                INFO(c.name << ", tolerance " << tolerance << ", seed " << seed);
                const std::vector<float> samples = querySamples(c.field, 8, seed * 13 + 3);
                BlockQuery query;
                query.samples = samples.data();
                BlockSearchOptions search;
                search.count = 3;
                search.tolerance = tolerance;
                const auto exact = index.match(query, 3);
                const auto found = index.match(query, search);
                REQUIRE(found.size() == exact.size());
                for (std::size_t k = 0; k < exact.size(); ++k)
                    CHECK(std::sqrt(found[k].cost) <=
                          (1 + tolerance) * std::sqrt(exact[k].cost) * (1 + 1e-6));
            }
    }
    const auto field = std::make_shared<const BrickField>(test::noiseField({18, 16, 20}, 1));
    BlockIndexOptions options;
    options.block = 8;
    const BlockIndex index = BlockIndex::build(field, options);
    BlockSearchOptions search;
    search.tolerance = -0.1;
    CHECK(test::thrownBy([&] { index.match(BlockQuery{}, search); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("BlockIndex: many queries at once get the answers of each alone, for any threads",
          "[search][tsan]") {
    const BrickField source = test::ballsField({40, 32, 36}, 3, 3.f, 2);
    const auto field = std::make_shared<const BrickField>(source);
    BlockIndexOptions options;
    options.block = 8;
    const BlockIndex index = BlockIndex::build(field, options);
    std::vector<std::vector<float>> samples;
    for (std::uint64_t seed = 0; seed < 30; ++seed) samples.push_back(querySamples(source, 8, seed));
    std::vector<BlockQuery> queries(samples.size());
    for (std::size_t i = 0; i < queries.size(); ++i) queries[i].samples = samples[i].data();
    BlockSearchOptions search;
    search.count = 2;
    for (int threads : {1, 2, 5}) {
        RunContext ctx;
        ctx.threads = threads;
        BlockSearchCounts counts;
        const auto found = index.matchAll(queries, search, ctx, &counts);
        REQUIRE(found.size() == queries.size());
        CHECK(counts.exact > 0);
        for (std::size_t i = 0; i < queries.size(); ++i) requireSame(found[i], index.match(queries[i], 2));
    }
    // An odd number, so that one goes through the transform alone.
    queries.pop_back();
    for (int threads : {1, 2, 5}) {
        RunContext ctx;
        ctx.threads = threads;
        BlockSearchCounts counts;
        const auto found = index.matchAll(queries, by(BlockSearchWay::Correlation, 2), ctx, &counts);
        CHECK(counts.transforms > 10);
        for (std::size_t i = 0; i < queries.size(); ++i) requireSame(found[i], index.match(queries[i], 2));
    }
    CHECK(index.matchAll({}).empty());
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { index.matchAll(queries, search, stopped); }).code ==
          int(ErrorCode::Cancelled));
}
