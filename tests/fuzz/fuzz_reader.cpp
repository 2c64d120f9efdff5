// One reader under libFuzzer: FUZZ_CALL is the call, of `path` and `content`. Anything but a result or an
// Error is found.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/package/zip_file.h"
#include "libvdbsynth/io/points/point_readers.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace {

// A 3MF package of this model: changed bytes of a packed one only have a wrong checksum.
[[maybe_unused]] std::string packageOf(const std::string& content) {
    vdbsynth::ZipWriter zip;
    zip.add("3D/3dmodel.model", content);
    zip.add("3D/b.model", content);
    zip.add("Metadata/Slic3r_PE_model.config", content);
    return zip.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vdbsynth;
    const std::string path = "fuzz", content(reinterpret_cast<const char*>(data), size);
    RunContext ctx;
    ctx.maxMemory = 300000000;
    try {
        (void)(FUZZ_CALL);
    } catch (const Error& error) {
        if (std::string(error.what()).empty()) __builtin_trap();
    }
    return 0;
}
