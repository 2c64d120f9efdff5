#include "libvdbsynth/synth/open_fill.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/search/block_index.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace vdbsynth {
namespace {

// The blocks that still have open samples, with their numbers of known samples.
class Frontier {
public:
    Frontier(const PatchMap& map, const BrickField& open) : mMap(map) {
        for (std::size_t i = 0; i < map.source.size(); ++i) {
            const int known = count(i, open);
            if (known < volume()) mKnown.emplace_back(i, known);
        }
    }

    bool empty() const { return mKnown.empty(); }
    std::size_t size() const { return mKnown.size(); }

    // Takes the block with the most known samples, the first of several.
    std::size_t take() {
        const auto best = std::max_element(mKnown.begin(), mKnown.end(), [](const auto& a, const auto& b) {
            return a.second != b.second ? a.second < b.second : a.first > b.first;
        });
        const std::size_t i = best->first;
        mKnown.erase(best);
        return i;
    }

    // Recounts the blocks that a filled block overlaps; blocks without open samples are done.
    void update(std::size_t filled, const BrickField& open) {
        const Index3 at = mMap.originOf(mMap.place(filled));
        for (auto& [i, known] : mKnown) {
            const Index3 other = mMap.originOf(mMap.place(i));
            bool overlap = true;
            for (int axis = 0; axis < 3; ++axis)
                overlap = overlap && std::abs(at[axis] - other[axis]) < mMap.block;
            if (overlap) known = count(i, open);
        }
        mKnown.erase(std::remove_if(mKnown.begin(), mKnown.end(),
                                    [&](const auto& entry) { return entry.second == volume(); }),
                     mKnown.end());
    }

private:
    int volume() const { return mMap.block * mMap.block * mMap.block; }

    int count(std::size_t i, const BrickField& open) const {
        mSamples.resize(std::size_t(volume()));
        open.readBox(mMap.originOf(mMap.place(i)), {mMap.block, mMap.block, mMap.block}, mSamples.data());
        return int(std::count(mSamples.begin(), mSamples.end(), 0.f));
    }

    const PatchMap& mMap;
    std::vector<std::pair<std::size_t, int>> mKnown;
    mutable std::vector<float> mSamples;
};

struct Filling {
    BlockMatch match;
    std::int32_t exemplar = 0;
};

// The best match of all exemplars for a block's known samples.
Filling bestFilling(const std::vector<BlockIndex>& indices, const std::vector<float>& samples,
                    const std::vector<std::uint8_t>& known) {
    std::optional<Filling> best;
    for (std::size_t e = 0; e < indices.size(); ++e) {
        BlockQuery query;
        query.samples = samples.data();
        query.known = known.data();
        const std::vector<BlockMatch> matches = indices[e].match(query, 1);
        if (!matches.empty() && (!best || matches.front().cost < best->match.cost))
            best = Filling{matches.front(), std::int32_t(e)};
    }
    if (!best)
        throw Error(ErrorCode::Unusable,
                    "the exemplar has nothing left to fill the hole from; give an EXEMPLAR");
    return *best;
}

}  // namespace

PatchMap fillOpen(const SynthesisPass& pass, const std::vector<const BrickField*>& masks,
                  const BrickField& open, BrickField& field, const RunContext& ctx) {
    BlockIndexOptions indexOptions;
    indexOptions.block = pass.block;
    std::vector<BlockIndex> indices;
    for (const auto& exemplar : pass.exemplars) {
        indexOptions.mask = indices.size() < masks.size() ? masks[indices.size()] : nullptr;
        indices.push_back(BlockIndex::build(exemplar, indexOptions, ctx));
    }
    PatchMap map;
    map.target = pass.target;
    map.block = pass.block;
    map.stride = pass.block / 2;
    map.allocate();
    BrickField still = open;
    Frontier frontier(map, still);
    const Index3 side{pass.block, pass.block, pass.block};
    std::vector<float> samples(latticeCount(side)), openSamples(samples.size());
    std::vector<std::uint8_t> known(samples.size()), unknown(samples.size());
    const std::vector<float> none(samples.size(), 0.f);
    std::vector<std::uint8_t> matched(map.source.size(), 0);
    while (!frontier.empty()) {
        throwIfCancelled(ctx);
        const std::size_t i = frontier.take();
        const Index3 origin = map.originOf(map.place(i));
        field.readBox(origin, side, samples.data());
        still.readBox(origin, side, openSamples.data());
        for (std::size_t k = 0; k < known.size(); ++k) {
            known[k] = openSamples[k] == 0.f;
            unknown[k] = !known[k];
        }
        const Filling filling = bestFilling(indices, samples, known);
        map.source[i] = filling.match.position;
        map.exemplar[i] = filling.exemplar;
        matched[i] = 1;
        pass.exemplars[std::size_t(filling.exemplar)]->readBox(filling.match.position, side, samples.data());
        field.writeBox(origin, side, samples.data(), unknown.data());
        still.writeBox(origin, side, none.data());
        frontier.update(i, still);
    }
    const auto first = std::find(matched.begin(), matched.end(), 1);
    for (std::size_t i = 0; first != matched.end() && i < matched.size(); ++i)
        if (!matched[i]) {
            map.source[i] = map.source[std::size_t(first - matched.begin())];
            map.exemplar[i] = map.exemplar[std::size_t(first - matched.begin())];
        }
    return map;
}

}  // namespace vdbsynth
