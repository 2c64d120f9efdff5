#include "libvdbsynth/pipeline/analogy/analogy.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/control_grids.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
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

// The result as a map: positions in the pairs' index spaces, on voxels of the target's.
SourceMap mapOf(const VolumeAnalogyResult& made, const std::vector<PairFields>& fields,
                const std::vector<AnalogyModelPair>& pairs, double scale) {
    SourceMap map;
    map.method = MapMethod::Analogy;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const LevelSet& textured = *pairs[p].textured;
        map.exemplars.push_back({fields[p].box, textured.domain, levelSetHash(*textured.grid),
                                 fields[p].cutTextured, transformOf(*textured.grid)});
    }
    map.voxelSize = voxelSizeOf(*pairs.front().textured->grid);
    map.analogy.scale = scale;
    map.analogy.depths = made.depths;
    return map;
}

// @param corner  of the target's box
ElementSources placed(const ElementSources& made, const std::vector<PairFields>& fields, const Index3& corner,
                      double scale) {
    ElementSources sources;
    for (std::size_t i = 0; i < made.size(); ++i) {
        Source source = *made.strongest(i);
        const FieldPlace& place = fields[std::size_t(source.exemplar)].place;
        source.position = asWritten(place.corner + source.position * place.step);
        source.scale = float(scale);
        sources.add(made.voxels()[i] + corner, source);
    }
    return sources;
}

GridPtr directionGrid(const FrameField& frames, const FieldPlace& place, const IndexBox& box) {
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    grid->setName("direction");
    grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    grid->setTransform(place.like->transform().copy());
    const Vec3d origin = place.toWorld({0, 0, 0});
    const SurfaceShell& shell = frames.shell();
    for (std::size_t i = 0; i < shell.size(); ++i) {
        const Vec3d world = normalized(place.toWorld(cast<double>(frames.directions().tangent[i])) - origin);
        grid->tree().setValueOn(toCoord(shell.table[i] + box.min), openvdb::Vec3f(toVec(world)));
    }
    return grid;
}

constexpr int kDraftLevels = 2;  // of its half resolution, so that the target's band is no wider than else

VolumeAnalogyResult searched(const SearchFields& search, const FrameField& frames,
                             const std::vector<AnalogyModelPair>& pairs, const AnalogyOptions& options,
                             const RunContext& ctx) {
    std::vector<FrameField> pairFrames;
    for (std::size_t p = 0; p < pairs.size(); ++p)
        pairFrames.push_back(framesOf(search.pairs[p].plain, search.pairs[p].place,
                                      directionOfPair(*pairs[p].plain, options.exemplarDirection), "the pair",
                                      "exemplarDirection", ctx));
    std::vector<AnalogyPair> given;
    for (std::size_t p = 0; p < pairs.size(); ++p)
        given.push_back(
            {search.pairs[p].plain, search.pairs[p].textured, &pairFrames[p], search.pairs[p].inner});
    VolumeAnalogyOptions synthesis = options.synthesis;
    if (options.draft && synthesis.levels == 0)
        synthesis.levels = std::min(kDraftLevels, usefulLevels(given, ctx));
    if (options.draft) {
        if (synthesis.sweeps > VolumeAnalogyOptions().sweeps)
            message(ctx, MessageLevel::Note, "a draft takes one sweep, not the `sweeps` asked for");
        synthesis.sweeps = 1;
    }
    return makeAnalogy(given, *search.target, frames, synthesis, ctx);
}

// Strength times mask times what thin parts bear; empty: `strength` everywhere.
BrickField weightOver(const LevelSet& target, const IndexBox& box, const BrickField& plain, float dig,
                      float reach, float band, const AnalogyOptions& options, const RunContext& ctx) {
    BrickField weight = thinWeight(plain, dig, reach, band, options, ctx);
    const float strength = float(options.strength);
    if (!options.mask && weight.box().empty()) return weight;
    const auto times = [&](const BrickField& other, float factor) {
        return BrickField::generate(weight.box(), ctx, [&](const IndexBox& brick, float* samples) {
            std::array<float, BrickField::kSamples> share;
            weight.readBox(brick.min, brick.size(), samples);
            other.readBox(brick.min, brick.size(), share.data());
            for (std::size_t i = 0; i < share.size(); ++i) samples[i] *= share[i] * factor;
        });
    };
    if (!options.mask) return times(BrickField(weight.box(), 1), strength);
    const BrickField mask =
        sampledWeight(*options.mask, {box, {}, {}, target.grid.get()}, strength, "`mask`", ctx);
    return weight.box().empty() ? mask : times(mask, 1);
}

// How far textures reach from the plain surfaces and how deep they dig, -1 if a pair's does so at all depths.
struct TextureDepth {
    float reach = 0, dig = 0;
};

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

// [voxels] of a draft's target at its own resolution, which is not searched: farther than the texture reaches
// and digs.
int nearBand(const TextureDepth& depth) {
    constexpr float kMore = 5;
    return int(std::ceil(std::max(depth.reach, depth.dig) + kMore));
}

std::shared_ptr<const BrickField> halvedTarget(const LevelSet& target, const IndexBox& box,
                                               const CutFaces& cut, float band, const RunContext& ctx) {
    const KnownBand known = gatherKnownBand(*target.grid, box, cut, 2 * reachToWiden(band), ctx);
    return std::make_shared<const BrickField>(widenBandCoarse(known, band, ctx));
}

AnalogyResult madeAnalogy(const std::vector<AnalogyModelPair>& pairs, const LevelSet& target,
                          const AnalogyOptions& options, const RunContext& ctx) {
    AnalogyResult result;
    const MappedTarget mapped{levelSetHash(*target.grid), voxelSizeOf(*target.grid), target.domainRecorded};
    std::vector<PairFields> fields;
    Stage reading(ctx, "distances around the surfaces", pairs.size() + 1);
    for (const AnalogyModelPair& pair : pairs) {
        fields.push_back(gatherPair(pair, options.scale, ctx));
        reading.advance();
    }
    const TextureDepth depth = depthOf(fields, options.scale);
    result.reach = depth.reach;
    const int most = options.draft ? kDraftLevels : 3;
    const int levels = options.synthesis.levels == 0 ? most : std::clamp(options.synthesis.levels, 1, 6);
    const int radius = (options.synthesis.half + 2) << (levels - 1 + int(options.draft));
    const int band = int(std::ceil(result.reach)) + radius + 2;
    const CutFaces cut = facesTouched(target);
    const IndexBox box = grownBox(target.domain, cut, band);
    // Six bytes for each voxel of the box, whose bricks and slots they are, and 160 for each voxel of the
    // widened band, of frames, features and sources. Tuned with tools/dev/memory_models.py: 1.4 times the
    // peak.
    requireMemory(ctx, double(box.volume()) * 6 + double(activeVoxels(*target.grid)) / 6 * 2 * band * 160,
                  "the analogy", "use larger voxels, fewer `levels` or a smaller `half`");
    const int near = options.draft ? std::min(band, nearBand(depth)) : band;
    const auto plain =
        std::make_shared<const BrickField>(gatherWideBand(*target.grid, box, cut, float(near), ctx));
    const auto searchedTarget = options.draft ? halvedTarget(target, box, cut, float(band) / 2, ctx) : plain;
    reading.advance();
    const FieldPlace place{target.grid.get(), {double(box.min.x), double(box.min.y), double(box.min.z)}, 1};
    const SearchFields search = searchFields(fields, searchedTarget, place, options.draft, ctx);
    const FrameField frames =
        framesOf(search.target, search.place, options.direction, "the target", "direction", ctx);
    VolumeAnalogyResult made = searched(search, frames, pairs, options, ctx);
    if (options.draft) made = refinedDraft(made, plain->box());
    SourceMap& map = result.map = mapOf(made, fields, pairs, options.scale);
    map.target = mapped;
    map.elements = placed(made.sources, search.pairs, box.min, options.scale);
    map.targetBox = box;
    map.targetDomain = target.domain;
    map.cut = cut;
    map.band = float(near);
    map.halfWidth = options.halfWidth;
    map.analogy.strength = float(options.strength);
    map.analogy.weight =
        weightOver(target, box, *plain, depth.dig, depth.reach, float(near - 1), options, ctx);
    std::vector<ExemplarSamples> samples;
    std::vector<const LevelSet*> textured;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        samples.push_back({fields[p].textured, fields[p].place.corner, options.scale});
        textured.push_back(pairs[p].textured);
    }
    result.model = analogyThroughMap(map, 1, samples, *plain, target, result.reach, ctx);
    result.model.attributes = analogyAttributes(map, textured, *plain, target, *result.model.grid, ctx);
    if (options.keepDirections) {
        result.directions =
            options.draft
                ? directionGrid(framesOf(plain, place, options.direction, "the target", "direction", ctx),
                                place, box)
                : directionGrid(frames, place, box);
    }
    result.levels = std::move(made.levels);
    for (const Vec3f& p : frames.directions().singularities)
        result.singularities.push_back(search.place.toWorld(cast<double>(p)));
    result.cut = frames.sweep().cut;
    return result;
}

}  // namespace

void validate(const AnalogyOptions& options, const std::vector<AnalogyModelPair>& pairs,
              const LevelSet& target) {
    requireOption(options.scale >= 0.25 && options.scale <= 4, "scale", roundedText(options.scale, 6),
                  "from 0.25 to 4");
    requireOption(options.strength >= 0 && options.strength <= 1, "strength",
                  roundedText(options.strength, 6), "from 0 to 1");
    validate(options.synthesis);
    requireHalfWidth(double(options.halfWidth));
    requireDirection(options.direction, "direction");
    requireDirection(options.exemplarDirection, "exemplarDirection");
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string what = pairs.size() > 1 ? "pair " + std::to_string(p + 1) : "the pair";
        requireModel(pairs[p].plain, what + ", plain");
        requireModel(pairs[p].textured, what + ", textured");
        requireOnePlace(pairs[p]);
    }
    requireModel(&target, "the target");
}

AnalogyResult makeAnalogyModel(const std::vector<AnalogyModelPair>& pairs, const LevelSet& target,
                               const AnalogyOptions& options, const RunContext& ctx) {
    validate(options, pairs, target);
    return withThreads(ctx, [&] { return madeAnalogy(pairs, target, options, ctx); });
}

}  // namespace vdbsynth
