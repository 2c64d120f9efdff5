// Which faces of the neighbours a row of voxels has to try.
#include "libvdbsynth/distance/mesh_distance_steps.h"

namespace vdbsynth::nearest_face {

__attribute__((target_clones("avx2", "default"))) void worthTrying(const Padded& around, int centre,
                                                                   const Nearest* row, float halfWidth,
                                                                   std::uint32_t* steps) {
    float limit[kSide];
    std::uint32_t own[kSide];
    for (int z = 0; z < kSide; ++z) {
        // seed() tried every face within one voxel.
        limit[z] = row[z].distance < 0.999f ? -kFar : std::min(row[z].distance, halfWidth);
        own[z] = row[z].face;
        steps[z] = 0;
    }
    if (*std::max_element(limit, limit + kSide) < 0) return;
    std::uint32_t bit = 1;
    for (const Step& step : neighbourSteps()) {
        const float* distance = around.distance + centre + step.offset;
        const std::uint32_t* face = around.face + centre + step.offset;
        for (int z = 0; z < kSide; ++z) steps[z] |= distance[z] <= limit[z] && face[z] != own[z] ? bit : 0;
        bit <<= 1;
    }
}

}  // namespace vdbsynth::nearest_face
