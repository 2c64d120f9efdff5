#pragma once
#include <cstdint>

namespace vdbsynth {

/// What happens at the two faces of the target along an axis that grows.
enum class Border {
    Cut,     ///< the texture goes on beyond the face; sources may come from anywhere
    Object,  ///< within a block of a face only sources at the same distance from the same exemplar face, and
             ///< those nowhere else
    Tile     ///< the target goes on at one face as it begins at the other; optimizeTexture only
};

/// How a target is filled.
enum class SynthesisMethod {
    Default,  ///< texture optimization (texture_optimization.h)
    Exact,    ///< blocks in raster order, each the exact best match for what is known, all of them voting
    Paper     ///< as [lagae2004] has it: random padding, 256 values, octants copied once
};

struct BlockSynthesisStats {
    int block = 0, levels = 0;
    std::uint64_t matches = 0, nodes = 0, exact = 0;
    double meanCost = 0;           ///< of the last pass's matches [voxels^2]
    std::uint64_t indexBytes = 0;  ///< of the largest pass
};

}  // namespace vdbsynth
