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

// The result as a map: positions in the pairs' index spaces, on voxels of the target's.
SourceMap mapOf(const VolumeAnalogyResult& made, const PreparedPairs& pairs, double scale) {
    SourceMap map;
    map.method = MapMethod::Analogy;
    for (std::size_t p = 0; p < pairs.fields.size(); ++p) {
        const LevelSet& textured = pairs.textured[p];
        map.exemplars.push_back({pairs.fields[p].box, textured.domain, levelSetHash(*textured.grid),
                                 pairs.fields[p].cutTextured, transformOf(*textured.grid)});
    }
    map.voxelSize = voxelSizeOf(*pairs.textured.front().grid);
    map.analogy.scale = scale;
    map.analogy.depths = made.depths;
    return map;
}

// @param places  of the pairs that were searched   @param corner  of the target's box
ElementSources placed(const ElementSources& made, const std::vector<FieldPlace>& places, const Index3& corner,
                      double scale) {
    ElementSources sources;
    for (std::size_t i = 0; i < made.size(); ++i) {
        Source source = *made.strongest(i);
        const FieldPlace& place = places[std::size_t(source.exemplar)];
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

// [voxels] of a draft's target at its own resolution, which is not searched: farther than the texture reaches
// and digs.
int nearBand(const TextureDepth& depth) {
    constexpr float kMore = 5;
    return int(std::ceil(std::max(depth.reach, depth.dig) + kMore));
}

AnalogyResult madeAnalogy(const PreparedPairs& pairs, const LevelSet& target, const AnalogyOptions& options,
                          const RunContext& ctx) {
    AnalogyResult result;
    const MappedTarget mapped{levelSetHash(*target.grid), voxelSizeOf(*target.grid), target.domainRecorded};
    const TextureDepth& depth = pairs.depth;
    result.reach = depth.reach;
    Stage reading(ctx, "distances around the target's surface", 1);
    const int most = options.draft ? kDraftLevels : 3;
    const VolumeAnalogyOptions& synthesis = pairs.options.synthesis;
    const int levels = synthesis.levels == 0 ? most : std::clamp(synthesis.levels, 1, 6);
    const int radius = (synthesis.half + 2) << (levels - 1 + int(options.draft));
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
    const auto searched = options.draft ? halvedTarget(target, box, cut, float(band), ctx) : plain;
    reading.advance();
    const FieldPlace place{target.grid.get(), {double(box.min.x), double(box.min.y), double(box.min.z)}, 1};
    FieldPlace searchedPlace = place;
    if (options.draft) searchedPlace = {place.like, place.corner + Vec3d{0.5, 0.5, 0.5}, 2};
    const FrameField frames =
        framesOf(searched, searchedPlace, options.direction, "the target", "direction", ctx);
    VolumeAnalogyResult made = makeAnalogy(*pairs.trained, *searched, frames, ctx);
    if (options.draft) made = refinedDraft(made, plain->box());
    SourceMap& map = result.map = mapOf(made, pairs, options.scale);
    map.target = mapped;
    map.elements = placed(made.sources, pairs.places, box.min, options.scale);
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
    for (std::size_t p = 0; p < pairs.fields.size(); ++p) {
        samples.push_back({pairs.fields[p].textured, pairs.fields[p].place.corner, options.scale});
        textured.push_back(&pairs.textured[p]);
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
        result.singularities.push_back(searchedPlace.toWorld(cast<double>(p)));
    result.cut = frames.sweep().cut;
    return result;
}

void requireSettings(const AnalogyOptions& options) {
    requireOption(options.scale >= 0.25 && options.scale <= 4, "scale", roundedText(options.scale, 6),
                  "from 0.25 to 4");
    requireOption(options.strength >= 0 && options.strength <= 1, "strength",
                  roundedText(options.strength, 6), "from 0 to 1");
    validate(options.synthesis);
    requireHalfWidth(double(options.halfWidth));
    requireDirection(options.direction, "direction");
    requireDirection(options.exemplarDirection, "exemplarDirection");
}

void requirePairs(const std::vector<AnalogyModelPair>& pairs) {
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string what = pairs.size() > 1 ? "pair " + std::to_string(p + 1) : "the pair";
        requireModel(pairs[p].plain, what + ", plain");
        requireModel(pairs[p].textured, what + ", textured");
        requireOnePlace(pairs[p]);
    }
}

}  // namespace

void validate(const AnalogyOptions& options, const std::vector<AnalogyModelPair>& pairs,
              const LevelSet& target) {
    requireSettings(options);
    requirePairs(pairs);
    requireModel(&target, "the target");
}

AnalogyResult makeAnalogyModel(const std::vector<AnalogyModelPair>& pairs, const LevelSet& target,
                               const AnalogyOptions& options, const RunContext& ctx) {
    validate(options, pairs, target);
    return withThreads(
        ctx, [&] { return madeAnalogy(*preparedPairs(pairs, options, ctx), target, options, ctx); });
}

std::shared_ptr<const PreparedPairs> preparePairs(const std::vector<AnalogyModelPair>& pairs,
                                                  const AnalogyOptions& options, const RunContext& ctx) {
    requireSettings(options);
    requirePairs(pairs);
    return withThreads(ctx, [&] { return preparedPairs(pairs, options, ctx); });
}

AnalogyResult makeAnalogyModel(const PreparedPairs& pairs, const LevelSet& target,
                               const AnalogyOptions& options, const RunContext& ctx) {
    requireSettings(options);
    requireModel(&target, "the target");
    requireOption(options.scale == pairs.options.scale, "scale", roundedText(options.scale, 6),
                  roundedText(pairs.options.scale, 6) + ", as when the pairs were prepared");
    requireOption(options.draft == pairs.options.draft, "draft", options.draft ? "true" : "false",
                  "as when the pairs were prepared");
    return withThreads(ctx, [&] { return madeAnalogy(pairs, target, options, ctx); });
}

}  // namespace vdbsynth
