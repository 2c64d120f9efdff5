#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

struct PackedBall {
    Vec3d centre;
    double radius = 0;
};

/// Balls of radius radiusLow..radiusHigh dropped at random into the box [low, high] until they would fill
/// `density` of it, pushed apart where they overlap for a fixed number of rounds, then shrunk where they
/// still do: no two balls overlap or touch.
/// @param density  0..0.6
/// @par Cost    O(balls) per round    @par Repeats same result for (arguments, seed)
std::vector<PackedBall> packBalls(const Vec3d& low, const Vec3d& high, double radiusLow, double radiusHigh,
                                  double density, std::uint64_t seed, const RunContext& ctx = {});

}  // namespace vdbsynth
