#pragma once
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth {

// What a TIFF page's description says of the pages: ImageJ's lines, OME-XML, or tifffile's shape.
struct StackDescription {
    enum class Kind { None, ImageJ, Ome, Shape };
    Kind kind = Kind::None;
    std::int64_t channels = 1, slices = 1, frames = 1;
    std::int64_t images = 1;        // ImageJ: pages in all
    std::string order = "CZT";      // of pages, the fastest first
    double spacing[3] = {0, 0, 0};  // along columns, rows, slices; 0: not given
    double origin[3] = {0, 0, 0};   // ImageJ: where the world's zero lies, in cells from the first sample
    std::string unit;               // of the spacing: "um", "mm"; empty: none, or pixels
    bool calibrated = false;        // ImageJ: values are offset + factor * stored ones
    double calibrationOffset = 0, calibrationFactor = 1;

    // OME: where planes are, if the file says so.
    struct Block {
        std::int64_t page = 0, channel = 0, slice = 0, frame = 0, count = 0;  // count 0: all that follow
    };
    std::vector<Block> blocks;
    bool severalFiles = false;  // OME: planes are in other files too
};

// The name for messages: "ImageJ description".
const char* nameOf(StackDescription::Kind kind);

// Never fails: what does not parse is as if it were not there.
// @param width, height  of the page
StackDescription parseStackDescription(const std::string& text, std::int64_t width, std::int64_t height);

// The page of each plane, [frames x channels x slices]; empty where the description does not fit `pages`
// pages of `samples` samples each, of which each takes a channel.
std::vector<std::size_t> planePages(const StackDescription& description, std::size_t pages,
                                    std::size_t samples);

}  // namespace vdbsynth
