#pragma once
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"

#include <string>

namespace vdbsynth::test {

/// What a reader of rasters gave: the raster and its messages, or what it threw.
struct RasterReading {
    Raster raster;
    std::string said;
    Thrown thrown;
};

/// @param name  of the array to read, or empty
template <typename Reader>
RasterReading readRasterBy(Reader reader, const std::string& path, const std::string& content,
                           const std::string& name = "") {
    RasterReading read;
    RunContext ctx;
    ctx.maxMemory = 100000000;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { read.said += text + "\n"; };
    read.thrown = thrownBy([&] { read.raster = reader(path, content, {name}, ctx); });
    return read;
}

}  // namespace vdbsynth::test
