#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/io/readers/tiff/stack_description.h"
#include "libvdbsynth/io/readers/tiff/tiff_file.h"
#include "libvdbsynth/io/readers/tiff/tiff_pages.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vdbsynth {

// One image or stack of a TIFF file: a channel, a frame, or the pages of one size.
struct TiffChoice {
    std::string name;                // empty if the file holds nothing else
    std::vector<std::size_t> pages;  // one a slice
    TiffSamples samples;
};

struct TiffContents {
    StackDescription description;     // of the first choices
    std::size_t described = 0;        // how many choices it describes
    bool raw = false;                 // ImageJ's slices behind one page: "pages" are numbers of slices
    std::vector<TiffChoice> choices;  // at least one
    std::vector<std::size_t> masks;   // pages that are opacity
};

// What a file holds and which of it is read. Everything that is guessed or left out is a note or warning.
// @throw Error BadData (no samples)
TiffContents contentsOf(const std::string& path, TiffFile& file, const RasterReadOptions& options,
                        const RunContext& ctx);

}  // namespace vdbsynth
