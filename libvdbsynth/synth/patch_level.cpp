#include "libvdbsynth/synth/patch_level.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

// Some of the positions whose patches lie inside a mask, evenly spread over all of them.
std::vector<Index3> placesInside(const BrickField& maskMeans, int side) {
    constexpr std::size_t kMost = 64;
    std::vector<Index3> all, some;
    const Index3 last = maskMeans.box().max - Index3{side - 1, side - 1, side - 1};
    float value;
    // Without a mask every position is inside.
    if (maskMeans.constantIn(maskMeans.box(), value) && value == 1.f) return {{0, 0, 0}};
    forEachVoxel({{0, 0, 0}, last}, [&](const Index3& p) {
        if (maskMeans.inside(p) == 1.f) all.push_back(p);
    });
    const std::size_t count = std::min(kMost, all.size());
    for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
    return some;
}

// Along axes that tile, a patch beyond the period is the one a period before or after.
std::vector<std::size_t> repeatsOf(const SynthesisPass& pass, const BlockSynthesisOptions& options,
                                   const PatchMap& map) {
    std::vector<std::size_t> repeats;
    if (std::count(options.border.begin(), options.border.end(), Border::Tile) == 0) return repeats;
    repeats.resize(map.source.size());
    for (std::size_t i = 0; i < repeats.size(); ++i) {
        Index3 l = map.place(i);
        for (int axis = 0; axis < 3; ++axis) {
            if (options.border[std::size_t(axis)] != Border::Tile) continue;
            const int around = options.around[axis] / pass.scale, period = pass.target[axis] - 2 * around;
            const int origin = map.origin(axis, l[axis]);
            const int inside = (origin - around + period * 4) % period + around;
            // The last patch may end with the target, off the lattice; it lies beyond the tile.
            if (origin % map.stride == 0) l[axis] = inside / map.stride;
        }
        repeats[i] = map.index(l);
    }
    return repeats;
}

// Adds an exemplar and its possible sources.
void addExemplar(PatchLevel& level, const PatchMap& map, const BrickField& exemplar, const BrickField* mask,
                 const RunContext& ctx) {
    level.exemplars.push_back(denseField(exemplar));
    level.maskMeans.push_back(mask ? slidingMean(*mask, map.block, ctx) : BrickField(exemplar.box(), 1.f));
    level.fallbacks.push_back(placesInside(level.maskMeans.back(), map.block));
    const Index3 last = exemplar.box().size() - Index3{map.block, map.block, map.block};
    double varied = 0;
    float value;
    const auto count = [&](const Index3& p) {
        varied += level.maskMeans.back().inside(p) == 1.f &&
                  !exemplar.constantIn(IndexBox::cube(p, map.block), value);
    };
    forEachVoxel({{0, 0, 0}, last}, count, map.stride);
    level.surfacePlaces.push_back(std::max(1.0, varied));
}

}  // namespace

PatchLevel patchLevel(const SynthesisPass& pass, const BlockSynthesisOptions& options, const PatchMap& map,
                      const std::vector<const BrickField*>& masks, const BrickField* open,
                      const RunContext& ctx) {
    PatchLevel level;
    level.pass = &pass;
    level.options = &options;
    for (std::size_t e = 0; e < pass.exemplars.size(); ++e)
        addExemplar(level, map, *pass.exemplars[e], e < masks.size() ? masks[e] : nullptr, ctx);
    const Index3 half{map.block / 2, map.block / 2, map.block / 2};
    for (std::size_t i = 0; options.exemplarMap && i < map.source.size(); ++i)
        level.only.push_back(exemplarAt(options, pass, map.originOf(map.place(i)) + half));
    level.repeats = repeatsOf(pass, options, map);
    for (std::size_t i = 0; open && i < map.source.size(); ++i) {
        float value;
        level.fixed.push_back(
            open->constantIn(IndexBox::cube(map.originOf(map.place(i)), map.block), value) && value == 0.f);
    }
    return level;
}

IndexBox sourcesFor(const PatchLevel& level, const PatchMap& map, std::size_t e, const Index3& origin) {
    return sourceBox(*level.options, *level.pass, level.exemplars[e].size, map.block, origin);
}

void drawSources(const PatchLevel& level, PatchMap& map, const RunContext& ctx) {
    constexpr int kDraws = 64;
    constexpr std::uint32_t kPurpose = 0x64726177;
    parallelFor(ctx, map.source.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Random random(ctx.seed, i, kPurpose);
            const Index3 origin = map.originOf(map.place(i));
            float least = std::numeric_limits<float>::infinity();
            for (int draw = 0; draw < kDraws; ++draw) {
                const std::uint32_t count = std::uint32_t(level.exemplars.size());
                const std::int32_t e = level.only.empty() || level.only[i] < 0
                                           ? std::int32_t(random.below(count))
                                           : level.only[i];
                const IndexBox box = sourcesFor(level, map, std::size_t(e), origin);
                if (box.empty()) continue;
                Index3 place;
                for (int axis = 0; axis < 3; ++axis)
                    place[axis] = box.min[axis] + int(random.below(std::uint32_t(box.size()[axis])));
                if (!level.eligible(std::size_t(e), place)) continue;
                const float cost =
                    level.guidance.empty() ? 0.f : level.guidance.cost(origin, std::size_t(e), place);
                if (cost >= least) continue;
                least = cost;
                map.source[i] = place;
                map.exemplar[i] = e;
                if (level.guidance.empty()) break;
            }
        }
    });
}

void liftSources(const PatchLevel& level, const PatchMap& coarse, int factor, PatchMap& map,
                 const RunContext& ctx) {
    parallelFor(ctx, map.source.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index3 origin = map.originOf(map.place(i));
            Index3 middle;
            for (int axis = 0; axis < 3; ++axis)
                middle[axis] = std::min((origin[axis] + map.block / 2) / factor, coarse.target[axis] - 1);
            const Index3 strongest = strongestBlock(coarse, middle);
            const std::size_t from = coarse.index(strongest);
            if (!level.allows(i, coarse.exemplar[from])) continue;  // keeps the drawn source
            map.exemplar[i] = coarse.exemplar[from];
            const IndexBox box = sourcesFor(level, map, std::size_t(map.exemplar[i]), origin);
            const Index3 source = origin + (coarse.source[from] - coarse.originOf(strongest)) * factor;
            for (int axis = 0; axis < 3; ++axis)
                map.source[i][axis] =
                    std::clamp(source[axis], box.min[axis], std::max(box.min[axis], box.max[axis]));
        }
    });
}

void copyRepeats(const PatchLevel& level, PatchMap& map) {
    for (std::size_t i = 0; i < level.repeats.size(); ++i) {
        const std::size_t from = level.repeats[i];
        map.source[i] = map.source[from];
        map.exemplar[i] = map.exemplar[from];
        if (!map.weight.empty()) map.weight[i] = map.weight[from];
    }
}

}  // namespace vdbsynth
