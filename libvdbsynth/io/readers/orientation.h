#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster.h"

#include <string>
#include <string_view>

namespace vdbsynth {

// How a picture lies in a file, as tag 274 of TIFF and EXIF says: 1 upright, 2 mirrored, 3 half a turn, 4
// upside down and mirrored, 5 to 8 with columns and rows exchanged.

// The orientation in a block of EXIF, which begins with its byte order: hostile, so every offset is checked.
// @return the number as stored; 1 if there is none, or the block is damaged
int exifOrientation(std::string_view block);

// Turns every slice upright, with a note that names `source` ("EXIF orientation"). A number that is no
// orientation is ignored, with a note.
// @throw Error Memory
void turnUpright(const std::string& path, Raster& raster, int orientation, const std::string& source,
                 const RunContext& ctx);

}  // namespace vdbsynth
