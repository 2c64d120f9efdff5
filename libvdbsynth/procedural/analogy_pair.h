#pragma once
#include "libvdbsynth/procedural/exemplar.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A model without and with a texture, as training input [bhat2004, Figures 2, 7, 8, 9].
struct AnalogyPairKind {
    std::string name, summary,
        direction;   ///< of the texture, in the form that parseDirection (pipeline/direction/direction.h)
                     ///< reads
    double feature;  ///< default distance from one piece of texture to the next [voxels]
};

const std::vector<AnalogyPairKind>& analogyPairKinds();

struct AnalogyPairFields {
    ExemplarField plain, textured;
    std::string direction;
};

/// @throw Error InvalidOption (unknown kind, a field out of its range)
void validatePair(const ExemplarOptions& options);

/// Both over one domain; only the zero levels are valid. `options.size` is not used: domains follow from
/// resolution and feature.
/// @throw Error InvalidOption (unknown kind, resolution or feature out of range), Cancelled
/// @par Repeats same bits for (options, ctx.seed), any number of threads
AnalogyPairFields makeAnalogyPair(const ExemplarOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
