#include "libvdbsynth/synth/patch_level.h"

#include "libvdbsynth/grid/pyramid.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Some of the places whose patches lie inside a mask, evenly through all of them.
std::vector<Index3> placesInside(const BrickField& maskMeans, int side) {
    constexpr std::size_t kMost = 64;
    std::vector<Index3> all, some;
    const Index3 last = maskMeans.box().max - Index3{side - 1, side - 1, side - 1};
    for (int x = 0; x <= last.x; ++x)
        for (int y = 0; y <= last.y; ++y)
            for (int z = 0; z <= last.z; ++z)
                if (maskMeans.inside({x, y, z}) == 1.f) all.push_back({x, y, z});
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
            // The last patch may end with the target off the lattice; it lies beyond what tiles.
            if (origin % map.stride == 0) l[axis] = inside / map.stride;
        }
        repeats[i] = map.index(l);
    }
    return repeats;
}

}  // namespace

PatchLevel patchLevel(const SynthesisPass& pass, const BlockSynthesisOptions& options, const PatchMap& map,
                      const BrickField* mask, const BrickField* open, const RunContext& ctx) {
    PatchLevel level;
    level.pass = &pass;
    level.options = &options;
    double varied = 0;
    for (const auto& exemplar : pass.exemplars) {
        level.exemplars.push_back(denseField(*exemplar));
        const Index3 size = exemplar->box().size();
        float value;
        for (int x = 0; x + map.block <= size.x; x += map.stride)
            for (int y = 0; y + map.block <= size.y; y += map.stride)
                for (int z = 0; z + map.block <= size.z; z += map.stride)
                    varied += !exemplar->constantIn(IndexBox::cube({x, y, z}, map.block), value);
    }
    level.surfacePlaces = std::max(1.0, varied);
    level.repeats = repeatsOf(pass, options, map);
    for (std::size_t i = 0; open && i < map.source.size(); ++i) {
        float value;
        level.fixed.push_back(
            open->constantIn(IndexBox::cube(map.originOf(map.place(i)), map.block), value) && value == 0.f);
    }
    if (mask) {
        level.maskMeans.push_back(slidingMean(*mask, map.block, ctx));
        level.fallbacks = placesInside(level.maskMeans.front(), map.block);
    }
    return level;
}

IndexBox sourcesFor(const PatchLevel& level, const PatchMap& map, std::size_t e, const Index3& origin) {
    return sourceBox(*level.options, *level.pass, level.exemplars[e].size, map.block, origin);
}

void liftSources(const PatchLevel& level, const PatchMap& coarse, int factor, PatchMap& map) {
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        const Index3 origin = map.originOf(map.place(i));
        Index3 middle;
        for (int axis = 0; axis < 3; ++axis)
            middle[axis] = std::min((origin[axis] + map.block / 2) / factor, coarse.target[axis] - 1);
        const Index3 strongest = strongestBlock(coarse, middle);
        const std::size_t from = coarse.index(strongest);
        map.exemplar[i] = coarse.exemplar[from];
        const IndexBox box = sourcesFor(level, map, std::size_t(map.exemplar[i]), origin);
        const Index3 source = origin + (coarse.source[from] - coarse.originOf(strongest)) * factor;
        for (int axis = 0; axis < 3; ++axis)
            map.source[i][axis] =
                std::clamp(source[axis], box.min[axis], std::max(box.min[axis], box.max[axis]));
    }
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
