#pragma once
#include "libvdbsynth/io/png_file.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// Share of a picture's height that a label needs at its lower edge.
inline constexpr double kLabelShare = 0.11;

/// Writes a label in the middle of a picture's lower edge, dark on light and light on dark. One that is wider
/// than the picture is shortened in its middle by "...".
/// @param boxed  lays a light box under it, for pictures that are full of lines
/// @par Repeats yes
void labelPicture(Picture& picture, const std::string& label, bool boxed = false);

/// Pictures side by side in one, without a gap.
/// @throw Error InvalidOption (none, of different heights or channels, or wider than 65535 pixels together)
Picture pictureRow(const std::vector<Picture>& pictures);

}  // namespace vdbsynth
