#include "libvdbsynth/synth/synthesis_passes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/grid/pyramid.h"

namespace vdbsynth {
namespace {

using Fields = std::vector<std::shared_ptr<const BrickField>>;

int halfOf(int n) {
    return (n + 1) / 2;
}
Index3 halfOf(const Index3& n) {
    return {halfOf(n.x), halfOf(n.y), halfOf(n.z)};
}

}  // namespace

bool grows(const BlockSynthesisOptions& options, int axis, int length) {
    if (options.open) return true;
    return options.grows ? (*options.grows)[std::size_t(axis)] : options.size[axis] != length;
}

int longestBlock(const Index3& exemplar, const BlockSynthesisOptions& options) {
    int longest = 256;
    for (int axis = 0; axis < 3; ++axis) {
        const bool object = options.border[std::size_t(axis)] == Border::Object;
        const int room =
            grows(options, axis, exemplar[axis]) ? exemplar[axis] / (object ? 4 : 2) : exemplar[axis];
        longest = std::min(longest, room);
    }
    return longest / 2 * 2;
}

IndexBox sourceBox(const BlockSynthesisOptions& options, const SynthesisPass& pass, const Index3& exemplar,
                   int side, const Index3& origin) {
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const int at = origin[axis], length = exemplar[axis], target = pass.target[axis];
        int low = 0, high = length - side;
        if (options.open) {
            // anywhere
        } else if (options.grows ? !(*options.grows)[std::size_t(axis)] : length == target) {
            const int drift = options.drift / pass.scale;
            low = std::max(low, at - drift);
            high = std::min(high, at + drift);
        } else if (options.border[std::size_t(axis)] == Border::Object) {
            if (at < side)
                low = high = at;
            else if (at + side > target - side)
                low = high = length - (target - at);
            else {
                low = side;
                high = length - 2 * side;
            }
        }
        box.min[axis] = low;
        box.max[axis] = high;
    }
    return box;
}

namespace {

// A period that is not a whole number of samples would not divide evenly.
bool halvesWhatTiles(const BlockSynthesisOptions& options, int scale) {
    for (int axis = 0; axis < 3; ++axis)
        if (options.border[std::size_t(axis)] == Border::Tile &&
            (options.size[axis] % (2 * scale) || options.around[axis] % (2 * scale)))
            return false;
    return true;
}

}  // namespace

std::vector<SynthesisPass> planPasses(const Fields& exemplars, const BlockSynthesisOptions& options,
                                      int block, int levels, const RunContext& ctx) {
    std::vector<SynthesisPass> passes{{exemplars, options.size, block, 1}};
    while (int(passes.size()) < levels && halvesWhatTiles(options, passes.back().scale)) {
        SynthesisPass coarse;
        coarse.target = halfOf(passes.back().target);
        coarse.scale = passes.back().scale * 2;
        coarse.block = block;
        BlockSynthesisOptions coarseOptions = options;
        coarseOptions.size = coarse.target;
        for (const auto& exemplar : passes.back().exemplars)
            coarse.block =
                std::min(coarse.block, longestBlock(halfOf(exemplar->box().size()), coarseOptions));
        if (coarse.block < 4) break;
        for (const auto& exemplar : passes.back().exemplars)
            coarse.exemplars.push_back(std::make_shared<BrickField>(halved(*exemplar, ctx)));
        passes.push_back(coarse);
    }
    if (options.levels > int(passes.size()))
        message(ctx, MessageLevel::Note,
                "`levels` " + std::to_string(options.levels) + ": the exemplar is large enough for " +
                    std::to_string(passes.size()) + " levels only; using those");
    return passes;
}

int exemplarAt(const BlockSynthesisOptions& options, const SynthesisPass& pass, const Index3& middle) {
    if (!options.exemplarMap) return -1;
    const Index3 half{pass.scale / 2, pass.scale / 2, pass.scale / 2};
    return int(std::lround(options.exemplarMap->at(middle * pass.scale + half)));
}

std::vector<PassMasks> masksOf(const BlockSynthesisOptions& options, std::size_t passes,
                               const RunContext& ctx) {
    std::vector<PassMasks> all(passes);
    for (std::size_t p = 0; p < passes; ++p)
        for (std::size_t e = 0; e < options.masks.size(); ++e) {
            std::shared_ptr<const BrickField> mask;
            if (options.masks[e])
                mask = p == 0 ? std::make_shared<const BrickField>(*options.masks[e])
                              : std::make_shared<const BrickField>(halvedMask(*all[p - 1].held[e], ctx));
            all[p].held.push_back(mask);
            all[p].each.push_back(mask.get());
        }
    return all;
}

namespace {

void requireFields(const BlockSynthesisOptions& options,
                   const std::vector<std::shared_ptr<const BrickField>>& exemplars) {
    const std::size_t count = exemplars.size();
    const auto perExemplar = [&](const std::vector<const BrickField*>& fields, const std::string& name) {
        for (std::size_t e = 0; e < fields.size(); ++e)
            if (fields[e] || name != "masks")
                requireField(fields[e], "`" + name + "` " + std::to_string(e + 1),
                             exemplars[e]->box().size());
    };
    requireOption(options.masks.size() <= count, "masks", std::to_string(options.masks.size()),
                  "at most one for each exemplar");
    perExemplar(options.masks, "masks");
    requireOption(bool(options.guide) == !options.exemplarGuides.empty(), "guide", "alone",
                  "given together with `exemplarGuides`");
    requireOption(!options.guide || options.exemplarGuides.size() == count, "exemplarGuides",
                  std::to_string(options.exemplarGuides.size()), "one for each exemplar");
    perExemplar(options.exemplarGuides, "exemplarGuides");
    requireOption(bool(options.known) == bool(options.open), "known", "alone", "given together with `open`");
    const std::pair<const BrickField*, const char*> ofTarget[] = {{options.exemplarMap, "`exemplarMap`"},
                                                                  {options.guide, "`guide`"},
                                                                  {options.known, "`known`"},
                                                                  {options.open, "`open`"}};
    for (const auto& [field, name] : ofTarget)
        if (field) requireField(field, name, options.size);
}

}  // namespace

void validate(const BlockSynthesisOptions& options,
              const std::vector<std::shared_ptr<const BrickField>>& exemplars) {
    std::vector<Index3> sizes;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        requireField(exemplars[e].get(), "exemplar " + std::to_string(e + 1));
        sizes.push_back(exemplars[e]->box().size());
    }
    validate(options, sizes);
    requireFields(options, exemplars);
}

void validate(const BlockSynthesisOptions& options, const std::vector<Index3>& exemplars) {
    if (exemplars.empty()) throw Error(ErrorCode::InvalidOption, "synthesis needs at least one exemplar");
    const std::string size = std::to_string(options.size.x) + "," + std::to_string(options.size.y) + "," +
                             std::to_string(options.size.z);
    for (int axis = 0; axis < 3; ++axis)
        requireOption(options.size[axis] >= 4 && options.size[axis] <= 1 << 20, "size", size,
                      "from 4 to 1048576 voxels along each axis");
    requireOption(options.block == 0 || (options.block >= 4 && options.block <= 256), "block",
                  std::to_string(options.block), "a whole number from 4 to 256");
    requireOption(!options.paper || (options.block & (options.block - 1)) == 0, "block",
                  std::to_string(options.block), "a power of two with `method` paper");
    requireOption(options.levels >= 0 && options.levels <= 8, "levels", std::to_string(options.levels),
                  "a whole number from 1 to 8");
    requireOption(options.drift >= 0 && options.drift <= 1 << 20, "drift", std::to_string(options.drift),
                  "from 0 to 1048576 voxels");
    for (int axis = 0; axis < 3; ++axis)
        requireOption(options.around[axis] >= 0 && options.around[axis] < (options.size[axis] + 1) / 2,
                      "around", std::to_string(options.around[axis]),
                      "at least 0 and under half of the target");
    requireOption(options.longestRun >= 0.01 && options.longestRun <= 1, "longestRun",
                  roundedText(options.longestRun, 6), "from 0.01 to 1");
    requireOption(options.guideWeight >= 0.001f && options.guideWeight <= 1000, "guideWeight",
                  roundedText(double(options.guideWeight), 6), "from 0.001 to 1000");
    for (const Index3& exemplar : exemplars)
        for (int axis = 0; axis < 3; ++axis) {
            const int length = exemplar[axis];
            if (!options.open && !options.grows && options.size[axis] < length)
                throw Error(ErrorCode::Unusable, "`size` " + size +
                                                     ": smaller than the exemplar's domain along " +
                                                     char('x' + axis) + " (" + std::to_string(length) +
                                                     " voxels); give at least that, or 1x");
            if (options.block > length)
                throw Error(ErrorCode::Unusable, "`block` " + std::to_string(options.block) +
                                                     ": larger than the exemplar, which has " +
                                                     std::to_string(length) + " voxels along " +
                                                     char('x' + axis));
            if (options.block > 0 && grows(options, axis, length) &&
                options.border[std::size_t(axis)] == Border::Object && options.block * 4 > length)
                throw Error(ErrorCode::Unusable,
                            "`block` " + std::to_string(options.block) +
                                ": an object border needs an exemplar of four blocks along " +
                                char('x' + axis) + ", it has " + std::to_string(length) + " voxels");
        }
}

int deriveBlock(const Index3& exemplar, const BlockSynthesisOptions& options) {
    const int block = std::min(16, longestBlock(exemplar, options));
    if (block < 4)
        throw Error(ErrorCode::Unusable,
                    "the exemplar's domain of " + std::to_string(exemplar.x) + " x " +
                        std::to_string(exemplar.y) + " x " + std::to_string(exemplar.z) +
                        " voxels is too small for blocks of 4; use smaller voxels or a larger `exemplarBox`");
    return block;
}

}  // namespace vdbsynth
