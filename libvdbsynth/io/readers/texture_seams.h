#pragma once
#include "libvdbsynth/io/readers/mesh_content.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

inline constexpr std::int32_t kNoTexture = -1;

/// Adds an attribute `uv` from texture coordinates that belong to corners, not to points: a point with
/// several, at a seam, is duplicated for each, behind the other points and with their attributes; one without
/// any gets 0 0.
/// @param cornerTexture  of each of the content's corners, the number of its pair in `texture`, or kNoTexture
/// @param texture        two values of each pair
/// @return false if a coordinate in use is not finite: the attribute is left out then
/// @par Cost    O(corners log seams)   @par Repeats yes
bool splitAtSeams(MeshContent& content, const std::vector<std::int32_t>& cornerTexture,
                  const std::vector<float>& texture);

}  // namespace vdbsynth
