#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/readers/tiff/tiff_file.h"
#include "libvdbsynth/raster/raster.h"

#include <string>

namespace vdbsynth {

// GeoTIFF's pixel size of the selected page, in metres; degrees become metres at the image's middle. That the
// image is turned or mirrored on the map is left out, with a note.
void readGeography(const std::string& path, const TiffFile& file, Raster& raster, const RunContext& ctx);

// Samples of GDAL's no-data value of the selected page become NaN.
void dropNoData(const TiffFile& file, Raster& raster);

}  // namespace vdbsynth
