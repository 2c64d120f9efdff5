#include "libvdbsynth/pipeline/match/match.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/mask.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

CutFaces facesOf(const LevelSet& model) {
    return model.domainRecorded ? kAllCut : CutFaces{};
}

void judge(const std::vector<BlockMatch>& exact, MatchResult& result) {
    double ratios = 0, found = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
        const double a = std::sqrt(result.matches[k].cost), b = std::sqrt(exact[k].cost);
        ratios += a == b ? 1 : a / b;
        found += std::any_of(result.matches.begin(), result.matches.end(),
                             [&](const BlockMatch& m) { return m.position == exact[k].position; });
    }
    result.exactnessRatio = ratios / double(exact.size());
    result.recall = found / double(exact.size());
}

MatchResult matched(const LevelSet& exemplar, const LevelSet& query, const MatchOptions& options,
                    const RunContext& ctx) {
    const float band = std::max(8.f, float(options.block) / 2);
    const auto field = std::make_shared<const BrickField>(
        gatherWideBand(*exemplar.grid, exemplar.domain, facesOf(exemplar), band, ctx));
    // The query's block is read from its whole domain, so that a block matched in its
    // own model costs exactly 0.
    const IndexBox box = IndexBox::cube(options.at, options.block);
    IndexBox reach = query.domain;
    for (int axis = 0; axis < 3; ++axis) {
        reach.min[axis] = std::min(reach.min[axis], box.min[axis]);
        reach.max[axis] = std::max(reach.max[axis], box.max[axis]);
    }
    const BrickField queryField = gatherWideBand(*query.grid, reach, facesOf(query), band, ctx);
    const Index3 side{options.block, options.block, options.block};
    const std::size_t count =
        std::size_t(options.block) * std::size_t(options.block) * std::size_t(options.block);
    std::vector<float> samples(count);
    queryField.readBox(box.min - reach.min, side, samples.data());
    BlockQuery blockQuery;
    blockQuery.samples = samples.data();
    std::vector<std::uint8_t> known;
    if (options.mask) {
        std::vector<float> mask(count);
        gatherMask(*maskOn(options.mask, *query.grid, "`mask`", ctx), box, *query.grid, ctx)
            .readBox({0, 0, 0}, side, mask.data());
        for (float value : mask) known.push_back(value > 0 ? 1 : 0);
        blockQuery.known = known.data();
    }
    MatchResult result;
    result.known =
        options.mask ? std::size_t(std::count(known.begin(), known.end(), std::uint8_t(1))) : count;
    if (result.known == 0)
        throw Error(ErrorCode::Unusable,
                    "`mask`: not active anywhere in the query's block, so there is nothing to compare");
    BlockIndexOptions indexOptions;
    indexOptions.block = options.block;
    indexOptions.cacheFolder = options.indexCache;
    Stage stage(ctx, "matching", 2);
    const BlockIndex index = BlockIndex::build(field, indexOptions, ctx);
    stage.advance();
    BlockSearchOptions search;
    search.count = options.count;
    search.tolerance = options.tolerance;
    result.matches = index.match(blockQuery, search, &result.counts);
    if (options.check && options.tolerance > 0) judge(index.match(blockQuery, options.count), result);
    stage.advance();
    for (BlockMatch& match : result.matches) match.position = match.position + exemplar.domain.min;
    return result;
}

}  // namespace

void validate(const MatchOptions& options, const LevelSet& exemplar, const LevelSet& query) {
    requireOption(options.block >= 4 && options.block <= 256, "block", std::to_string(options.block),
                  "a whole number from 4 to 256");
    requireOption(options.count >= 1 && options.count <= 100000, "count", std::to_string(options.count),
                  "a whole number from 1 to 100000");
    requireOption(options.tolerance >= 0 && options.tolerance <= 100, "tolerance",
                  roundedText(options.tolerance, 6), "from 0 to 100");
    requireModel(&exemplar, "the exemplar");
    requireModel(&query, "the query");
    requireBox({options.at, options.at}, "at");
    const Index3 size = exemplar.domain.size();
    if (options.block > std::min({size.x, size.y, size.z}))
        throw Error(ErrorCode::Unusable, "`block` " + std::to_string(options.block) +
                                             ": larger than the exemplar's domain " +
                                             boxText(exemplar.domain));
    if (std::abs(voxelSizeOf(*exemplar.grid) - voxelSizeOf(*query.grid)) > 1e-5 * voxelSizeOf(*exemplar.grid))
        throw Error(ErrorCode::ShapeMismatch,
                    "the query's voxel size " + std::to_string(voxelSizeOf(*query.grid)) +
                        " is not the exemplar's " + std::to_string(voxelSizeOf(*exemplar.grid)) +
                        "; convert one of them with `voxelSize`");
    const IndexBox box = IndexBox::cube(options.at, options.block);
    if (query.domain.intersection(box).empty())
        throw Error(ErrorCode::Unusable,
                    "`at` " + std::to_string(options.at.x) + "," + std::to_string(options.at.y) + "," +
                        std::to_string(options.at.z) + ": the block lies outside the query's domain " +
                        boxText(query.domain));
    if (options.mask) activeBox(*options.mask);
}

MatchResult matchModel(const LevelSet& exemplar, const LevelSet& query, const MatchOptions& options,
                       const RunContext& ctx) {
    validate(options, exemplar, query);
    return withThreads(ctx, [&] { return matched(exemplar, query, options, ctx); });
}

}  // namespace vdbsynth
