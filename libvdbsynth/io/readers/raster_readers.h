#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/raster/raster.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace vdbsynth {

// One reader per format, behind readRaster (raster_file.h). `path` is for messages,
// `content` is the whole file.
// @throw Error BadData, Memory
Raster readPng(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx);
Raster readJpeg(const std::string& path, const std::string& content, const RasterReadOptions& options,
                const RunContext& ctx);
Raster readPnm(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx);
Raster readTiff(const std::string& path, const std::string& content, const RasterReadOptions& options,
                const RunContext& ctx);
Raster readExr(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx);
Raster readNpy(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx);
Raster readVti(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx);
Raster readNifti(const std::string& path, const std::string& content, const RasterReadOptions& options,
                 const RunContext& ctx);
Raster readGslib(const std::string& path, const std::string& content, const RasterReadOptions& options,
                 const RunContext& ctx);
Raster readInr(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx);

// The place in `names` of the array to read: that of `options`, else `standard`, which a note says where
// there are several names. @throw Error BadData (no such name; the message lists the names)
std::size_t chosenArray(const std::string& path, const std::vector<std::string>& names, std::size_t standard,
                        const RasterReadOptions& options, const RunContext& ctx);

// Notes by which angle a volume is turned from the axes of the world, if it is.
void sayTurn(const std::string& path, const Raster& raster, const RunContext& ctx);

// A raster of this size with memory for its values.
// @throw Error BadData (a side under 1 or over 2^24), Memory
Raster makeRaster(const std::string& path, std::int64_t columns, std::int64_t rows, std::int64_t slices,
                  int channels, const RunContext& ctx);

// Kinds of number in raw blocks.
enum class SampleType { U8, I8, U16, I16, U32, I32, U64, I64, F16, F32, F64 };
std::size_t bytesOf(SampleType type);
// The value of white in this type, 0 if pictures do not use the type.
double whiteOf(SampleType type);
// Converts `count` samples from raw bytes to floats. @param swap  bytes are in the other order
void toFloats(const char* bytes, std::size_t count, SampleType type, bool swap, float* out);

// The header of a NumPy array, of pictures, volumes and points.
struct NpyHeader {
    SampleType type = SampleType::U8;
    bool swap = false, columnsFirst = false, truths = false;  // truths: of True and False
    std::vector<std::int64_t> shape;                          // slowest first, unless columnsFirst
    std::size_t bytes = 0;                                    // before the numbers
};
// @throw Error BadData (truncated, records, a type other than real numbers)
NpyHeader readNpyHeader(const std::string& path, const std::string& content);

}  // namespace vdbsynth
