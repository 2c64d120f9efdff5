#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/orientation.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <string_view>

#include <jerror.h>
#include <jpeglib.h>

namespace vdbsynth {
namespace {

// What libjpeg reported: its first warning, the row at which data ended, or its error.
struct Failure {
    jpeg_error_mgr base;
    std::jmp_buf leave;
    char text[JMSG_LENGTH_MAX];
    bool warned, ended;
    JDIMENSION endRow;
};

void fail(j_common_ptr info) {
    Failure* failure = reinterpret_cast<Failure*>(info->err);
    failure->base.format_message(info, failure->text);
    std::longjmp(failure->leave, 1);
}

// Damage from which libjpeg goes on; viewers show such images.
void warn(j_common_ptr info, int level) {
    if (level >= 0) return;
    Failure* failure = reinterpret_cast<Failure*>(info->err);
    if (!failure->warned) failure->base.format_message(info, failure->text);
    failure->warned = true;
    if (failure->ended || failure->base.msg_code != JWRN_HIT_MARKER) return;
    failure->ended = true;
    failure->endRow = reinterpret_cast<j_decompress_ptr>(info)->output_scanline;
}

// libjpeg exits by longjmp: nothing in these two has a destructor.
bool readHeader(jpeg_decompress_struct& info, Failure& failure, const std::string& content) {
    constexpr unsigned kLongestMarker = 0xffff;
    if (setjmp(failure.leave)) return false;
    jpeg_create_decompress(&info);
    jpeg_save_markers(&info, JPEG_APP0 + 1, kLongestMarker);
    jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(content.data()), content.size());
    jpeg_read_header(&info, TRUE);
    info.out_color_space = info.num_components == 1   ? JCS_GRAYSCALE
                           : info.num_components == 4 ? JCS_CMYK
                                                      : JCS_RGB;
    info.dct_method = JDCT_ISLOW;
    return true;
}

// Red, green and blue from printing inks; Adobe's programs store them as what they leave of white.
void fromInks(const JSAMPLE* inks, bool adobe, float* colour) {
    const float key = adobe ? inks[3] : MAXJSAMPLE - inks[3];
    for (int c = 0; c < 3; ++c) colour[c] = float(adobe ? inks[c] : MAXJSAMPLE - inks[c]) * key / MAXJSAMPLE;
}

bool readRows(jpeg_decompress_struct& info, Failure& failure, JSAMPLE* row, float* out) {
    if (setjmp(failure.leave)) return false;
    jpeg_start_decompress(&info);
    const std::size_t width = info.output_width, components = std::size_t(info.output_components);
    const std::size_t channels = components == 4 ? 3 : components;
    while (info.output_scanline < info.output_height) {
        float* to = out + info.output_scanline * width * channels;
        jpeg_read_scanlines(&info, &row, 1);
        for (std::size_t x = 0; components == 4 && x < width; ++x)
            fromInks(row + 4 * x, info.saw_Adobe_marker, to + 3 * x);
        for (std::size_t i = 0; components != 4 && i < width * components; ++i) to[i] = float(row[i]);
    }
    jpeg_finish_decompress(&info);
    return true;
}

int orientationOf(const jpeg_decompress_struct& info) {
    constexpr std::string_view kBegin("Exif\0\0", 6);
    for (jpeg_saved_marker_ptr marker = info.marker_list; marker; marker = marker->next) {
        const std::string_view data(reinterpret_cast<const char*>(marker->data), marker->data_length);
        if (data.substr(0, kBegin.size()) == kBegin) return exifOrientation(data.substr(kBegin.size()));
    }
    return 1;
}

// @throw Error BadData (no pixel is in the file)
void sayDamage(const std::string& path, const jpeg_decompress_struct& info, const Failure& failure,
               const RunContext& ctx) {
    if (!failure.warned) return;
    constexpr JDIMENSION kFewBlocks = 4;  // down the image
    const JDIMENSION block = JDIMENSION(info.max_v_samp_factor) * DCTSIZE;
    if (failure.ended && failure.endRow == 0 && !info.progressive_mode &&
        info.image_height > kFewBlocks * block)
        throw Error(ErrorCode::BadData, path + ": truncated: not a whole JPEG image: " + failure.text);
    std::string missing;
    if (failure.ended && info.progressive_mode)
        missing = "; its later passes are missing, so parts are blurred or grey";
    else if (failure.ended)
        missing = "; from row " + std::to_string(failure.endRow) + " of " +
                  std::to_string(info.image_height) + " on, parts may be missing and are grey";
    message(ctx, MessageLevel::Warning,
            path + ": is damaged and was read as far as possible: " + failure.text + missing);
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
    const int orientation = orientationOf(info);  // libjpeg drops its markers with the last row
    if (info.num_components == 2 || info.num_components > 4)
        throw Error(ErrorCode::BadData, path + ": is a JPEG image of " + std::to_string(info.num_components) +
                                            " components, which is not supported; convert it to RGB or grey");
    // An 8 x 8 block takes at least a few bits.
    if (double(info.image_width) * info.image_height > 2000.0 * double(content.size()))
        throw Error(ErrorCode::BadData, path + ": truncated");
    Raster raster =
        makeRaster(path, info.image_width, info.image_height, 1, info.num_components == 1 ? 1 : 3, ctx);
    raster.white = MAXJSAMPLE;
    raster.rowsFromTop = true;
    std::vector<JSAMPLE> row(std::size_t(info.image_width) * std::size_t(info.num_components));
    if (!readRows(info, failure, row.data(), raster.values.data())) throw refuse();
    sayDamage(path, info, failure, ctx);
    if (info.num_components == 4)
        message(ctx, MessageLevel::Note,
                path + ": its inks (CMYK) are converted to red, green and blue without a colour profile");
    turnUpright(path, raster, orientation, "EXIF orientation", ctx);
    return raster;
}

}  // namespace vdbsynth
