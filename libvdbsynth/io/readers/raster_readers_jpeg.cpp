#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

namespace vdbsynth {
namespace {

struct Failure {
    jpeg_error_mgr base;
    std::jmp_buf leave;
    char text[JMSG_LENGTH_MAX];
};

void fail(j_common_ptr info) {
    Failure* failure = reinterpret_cast<Failure*>(info->err);
    failure->base.format_message(info, failure->text);
    std::longjmp(failure->leave, 1);
}

// Damage that libjpeg only warns of: its substitute for missing data is not the image.
void warn(j_common_ptr info, int level) {
    if (level < 0) fail(info);
}

// libjpeg exits by longjmp: nothing in these two has a destructor.
bool readHeader(jpeg_decompress_struct& info, Failure& failure, const std::string& content) {
    if (setjmp(failure.leave)) return false;
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(content.data()), content.size());
    jpeg_read_header(&info, TRUE);
    info.out_color_space = info.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    info.dct_method = JDCT_ISLOW;
    return true;
}

bool readRows(jpeg_decompress_struct& info, Failure& failure, JSAMPLE* row, Raster& raster) {
    if (setjmp(failure.leave)) return false;
    jpeg_start_decompress(&info);
    const std::size_t width = std::size_t(info.output_width) * std::size_t(info.output_components);
    while (info.output_scanline < info.output_height) {
        float* out = raster.values.data() + info.output_scanline * width;
        jpeg_read_scanlines(&info, &row, 1);
        for (std::size_t i = 0; i < width; ++i) out[i] = float(row[i]);
    }
    jpeg_finish_decompress(&info);
    return true;
}

}  // namespace

Raster readJpeg(const std::string& path, const std::string& content, const RasterReadOptions&,
                const RunContext& ctx) {
    jpeg_decompress_struct info{};
    Failure failure{};
    info.err = jpeg_std_error(&failure.base);
    failure.base.error_exit = fail;
    failure.base.emit_message = warn;
    struct Ender {
        jpeg_decompress_struct& info;
        ~Ender() { jpeg_destroy_decompress(&info); }
    } ender{info};
    const auto refuse = [&] {
        return Error(ErrorCode::BadData, path + ": not a whole JPEG image: " + failure.text);
    };
    if (!readHeader(info, failure, content)) throw refuse();
    if (info.num_components > 3)
        throw Error(ErrorCode::BadData,
                    path + ": is a JPEG image in CMYK, which is not supported; convert it to RGB or grey");
    // An 8 x 8 block takes at least a few bits.
    if (double(info.image_width) * info.image_height > 2000.0 * double(content.size()))
        throw Error(ErrorCode::BadData, path + ": truncated");
    Raster raster =
        makeRaster(path, info.image_width, info.image_height, 1, info.num_components == 1 ? 1 : 3, ctx);
    raster.white = 255;
    raster.rowsFromTop = true;
    std::vector<JSAMPLE> row(std::size_t(info.image_width) * std::size_t(raster.channels));
    if (!readRows(info, failure, row.data(), raster)) throw refuse();
    return raster;
}

}  // namespace vdbsynth
