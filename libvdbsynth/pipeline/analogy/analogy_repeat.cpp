// Applies a map to textured models and a plain one: the last step of analogy, and all of its repetition.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/grid/islands.h"
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/kept_voxels.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

constexpr float kResultBand = 6;  // [voxels] in which the result's distances are blended
constexpr int kIslandSide = 4;    // [voxels] components that fit into a cube of this side may be islands
constexpr double kFewCut = 0.01;  // share of the voxels with a source at whose edge the surface may end

// Strength of the texture over the target, in voxels of the result.
BrickField weightOf(const SourceMap& map, int factor, const IndexBox& box, const RunContext& ctx) {
    const BrickField& weight = map.analogy.weight;
    if (weight.box().empty()) return BrickField(box, map.analogy.strength);
    if (factor == 1) return weight;
    const Index3 first = finerBox(map.targetBox, factor).min;
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const Index3 p = brick.min + Index3{i >> 6, (i >> 3) & 7, i & 7} + first;
            Vec3f at;
            for (int axis = 0; axis < 3; ++axis)
                at[axis] = float(p[axis]) / float(factor) - float(map.targetBox.min[axis]);
            samples[i] = sampleTrilinear(weight, at);
        }
    });
}

// The target where the weight is 0, the result where it is 1, between them a blend.
BrickField blended(const BrickField& target, const BrickField& made, const BrickField& weight,
                   const RunContext& ctx) {
    return BrickField::generate(made.box(), ctx, [&](const IndexBox& brick, float* samples) {
        std::array<float, BrickField::kSamples> plain, share;
        made.readBox(brick.min, brick.size(), samples);
        target.readBox(brick.min, brick.size(), plain.data());
        weight.readBox(brick.min, brick.size(), share.data());
        for (std::size_t i = 0; i < plain.size(); ++i) {
            const float before = std::clamp(plain[i], -kResultBand, kResultBand);
            samples[i] = share[i] == 1 ? samples[i] : before + share[i] * (samples[i] - before);
        }
    });
}

void removeIslandsOf(BrickField& field, const std::vector<ExemplarSamples>& textured, int factor,
                     const RunContext& ctx) {
    std::vector<std::shared_ptr<const BrickField>> exemplars;
    for (const ExemplarSamples& samples : textured) exemplars.push_back(samples.field);
    const std::uint64_t side = std::uint64_t(kIslandSide) * std::uint64_t(factor);
    for (const bool ofVoid : {false, true}) {
        const IslandLimits limits = islandLimits(exemplars, side * side * side, ofVoid, ctx);
        const std::size_t changed = removeIslands(field, limits, ofVoid, ctx);
        message(ctx, MessageLevel::Detail,
                std::to_string(changed) + " voxels in islands of the " + (ofVoid ? "void" : "solid") +
                    " were flipped");
    }
}

// Removing islands leaves what the mask keeps: voxels of the weight 0.
void restoreWeightless(const BrickField& target, const BrickField& weight, BrickField& field,
                       const RunContext& ctx) {
    field = BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        std::array<float, BrickField::kSamples> plain, share;
        field.readBox(brick.min, brick.size(), samples);
        target.readBox(brick.min, brick.size(), plain.data());
        weight.readBox(brick.min, brick.size(), share.data());
        for (std::size_t i = 0; i < plain.size(); ++i)
            if (share[i] == 0) samples[i] = std::clamp(plain[i], -kResultBand, kResultBand);
    });
}

// A texture that reaches farther than the map's, or another plain model, ends where there are no sources.
void warnIfCut(const SourceMap& map, int factor, const BrickField& made, const RunContext& ctx) {
    const VoxelTable table = VoxelTable::of(map.targetBox, map.elements.voxels());
    const Index3 first = finerBox(map.targetBox, factor).min;
    const auto sign = [&](const Index3& voxel) { return made.at(voxel * factor - first) < 0; };
    std::size_t cut = 0;
    for (const Index3& voxel : table.voxels())
        for (int side = 0; side < 6; ++side) {
            Index3 next = voxel;
            next[side / 2] += side % 2 ? 1 : -1;
            if (!map.targetBox.contains(next) || table.find(next) >= 0 || sign(voxel) == sign(next)) continue;
            ++cut;
            break;
        }
    if (double(cut) > kFewCut * double(table.size()))
        message(ctx, MessageLevel::Warning,
                "the result is cut off where the map has no sources (" + std::to_string(cut) +
                    " voxels): the texture reaches farther from the plain surface than the map's, or the "
                    "plain model is in another place; run analogy with these models instead");
}

}  // namespace

Vec3d asWritten(const Vec3d& position) {
    Source source;
    source.position = position;
    const Index3 voxel = nearestVoxel(source);
    Vec3d written;
    for (int axis = 0; axis < 3; ++axis)
        written[axis] = double(voxel[axis]) + double(float(position[axis] - double(voxel[axis])));
    return written;
}

LevelSet analogyThroughMap(const SourceMap& map, int factor, const std::vector<ExemplarSamples>& textured,
                           const BrickField& plain, const LevelSet& target, float reach,
                           const RunContext& ctx) {
    const BrickField made =
        readAnalogy(map.elements, map.analogy.depths, map.targetBox, textured, plain, factor, ctx);
    warnIfCut(map, factor, made, ctx);
    const BrickField weight = weightOf(map, factor, plain.box(), ctx);
    BrickField field = blended(plain, made, weight, ctx);
    removeIslandsOf(field, textured, factor, ctx);
    const bool masked = !map.analogy.weight.box().empty() || map.analogy.strength == 0;
    if (masked) restoreWeightless(plain, weight, field, ctx);
    const Index3 corner = finerBox(map.targetBox, factor).min;
    LevelSet model;
    try {
        const CloseOptions close{map.cut, map.halfWidth, kHalfWidth, voxelSizeOf(*target.grid), false};
        const BrickField band = closedBand(field, corner, close, ctx);
        model.grid = levelSetFrom(band, map.halfWidth, *target.grid, "the result", ctx);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::EmptyInput) throw;
        throw Error(ErrorCode::EmptyInput,
                    "the texture removes the whole target: " +
                        (reach > 0 ? "it is " + std::to_string(int(std::ceil(reach))) +
                                         " voxels deep, and the target is thinner"
                                   : std::string("the target is thinner than the texture's depth")) +
                        "; use smaller voxels for the target, or a smaller `scale` or `strength`");
    }
    if (masked && std::abs(halfWidthOf(*target.grid) - double(map.halfWidth)) < 1e-6)
        keepUnchanged(*target.grid, plain, field, corner, kHalfWidth, map.halfWidth, *model.grid, ctx);
    model.domain = target.domainRecorded ? target.domain : solidBox(*model.grid, "the result");
    model.domainRecorded = target.domainRecorded;
    stampLevelSet(model);
    return model;
}

LevelSet repeatAnalogy(const SourceMap& map, int factor, const std::vector<const LevelSet*>& textured,
                       const LevelSet& target, const RunContext& ctx) {
    const SourceMap scaled = finerMap(map, factor);
    double bytes = double(scaled.targetBox.volume()) * 8;
    for (const MappedExemplar& exemplar : scaled.exemplars) bytes += double(exemplar.box.volume()) * 12;
    requireMemory(ctx, bytes + double(map.elements.size()) * 200, "the repeated analogy",
                  "use models of larger voxels");
    std::vector<ExemplarSamples> samples;
    for (std::size_t e = 0; e < textured.size(); ++e) {
        const IndexBox& box = scaled.exemplars[e].box;
        samples.push_back(
            {std::make_shared<const BrickField>(gatherTextured(*textured[e], box, map.exemplars[e].cut,
                                                               float(kMostReach * factor), map.analogy.scale,
                                                               ctx)),
             Vec3d{double(box.min.x), double(box.min.y), double(box.min.z)} * (1 / double(factor)),
             map.analogy.scale * factor});
        float value = 0;
        if (samples.back().field->constantIn(samples.back().field->box(), value))
            throw Error(ErrorCode::ShapeMismatch,
                        "the textured model has no surface in the map's box " + boxText(box) +
                            "; it does not belong to the map's plain model, or is in another place");
    }
    const BrickField plain = gatherWideBand(*target.grid, scaled.targetBox, map.cut, scaled.band, ctx);
    LevelSet model = analogyThroughMap(map, factor, samples, plain, target, 0, ctx);
    model.attributes = analogyAttributes(scaled, textured, plain, target, *model.grid, ctx);
    return model;
}

}  // namespace vdbsynth
