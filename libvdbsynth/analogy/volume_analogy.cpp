#include "libvdbsynth/analogy/volume_analogy.h"

#include "libvdbsynth/analogy/volume_analogy_level_steps.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <memory>
#include <optional>
#include <string>

namespace vdbsynth {
namespace {

void requirePairs(const std::vector<AnalogyPair>& pairs) {
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string what = "pair " + std::to_string(p + 1);
        requireField(pairs[p].plain.get(), what + ", plain");
        requireField(pairs[p].textured.get(), what + ", textured", pairs[p].plain->box().size());
        if (!pairs[p].frames) throw Error(ErrorCode::InvalidOption, what + ": `frames` are null");
    }
}

}  // namespace

void validate(const VolumeAnalogyOptions& options) {
    const auto whole = [](int value, int low, int high, const char* name) {
        requireOption(value >= low && value <= high, name, std::to_string(value),
                      "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    };
    whole(options.levels, 0, 6, "levels");
    whole(options.sweeps, 1, 10, "sweeps");
    whole(options.half, 1, 4, "half");
    whole(options.coarseHalf, 1, 3, "coarseHalf");
    whole(options.components, 4, 256, "components");
    requireOption(options.coherence >= 0 && options.coherence <= 100, "coherence",
                  roundedText(options.coherence, 6), "from 0 to 100");
    requireOption(options.epsilon >= 0 && options.epsilon <= 100, "epsilon", roundedText(options.epsilon, 6),
                  "from 0 to 100");
}

struct TrainedPairs {
    VolumeAnalogyOptions options;
    std::vector<PairLevels> levels;                           // of each pair
    std::vector<std::unique_ptr<AnalogyTraining>> trainings;  // of each level, the finest first

    FeatureShape shapeAt(int level) const {
        return {options.half, options.coarseHalf, options.causal, level + 1 < options.levels};
    }
};

std::shared_ptr<const TrainedPairs> trainPairs(const std::vector<AnalogyPair>& pairs,
                                               const VolumeAnalogyOptions& options, const RunContext& ctx) {
    validate(options);
    requirePairs(pairs);
    const auto trained = std::make_shared<TrainedPairs>();
    trained->options = options;
    int& levels = trained->options.levels;
    if (levels == 0) levels = usefulLevels(pairs, ctx);
    for (const AnalogyPair& pair : pairs)
        trained->levels.push_back(
            {analogyPyramid(*pair.plain, levels, ctx), analogyPyramid(*pair.textured, levels, ctx)});
    for (int l = 0; l < levels; ++l)
        trained->trainings.push_back(std::make_unique<AnalogyTraining>(
            pairs, trained->levels, l, trained->shapeAt(l), trained->options, ctx));
    return trained;
}

VolumeAnalogyResult makeAnalogy(const TrainedPairs& pairs, const BrickField& target, const FrameField& frames,
                                const RunContext& ctx) {
    requireField(&target, "the target");
    const VolumeAnalogyOptions& options = pairs.options;
    const AnalogyPyramid plain = analogyPyramid(target, options.levels, ctx);
    VolumeAnalogyResult result;
    std::optional<AnalogyLevelResult> made;
    for (int l = options.levels - 1; l >= 0; --l) {
        const AnalogyTraining& training = *pairs.trainings[std::size_t(l)];
        AnalogyLevel level(training, plain, frames, l, pairs.shapeAt(l), made ? &*made : nullptr, options,
                           ctx);
        result.levels.push_back(level.run());
        if (l > 0) {
            made = level.made();
        } else {
            result.sources = level.sources();
            result.depths = training.depths().runs();
        }
    }
    return result;
}

VolumeAnalogyResult makeAnalogy(const std::vector<AnalogyPair>& pairs, const BrickField& target,
                                const FrameField& frames, const VolumeAnalogyOptions& options,
                                const RunContext& ctx) {
    return makeAnalogy(*trainPairs(pairs, options, ctx), target, frames, ctx);
}

}  // namespace vdbsynth
