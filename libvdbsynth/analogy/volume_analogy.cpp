#include "libvdbsynth/analogy/volume_analogy.h"

#include "libvdbsynth/analogy/volume_analogy_level_steps.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <optional>
#include <string>

namespace vdbsynth {
namespace {

void requirePairs(const std::vector<AnalogyPair>& pairs, const BrickField& target) {
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string what = "pair " + std::to_string(p + 1);
        requireField(pairs[p].plain.get(), what + ", plain");
        requireField(pairs[p].textured.get(), what + ", textured", pairs[p].plain->box().size());
        if (!pairs[p].frames) throw Error(ErrorCode::InvalidOption, what + ": `frames` are null");
    }
    requireField(&target, "the target");
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

VolumeAnalogyResult makeAnalogy(const std::vector<AnalogyPair>& pairs, const BrickField& target,
                                const FrameField& frames, const VolumeAnalogyOptions& given,
                                const RunContext& ctx) {
    validate(given);
    requirePairs(pairs, target);
    VolumeAnalogyOptions options = given;
    if (options.levels == 0) options.levels = usefulLevels(pairs, ctx);
    std::vector<PairLevels> levels;
    for (const AnalogyPair& pair : pairs)
        levels.push_back({analogyPyramid(*pair.plain, options.levels, ctx),
                          analogyPyramid(*pair.textured, options.levels, ctx)});
    const AnalogyPyramid plain = analogyPyramid(target, options.levels, ctx);
    VolumeAnalogyResult result;
    std::optional<AnalogyLevelResult> made;
    for (int l = options.levels - 1; l >= 0; --l) {
        const FeatureShape shape{options.half, options.coarseHalf, options.causal, l + 1 < options.levels};
        const AnalogyTraining training(pairs, levels, l, shape, options, ctx);
        AnalogyLevel level(training, plain, frames, l, shape, made ? &*made : nullptr, options, ctx);
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

}  // namespace vdbsynth
