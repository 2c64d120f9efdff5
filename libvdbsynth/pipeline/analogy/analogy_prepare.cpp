// What of an analogy does not depend on the target.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <string>

namespace vdbsynth {
namespace {

DirectionSource directionOfPair(const LevelSet& plain, const DirectionSource& given) {
    if (given.kind != DirectionSource::Kind::Automatic) return given;
    DirectionSource source;
    const auto recorded = plain.grid->getMetadata<openvdb::StringMetadata>(kDirectionKey);
    if (recorded) parseDirection(recorded->value(), source);
    return source;
}

TextureDepth depthOf(const std::vector<PairFields>& fields, double scale) {
    TextureDepth depth;
    bool through = false;
    for (const PairFields& pair : fields) {
        const float reach = reachOf(*pair.plain, *pair.textured), dig = digOf(*pair.plain, *pair.textured);
        if (reach > float(kMostReach - 1) * float(std::min(scale, 1.0)))
            throw Error(ErrorCode::Unusable, "the texture reaches more than " +
                                                 std::to_string(kMostReach - 1) +
                                                 " voxels from the plain model's surface; use larger voxels, "
                                                 "or check that the two models of the pair coincide");
        depth.reach = std::max(depth.reach, reach);
        depth.dig = std::max(depth.dig, dig);
        through = through || dig < 0;
    }
    if (through) depth.dig = -1;
    return depth;
}

VolumeAnalogyOptions searchOptions(const std::vector<AnalogyPair>& pairs, const AnalogyOptions& options,
                                   const RunContext& ctx) {
    VolumeAnalogyOptions synthesis = options.synthesis;
    if (!options.draft) return synthesis;
    if (synthesis.levels == 0) synthesis.levels = std::min(kDraftLevels, usefulLevels(pairs, ctx));
    if (synthesis.sweeps > VolumeAnalogyOptions().sweeps)
        message(ctx, MessageLevel::Note, "a draft takes one sweep, not the `sweeps` asked for");
    synthesis.sweeps = 1;
    return synthesis;
}

}  // namespace

std::shared_ptr<const PreparedPairs> preparedPairs(const std::vector<AnalogyModelPair>& pairs,
                                                   const AnalogyOptions& options, const RunContext& ctx) {
    const auto prepared = std::make_shared<PreparedPairs>();
    prepared->options = options;
    Stage reading(ctx, "distances around the pair's surfaces", pairs.size());
    for (const AnalogyModelPair& pair : pairs) {
        prepared->plain.push_back(*pair.plain);
        prepared->textured.push_back(*pair.textured);
        prepared->fields.push_back(gatherPair(pair, options.scale, ctx));
        reading.advance();
    }
    prepared->depth = depthOf(prepared->fields, options.scale);
    const std::vector<PairFields> searched =
        options.draft ? halvedPairs(prepared->fields, ctx) : prepared->fields;
    std::vector<FrameField> frames;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        prepared->places.push_back(searched[p].place);
        frames.push_back(framesOf(searched[p].plain, searched[p].place,
                                  directionOfPair(*pairs[p].plain, options.exemplarDirection), "the pair",
                                  "exemplarDirection", ctx));
    }
    std::vector<AnalogyPair> given;
    for (std::size_t p = 0; p < pairs.size(); ++p)
        given.push_back({searched[p].plain, searched[p].textured, &frames[p], searched[p].inner});
    prepared->trained = trainPairs(given, searchOptions(given, options, ctx), ctx);
    return prepared;
}

}  // namespace vdbsynth
