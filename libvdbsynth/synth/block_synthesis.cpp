#include "libvdbsynth/synth/block_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/search/block_index.h"
#include "libvdbsynth/synth/synthesis_passes.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kFirstBlockPurpose = 0x66697273, kPaddingPurpose = 0x70000000;
using Fields = std::vector<std::shared_ptr<const BrickField>>;
using Pass = SynthesisPass;

// The field with 256 evenly spaced values over its range [lagae2004, section 4.1].
BrickField quantized(const BrickField& field, const RunContext& ctx) {
    float limit = 0;
    std::vector<float> row(std::size_t(field.box().size().z));
    for (int x = 0; x < field.box().size().x; ++x)
        for (int y = 0; y < field.box().size().y; ++y) {
            field.readBox({x, y, 0}, {1, 1, int(row.size())}, row.data());
            for (float value : row) limit = std::max(limit, std::abs(value));
        }
    if (limit == 0) return field;
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = (std::round((samples[i] / limit + 1) * 127.5f) / 127.5f - 1) * limit;
    });
}

class Synthesis {
public:
    Synthesis(const BlockSynthesisOptions& options, const RunContext& ctx)
        : mOptions(options), mContext(ctx) {}

    // Runs one pass. `coarse`: the result and map of the pass before, null for the first.
    void run(const Pass& pass, const BrickField* coarse, const PatchMap* coarseMap,
             const std::vector<const BrickField*>& masks, BrickField& field, PatchMap& map,
             const std::string& name) {
        BlockIndexOptions indexOptions;
        indexOptions.block = pass.block;
        indexOptions.cacheFolder = mOptions.indexCache;
        Stage stage(mContext, name, 1);
        std::vector<BlockIndex> indices;
        for (const auto& exemplar : pass.exemplars) {
            indexOptions.mask = indices.size() < masks.size() ? masks[indices.size()] : nullptr;
            indices.push_back(BlockIndex::build(exemplar, indexOptions, mContext));
        }
        std::uint64_t bytes = 0;
        for (const BlockIndex& index : indices) bytes += index.memoryBytes();
        mStats.indexBytes = std::max(mStats.indexBytes, bytes);
        map.target = pass.target;
        map.block = pass.block;
        map.stride = pass.block / 2;
        map.overhang = {0, 0, 0};
        map.allocate();
        map.vote = mOptions.paper ? PatchVote::First : PatchVote::Blend;
        field = coarse           ? doubled(*coarse, pass.target, mContext)
                : mOptions.paper ? drawnSamples(pass)
                                 : BrickField(IndexBox::fromSize(pass.target), 0.f);
        // The paper matches all samples of a block, those drawn at random too.
        walk(pass, indices, coarse || mOptions.paper, coarseMap, field, map, name);
    }

    BlockSynthesisStats takeStats() const { return mStats; }

private:
    // A target whose samples are each drawn from the first exemplar.
    BrickField drawnSamples(const Pass& pass) const {
        const BrickField& exemplar = *pass.exemplars.front();
        const Index3 from = exemplar.box().size();
        const IndexBox target = IndexBox::fromSize(pass.target);
        return BrickField::fromVoxels(target, mContext, [&](const Index3& p) {
            const std::uint64_t row = (std::uint64_t(p.x) << 32) | std::uint64_t(p.y);
            Random random(mContext.seed, row, kPaddingPurpose + std::uint32_t(p.z));
            return exemplar.at({int(random.below(std::uint32_t(from.x))),
                                int(random.below(std::uint32_t(from.y))),
                                int(random.below(std::uint32_t(from.z)))});
        });
    }

    struct Found {
        BlockMatch match;
        std::int32_t exemplar = -1;
    };

    // Query data of a block.
    struct BlockRequest {
        Index3 origin;
        std::vector<float> samples;
        std::vector<std::uint8_t> known;  // empty: everywhere
        int only = -1;                    // exemplar; -1: any
    };

    void walk(const Pass& pass, const std::vector<BlockIndex>& indices, bool seeded,
              const PatchMap* coarseMap, BrickField& field, PatchMap& map, const std::string& name) {
        const Index3 lattice = map.lattice();
        Stage stage(mContext, name, latticeCount(lattice));
        double costs = 0;
        for (int wave = 0; wave <= lattice.x + lattice.y + lattice.z - 3; ++wave) {
            std::vector<Index3> blocks;
            for (int a = 0; a < lattice.x; ++a)
                for (int b = 0; b < lattice.y; ++b) {
                    const int c = wave - a - b;
                    if (c >= 0 && c < lattice.z) blocks.push_back({a, b, c});
                }
            const std::vector<Found> found = matchWave(pass, indices, seeded, coarseMap, field, map, blocks);
            for (std::size_t i = 0; i < blocks.size(); ++i) {
                copyOpen(pass, map, blocks[i], found[i], field);
                costs += found[i].match.cost;
            }
            mStats.matches += blocks.size();
            stage.advance(blocks.size());
        }
        mStats.meanCost = costs / double(map.source.size());
    }

    // Samples that this block is the first to cover, in lattice order.
    std::vector<std::uint8_t> openSamples(const PatchMap& map, const Index3& l) const {
        const int n = map.block;
        std::array<std::vector<std::uint8_t>, 3> open;
        for (int axis = 0; axis < 3; ++axis) {
            const int covered =
                l[axis] == 0 ? 0 : map.origin(axis, l[axis] - 1) + n - map.origin(axis, l[axis]);
            open[std::size_t(axis)].assign(std::size_t(n), 0);
            for (int i = std::max(covered, 0); i < n; ++i) open[std::size_t(axis)][std::size_t(i)] = 1;
        }
        std::vector<std::uint8_t> samples(latticeCount({n, n, n}));
        std::size_t s = 0;
        forEachVoxel(IndexBox::cube({0, 0, 0}, n), [&](const Index3& p) {
            samples[s++] = open[0][std::size_t(p.x)] & open[1][std::size_t(p.y)] & open[2][std::size_t(p.z)];
        });
        return samples;
    }

    // The blocks of a wave do not touch: all of them are matched at once, exemplar by exemplar.
    std::vector<Found> matchWave(const Pass& pass, const std::vector<BlockIndex>& indices, bool seeded,
                                 const PatchMap* coarseMap, const BrickField& field, const PatchMap& map,
                                 const std::vector<Index3>& blocks) {
        std::vector<Found> found(blocks.size());
        std::vector<BlockRequest> requests(blocks.size());
        parallelFor(mContext, blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                requests[i] = requestOf(pass, seeded, field, map, blocks[i]);
        });
        for (std::size_t e = 0; e < indices.size(); ++e) {
            std::vector<BlockQuery> queries;
            std::vector<std::size_t> of;
            for (std::size_t i = 0; i < blocks.size(); ++i) {
                BlockQuery query = queryOf(requests[i], pass, indices[e]);
                if (query.candidates.empty() || (requests[i].only >= 0 && int(e) != requests[i].only))
                    continue;
                if (!seeded && blocks[i] == Index3{0, 0, 0}) {
                    if ((requests[i].only >= 0 || e == 0) && drawFirst(indices[e], query, found[i].match))
                        found[i].exemplar = std::int32_t(e);
                    continue;
                }
                addHints(map, coarseMap, blocks[i], std::int32_t(e), query.hints);
                queries.push_back(std::move(query));
                of.push_back(i);
            }
            BlockSearchCounts counts;
            const auto matches = indices[e].matchAll(queries, {}, mContext, &counts);
            mStats.nodes += counts.nodes;
            mStats.exact += counts.exact;
            for (std::size_t q = 0; q < queries.size(); ++q) {
                Found& best = found[of[q]];
                if (matches[q].empty() || (best.exemplar >= 0 && best.match.cost <= matches[q].front().cost))
                    continue;
                best = {matches[q].front(), std::int32_t(e)};
            }
        }
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (found[i].exemplar >= 0) continue;
            const Index3& at = requests[i].origin;
            throw Error(ErrorCode::Unusable, "no eligible source for the block at " + std::to_string(at.x) +
                                                 "," + std::to_string(at.y) + "," + std::to_string(at.z) +
                                                 "; widen `exemplarMask` or raise `drift`");
        }
        return found;
    }

    BlockRequest requestOf(const Pass& pass, bool seeded, const BrickField& field, const PatchMap& map,
                           const Index3& l) const {
        const int n = pass.block;
        BlockRequest request;
        request.origin = {map.origin(0, l.x), map.origin(1, l.y), map.origin(2, l.z)};
        request.samples.resize(latticeCount({n, n, n}));
        field.readBox(request.origin, {n, n, n}, request.samples.data());
        if (!seeded) {
            request.known = openSamples(map, l);
            for (std::uint8_t& k : request.known) k = !k;
        }
        request.only = exemplarAt(mOptions, pass, request.origin + Index3{n / 2, n / 2, n / 2});
        return request;
    }

    BlockQuery queryOf(const BlockRequest& request, const Pass& pass, const BlockIndex& index) const {
        BlockQuery query;
        query.samples = request.samples.data();
        query.known = request.known.empty() ? nullptr : request.known.data();
        query.candidates =
            sourceBox(mOptions, pass, index.exemplar().box().size(), pass.block, request.origin);
        return query;
    }

    // The first block of all: any eligible one, drawn by the seed.
    bool drawFirst(const BlockIndex& index, const BlockQuery& query, BlockMatch& found) {
        for (std::uint64_t attempt = 0; attempt < 256; ++attempt) {
            Random random(mContext.seed, attempt, kFirstBlockPurpose);
            BlockQuery drawn = query;
            for (int axis = 0; axis < 3; ++axis) {
                const std::uint32_t room = std::uint32_t(query.candidates.size()[axis]);
                drawn.candidates.min[axis] = drawn.candidates.max[axis] =
                    query.candidates.min[axis] + int(random.below(room));
            }
            const std::vector<BlockMatch> matches = index.match(drawn);
            if (matches.empty()) continue;  // outside the mask
            found = matches.front();
            return true;
        }
        const std::vector<BlockMatch> matches = index.match(query);
        if (!matches.empty()) found = matches.front();
        return !matches.empty();
    }

    // Positions that continue the neighbours' sources and the coarser pass.
    void addHints(const PatchMap& map, const PatchMap* coarseMap, const Index3& l, std::int32_t exemplar,
                  std::vector<Index3>& hints) const {
        for (int axis = 0; axis < 3; ++axis) {
            if (l[axis] == 0) continue;
            Index3 before = l;
            --before[axis];
            const std::size_t b = map.index(before);
            if (map.exemplar[b] != exemplar) continue;
            Index3 hint = map.source[b];
            hint[axis] += map.origin(axis, l[axis]) - map.origin(axis, before[axis]);
            hints.push_back(hint);
        }
        if (!coarseMap) return;
        Index3 origin, middle;
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] = map.origin(axis, l[axis]);
            middle[axis] = std::min((origin[axis] + map.block / 2) / 2, coarseMap->target[axis] - 1);
        }
        const Index3 strongest = strongestBlock(*coarseMap, middle);
        const std::size_t b = coarseMap->index(strongest);
        if (coarseMap->exemplar[b] != exemplar) return;
        Index3 hint;
        for (int axis = 0; axis < 3; ++axis)
            hint[axis] =
                origin[axis] + 2 * (coarseMap->source[b][axis] - coarseMap->origin(axis, strongest[axis]));
        hints.push_back(hint);
    }

    void copyOpen(const Pass& pass, PatchMap& map, const Index3& l, const Found& found,
                  BrickField& field) const {
        const int n = pass.block;
        const std::size_t at = map.index(l);
        map.source[at] = found.match.position;
        map.exemplar[at] = found.exemplar;
        std::vector<float> samples(latticeCount({n, n, n}));
        pass.exemplars[std::size_t(found.exemplar)]->readBox(found.match.position, {n, n, n}, samples.data());
        const std::vector<std::uint8_t> open = openSamples(map, l);
        field.writeBox({map.origin(0, l.x), map.origin(1, l.y), map.origin(2, l.z)}, {n, n, n},
                       samples.data(), open.data());
    }

    const BlockSynthesisOptions& mOptions;
    const RunContext& mContext;
    BlockSynthesisStats mStats;
};

}  // namespace

BlockSynthesisResult synthesizeBlocks(const Fields& exemplars, const BlockSynthesisOptions& options,
                                      const RunContext& ctx) {
    validate(options, exemplars);
    for (Border border : options.border)
        if (border == Border::Tile)
            throw Error(ErrorCode::InvalidOption, "`border` tile: needs `method` default");
    int block = options.block;
    if (block == 0) {
        block = 256;
        for (const auto& exemplar : exemplars)
            block = std::min(block, deriveBlock(exemplar->box().size(), options));
    }
    if (options.paper)
        while (block & (block - 1)) block &= block - 1;
    std::vector<Pass> passes =
        planPasses(exemplars, options, block, options.levels > 0 ? options.levels : 3, ctx);
    if (options.paper)
        for (Pass& pass : passes) {
            while (pass.block & (pass.block - 1)) pass.block &= pass.block - 1;
            for (auto& exemplar : pass.exemplars)
                exemplar = std::make_shared<const BrickField>(quantized(*exemplar, ctx));
        }
    const std::vector<PassMasks> masks = masksOf(options, passes.size(), ctx);
    Synthesis synthesis(options, ctx);
    BlockSynthesisResult result;
    BrickField coarse;
    PatchMap coarseMap;
    for (std::size_t p = passes.size(); p-- > 0;) {
        BrickField field;
        PatchMap map;
        const bool first = p + 1 == passes.size();
        synthesis.run(
            passes[p], first ? nullptr : &coarse, first ? nullptr : &coarseMap, masks[p].each, field, map,
            "synthesis pass " + std::to_string(passes.size() - p) + " of " + std::to_string(passes.size()));
        coarse = std::move(field);
        coarseMap = std::move(map);
    }
    result.map = std::move(coarseMap);
    result.field = voteThroughMap(result.map, exemplars, ctx);
    result.stats = synthesis.takeStats();
    result.stats.block = result.map.block;
    result.stats.levels = int(passes.size());
    return result;
}

}  // namespace vdbsynth
