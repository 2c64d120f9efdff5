#pragma once
#include <cstdint>

namespace vdbsynth {

/// Treatment of the target's two faces along an axis that grows.
enum class Border {
    Cut,     ///< the texture continues beyond the face; sources may come from anywhere
    Object,  ///< within a block of a face only sources at the same distance from the same exemplar face,
             ///< which are used nowhere else
    Tile     ///< the target repeats: one face continues the other; optimizeTexture only
};

/// How a target is filled.
enum class SynthesisMethod {
    Default,  ///< texture optimization (texture_optimization.h)
    Exact,    ///< blocks in raster order, each the exact best match for the known samples; all of them vote
    Paper     ///< as in [lagae2004]: random padding, 256 values, octants copied once
};

struct BlockSynthesisStats {
    int block = 0, levels = 0;
    std::uint64_t matches = 0, nodes = 0, exact = 0;
    double meanCost = 0;           ///< of the last pass's matches [voxels^2]
    std::uint64_t indexBytes = 0;  ///< of the largest pass
};

}  // namespace vdbsynth
