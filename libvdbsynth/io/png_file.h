#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth {

/// An 8-bit colour picture, rows from the top: red, green, blue and, with four channels, opacity (not
/// multiplied into the colours).
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;  ///< [height x width x channels]
    int channels = 3;                  ///< 3 or 4
};

/// Writes a PNG without time stamps: the same picture gives the same bytes.
/// @throw Error Io
void writePng(const std::string& path, const Picture& picture);
/// The bytes of such a file. @throw Error Memory
std::string encodePng(const Picture& picture);

}  // namespace vdbsynth
