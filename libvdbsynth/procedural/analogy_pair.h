#pragma once
#include "libvdbsynth/procedural/exemplar.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A model without and with a texture, to learn from [bhat2004, Figures 2, 7, 8, 9].
struct AnalogyPairKind {
    std::string name, summary,
        direction;   ///< which way the texture runs, as parseDirection (pipeline/analogy.h) takes it
    double feature;  ///< default distance from one piece of texture to the next [voxels]
};

const std::vector<AnalogyPairKind>& analogyPairKinds();

struct AnalogyPairFields {
    ExemplarField plain, textured;
    std::string direction;
};

/// @throw Error InvalidOption (unknown kind, a field out of its range)
void validatePair(const ExemplarOptions& options);

/// Both over one domain, only the zero levels are meant. `options.size` is not used: domains follow from
/// resolution and feature.
/// @throw Error InvalidOption (unknown kind, resolution or feature out of range), Cancelled
/// @par Repeats same bits for (options, ctx.seed), any number of threads
AnalogyPairFields makeAnalogyPair(const ExemplarOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
