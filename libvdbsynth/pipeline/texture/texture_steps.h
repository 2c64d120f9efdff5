#pragma once
#include "libvdbsynth/pipeline/texture/texture.h"

namespace vdbsynth {

/// Directions of +u at a target's sites, 0 where none is given.
/// @throw Error BadData (a grid of another kind)
std::vector<Vec3f> siteDirections(const TextureShape& shape, const DirectionSource& source,
                                  const RunContext& ctx);

}  // namespace vdbsynth
