#pragma once
#include "libvdbsynth/io/png_file.h"

#include <array>
#include <cstdint>
#include <string>

namespace vdbsynth {

/// Colours of pictures, red, green and blue.
using PictureColour = std::array<std::uint8_t, 3>;

/// Lays a colour over a pixel; nothing outside the picture. Of a picture with transparency the pixel becomes
/// more opaque. @param share  0..1
void blendPixel(Picture& picture, int x, int y, const PictureColour& colour, double share);
/// Lays a colour over the pixels of [left, right) x [top, bottom).
void blendRectangle(Picture& picture, int left, int top, int right, int bottom, const PictureColour& colour,
                    double share);

/// [pixels] width of a line of text. @param size  [pixels] height of a capital letter, at least 1
int textWidth(const std::string& text, int size);
/// Draws a line of text with round strokes, in letters of the program's own: ASCII; a box stands for each
/// other character.
/// @param left, base  [pixels] where the text begins, and what its letters stand on
/// @par Repeats yes
void drawText(Picture& picture, const std::string& text, int left, int base, int size,
              const PictureColour& colour);
/// True if every character of a text has a letter.
bool hasLetters(const std::string& text);

}  // namespace vdbsynth
