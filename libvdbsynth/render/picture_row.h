#pragma once
#include "libvdbsynth/io/png_file.h"

#include <cstddef>
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

/// The same in rows of `columns` pictures of one size, one below the other. What is left of the last row is
/// as the pictures' first column of pixels.
/// @param columns  at least 1 @throw Error InvalidOption (as pictureRow; over 65535 pixels high)
Picture pictureRows(const std::vector<Picture>& pictures, std::size_t columns);

}  // namespace vdbsynth
