#include "libvdbsynth/math/nearest_frame.h"

#include <algorithm>

namespace vdbsynth {

std::array<Vec3d, 3> nearestFrame(const std::array<Vec3d, 3>& axes) {
    // The mean of a matrix and its inverse transposed, until nothing changes.
    constexpr int kMostSteps = 100;
    std::array<Vec3d, 3> frame = axes;
    for (int step = 0; step < kMostSteps; ++step) {
        const std::array<Vec3d, 3> before = frame;
        const double scale = 0.5 / dot(before[0], cross(before[1], before[2]));
        double most = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            frame[i] = before[i] * 0.5 + cross(before[(i + 1) % 3], before[(i + 2) % 3]) * scale;
            most = std::max(most, length(frame[i] - before[i]));
        }
        if (most < 1e-15) break;
    }
    return frame;
}

}  // namespace vdbsynth
