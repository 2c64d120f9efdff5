#include "libvdbsynth/io/png_file.h"

#include "libvdbsynth/base/error.h"

#include <png.h>

#include <cerrno>
#include <cstring>

namespace vdbsynth {

void writePng(const std::string& path, const Picture& picture) {
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(picture.width);
    image.height = png_uint_32(picture.height);
    image.format = PNG_FORMAT_RGB;
    image.flags = PNG_IMAGE_FLAG_FAST;
    errno = 0;
    if (!png_image_write_to_file(&image, path.c_str(), 0, picture.pixels.data(), 0, nullptr))
        throw Error(ErrorCode::Io,
                    path + ": cannot be written: " + (errno ? std::strerror(errno) : image.message));
}

}  // namespace vdbsynth
