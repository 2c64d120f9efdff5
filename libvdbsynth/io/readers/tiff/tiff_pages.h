#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/readers/tiff/tiff_file.h"

#include <cstddef>
#include <string>

namespace vdbsynth {

// What is read of each page: `channels` samples from `first` on.
struct TiffSamples {
    std::size_t first = 0;
    int channels = 1;
};

// True if samples are read as stored: grey, red green blue, and (of a stack) the numbers of a palette, of
// whole numbers of 1 to 32 or 64 bits and real ones of 16, 32 and 64. Others libtiff converts to 8-bit
// colours.
bool isStored(const TiffPage& page, bool stack);
// Samples that are no opacity.
std::size_t dataSamples(const TiffPage& page);
// The value of white, 0 for real values and numbers of over 16 bits.
double whiteOf(const TiffPage& page, bool stack);

// Numbers of `bits` bits, packed from the highest bit of each byte on, as floats; of 24 bits in the
// machine's order of bytes, as libtiff leaves them.
void unpackBits(const char* bytes, std::size_t count, int bits, bool isSigned, float* out);

// The selected page into `out` [height x width x channels]; a pixel of opacity zero has no data.
// @throw Error BadData, Memory
void readTiffPage(const std::string& path, TiffFile& file, const TiffPage& page, const TiffSamples& samples,
                  bool stack, const RunContext& ctx, float* out);
// As readTiffPage, of uncompressed samples that lie in the file at an offset. @throw Error BadData
void readRawPage(const std::string& path, const TiffFile& file, const TiffPage& page,
                 const TiffSamples& samples, const std::string& content, std::uint64_t offset, float* out);

}  // namespace vdbsynth
