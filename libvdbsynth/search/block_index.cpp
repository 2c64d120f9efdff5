#include "libvdbsynth/search/block_index_data.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/search/block_cost.h"
#include "libvdbsynth/search/block_search.h"
#include "libvdbsynth/search/block_sift.h"

#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

namespace vdbsynth {
namespace {

// Work by bounds that takes as long as one operation of the transforms, measured (decision 012).
constexpr double kBoundsPerOperation = 0.35;

}  // namespace

void validate(const BlockIndexOptions& options, const BrickField* exemplar) {
    requireOption(options.block >= 4 && options.block <= 256, "block", std::to_string(options.block),
                  "a whole number from 4 to 256");
    requireField(exemplar, "the exemplar");
    blockPositions(*exemplar, options.block);
    if (options.mask) requireField(options.mask, "`mask`", exemplar->box().size());
}

void validate(const BlockSearchOptions& options) {
    requireOption(options.count >= 1, "count", std::to_string(options.count), "at least 1");
    requireOption(options.tolerance >= 0 && options.tolerance <= 100, "tolerance",
                  roundedText(options.tolerance, 6), "from 0 to 100");
}

void validate(const BlockQuery& query, int block) {
    requireOption(query.samples != nullptr, "samples", "null", "those of a block");
    bool finite = true;
    for (std::size_t i = 0, count = latticeCount({block, block, block}); i < count; ++i)
        finite = finite && ((query.known && !query.known[i]) || std::isfinite(query.samples[i]));
    if (!finite) throw Error(ErrorCode::BadData, "`samples`: hold NaN or infinite values");
}

struct BlockIndex::Impl {
    BlockIndexData data;
    bool mayCorrelate = true;  // if memory allows
    std::mutex mutex;
    // One for every concurrent call.
    std::vector<std::unique_ptr<BlockSearchScratch>> idle;
    std::vector<std::unique_ptr<BlockCorrelation::Workspace>> workspaces;
    std::mutex making;
    std::unique_ptr<const BlockCorrelation> correlation;

    template <typename T>
    std::unique_ptr<T> take(std::vector<std::unique_ptr<T>>& from) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (from.empty()) return std::make_unique<T>();
        std::unique_ptr<T> taken = std::move(from.back());
        from.pop_back();
        return taken;
    }
    template <typename T>
    void giveBack(std::unique_ptr<T> taken, std::vector<std::unique_ptr<T>>& to) {
        const std::lock_guard<std::mutex> lock(mutex);
        to.push_back(std::move(taken));
    }

    const BlockCorrelation& correlationWith(const RunContext& ctx) {
        const std::lock_guard<std::mutex> lock(making);
        if (!correlation) correlation = std::make_unique<BlockCorrelation>(*data.exemplar, data.block, ctx);
        return *correlation;
    }

    // Unfinished if correlation should continue.
    PartialSearch begin(const BlockQuery& query, const BlockSearchOptions& options,
                        BlockSearchCounts& counts) {
        double mostWork = std::numeric_limits<double>::infinity();
        if (mayCorrelate && options.way == BlockSearchWay::Planned)
            mostWork = kBoundsPerOperation * BlockCorrelation::work(data.exemplar->box().size());
        if (mayCorrelate && options.way == BlockSearchWay::Correlation &&
            countKnown(query.known, data.block) > 0)
            return {{}, false};
        return byBounds(query, options, mostWork, counts);
    }

    PartialSearch byBounds(const BlockQuery& query, const BlockSearchOptions& options, double mostWork,
                           BlockSearchCounts& counts) {
        std::unique_ptr<BlockSearchScratch> scratch = take(idle);
        PartialSearch found = searchByBounds(data, query, options, mostWork, counts, *scratch);
        giveBack(std::move(scratch), idle);
        return found;
    }

    // Continues with one or two queries (the second may be null) for which bounds left too much.
    void finish(const BlockQuery& first, PartialSearch& firstFound, const BlockQuery* second,
                PartialSearch* secondFound, const BlockSearchOptions& options, const BlockCorrelation& by,
                BlockSearchCounts& counts) {
        std::array<SiftedQuery, 2> queries;
        queries[0] = {&first, std::move(firstFound.matches)};
        if (second) queries[1] = {second, std::move(secondFound->matches)};
        std::unique_ptr<BlockCorrelation::Workspace> workspace = take(workspaces);
        std::array<PartialSearch, 2> found =
            searchByCorrelation(data, by, queries, options.count, counts, *workspace);
        giveBack(std::move(workspace), workspaces);
        for (std::size_t i = 0; i < 2; ++i) {
            if (!queries[i].query) continue;
            if (!found[i].finished) {
                BlockQuery query = *queries[i].query;
                for (const BlockMatch& match : found[i].matches) query.hints.push_back(match.position);
                found[i] = byBounds(query, options, std::numeric_limits<double>::infinity(), counts);
            }
            (i == 0 ? firstFound : *secondFound) = std::move(found[i]);
        }
    }
};

BlockIndex::BlockIndex(std::unique_ptr<Impl> impl) : mImpl(std::move(impl)) {}
BlockIndex::BlockIndex(BlockIndex&&) noexcept = default;
BlockIndex& BlockIndex::operator=(BlockIndex&&) noexcept = default;
BlockIndex::~BlockIndex() = default;

BlockIndex BlockIndex::build(std::shared_ptr<const BrickField> exemplar, const BlockIndexOptions& options,
                             const RunContext& ctx) {
    auto impl = std::make_unique<Impl>();
    impl->data = buildBlockIndexData(std::move(exemplar), options, ctx);
    const double needed = BlockCorrelation::memoryNeeded(impl->data.exemplar->box().size(), options.block);
    impl->mayCorrelate =
        ctx.maxMemory == 0 || needed + double(impl->data.memoryBytes()) <= double(ctx.maxMemory);
    return BlockIndex(std::move(impl));
}

std::vector<BlockMatch> BlockIndex::match(const BlockQuery& query, const BlockSearchOptions& options,
                                          BlockSearchCounts* counts) const {
    validate(options);
    validate(query, mImpl->data.block);
    BlockSearchCounts ignored;
    BlockSearchCounts& count = counts ? *counts : ignored;
    PartialSearch found = mImpl->begin(query, options, count);
    if (!found.finished) {
        RunContext alone;  // other queries may be running on the other threads
        alone.threads = 1;
        mImpl->finish(query, found, nullptr, nullptr, options, mImpl->correlationWith(alone), count);
    }
    return std::move(found.matches);
}

std::vector<BlockMatch> BlockIndex::match(const BlockQuery& query, int count,
                                          BlockSearchCounts* counts) const {
    BlockSearchOptions options;
    options.count = count;
    return match(query, options, counts);
}

std::vector<std::vector<BlockMatch>> BlockIndex::matchAll(const std::vector<BlockQuery>& queries,
                                                          const BlockSearchOptions& options,
                                                          const RunContext& ctx,
                                                          BlockSearchCounts* counts) const {
    validate(options);
    for (const BlockQuery& query : queries) validate(query, mImpl->data.block);
    constexpr std::size_t kTogether = 8;
    std::vector<PartialSearch> found(queries.size());
    std::vector<BlockSearchCounts> done(queries.size());
    parallelFor(ctx, queries.size(), kTogether, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            BlockQuery query = queries[i];
            if (i > begin)
                for (const BlockMatch& match : found[i - 1].matches) query.hints.push_back(match.position);
            found[i] = mImpl->begin(query, options, done[i]);
        }
    });
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < queries.size(); ++i)
        if (!found[i].finished) left.push_back(i);
    if (!left.empty()) {
        const BlockCorrelation& correlation = mImpl->correlationWith(ctx);
        parallelFor(ctx, left.size(), 2, [&](std::size_t begin, std::size_t end) {
            const std::size_t a = left[begin], b = left[end - 1];
            mImpl->finish(queries[a], found[a], a == b ? nullptr : &queries[b], &found[b], options,
                          correlation, done[a]);
        });
    }
    std::vector<std::vector<BlockMatch>> matches;
    for (PartialSearch& search : found) matches.push_back(std::move(search.matches));
    for (const BlockSearchCounts& part : done)
        if (counts) *counts += part;
    return matches;
}

int BlockIndex::block() const {
    return mImpl->data.block;
}
const BrickField& BlockIndex::exemplar() const {
    return *mImpl->data.exemplar;
}
const IndexBox& BlockIndex::positions() const {
    return mImpl->data.positions;
}
std::size_t BlockIndex::memoryBytes() const {
    const std::lock_guard<std::mutex> lock(mImpl->making);
    return mImpl->data.memoryBytes() + (mImpl->correlation ? mImpl->correlation->memoryBytes() : 0);
}
std::size_t BlockIndex::nodeCount() const {
    return mImpl->data.nodeCount();
}

std::vector<BlockMatch> matchBlocksLinearly(const BrickField& exemplar, int block, const BlockQuery& query,
                                            int count, const BrickField* mask) {
    BlockIndexOptions index;
    index.block = block;
    index.mask = mask;
    validate(index, &exemplar);
    BlockSearchOptions search;
    search.count = count;
    validate(search);
    validate(query, block);
    const IndexBox positions = blockPositions(exemplar, block);
    const IndexBox box = query.candidates.empty() ? positions : query.candidates.intersection(positions);
    const std::int64_t known = countKnown(query.known, block);
    BestBlocks best(count);
    forEachVoxel(box, [&](const Index3& p) {
        if (mask && !blockInsideMask(*mask, p, block)) return;
        best.add({p, known == 0
                         ? 0.0
                         : blockCost(exemplar, p, block, query.samples, query.known, known, best.limit())});
    });
    return best.matches();
}

}  // namespace vdbsynth
