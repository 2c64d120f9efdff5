// Replaces raster_readers_tiff.cpp in a build without libtiff.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"

namespace vdbsynth {

Raster readTiff(const std::string& path, const std::string&, const RasterReadOptions&, const RunContext&) {
    throw Error(ErrorCode::Unusable, path + ": this build does not read TIFF; convert it to png, npy or exr");
}

}  // namespace vdbsynth
