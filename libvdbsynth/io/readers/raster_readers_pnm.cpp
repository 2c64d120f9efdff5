// Netpbm: pgm and ppm, ascii and binary.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

namespace vdbsynth {

Raster readPnm(const std::string& path, const std::string& content, const RasterReadOptions&,
               const RunContext& ctx) {
    const std::string magic = content.substr(0, 2);
    const bool ascii = magic == "P2" || magic == "P3", colour = magic == "P3" || magic == "P6";
    if (!ascii && magic != "P5" && magic != "P6")
        throw Error(ErrorCode::BadData,
                    path + ": not a pgm or ppm image (it does not begin with P2, P3, P5 or P6)");
    TextScanner scanner(path, content, '#', 2);
    const std::int64_t width = scanner.whole(), height = scanner.whole(), white = scanner.whole();
    if (white < 1 || white > 65535) scanner.fail("the value of white must be from 1 to 65535");
    const std::size_t channels = colour ? 3 : 1;
    // A sample takes at least one byte, in text at least two.
    const std::size_t width2 = white > 255 ? 2 : 1, perSample = ascii ? 2 : width2;
    const std::size_t room = content.size() - scanner.position() + 1;
    if (width > 0 && height > 0 && !productFits({width, height, std::int64_t(channels * perSample)}, room))
        throw Error(ErrorCode::BadData, path + ": truncated; its header claims " + std::to_string(width) +
                                            " x " + std::to_string(height) + " pixels");
    Raster raster = makeRaster(path, width, height, 1, int(channels), ctx);
    raster.white = double(white);
    raster.rowsFromTop = true;
    if (ascii) {
        for (float& value : raster.values) {
            const std::int64_t sample = scanner.whole();
            if (sample < 0 || sample > white)
                scanner.fail("a sample is not from 0 to " + std::to_string(white));
            value = float(sample);
        }
        return raster;
    }
    const std::size_t start = scanner.position() + 1;  // one white space ends the header
    if (content.size() < start + raster.values.size() * width2)
        throw Error(ErrorCode::BadData, path + ": truncated");
    toFloats(content.data() + start, raster.values.size(), width2 == 2 ? SampleType::U16 : SampleType::U8,
             /* swap= */ width2 == 2, raster.values.data());
    return raster;
}

}  // namespace vdbsynth
