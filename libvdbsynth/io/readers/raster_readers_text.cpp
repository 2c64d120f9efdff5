// Volumes whose headers are text: GSLIB (as SGeMS writes it) and INRIMAGE.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <cmath>
#include <map>

namespace vdbsynth {

// First line: sides, on some files followed by spacing and origin; then the number of variables, a line with
// the name of each, then rows of values, x fastest. The first variable is read.
Raster readGslib(const std::string& path, const std::string& content, const RasterReadOptions&,
                 const RunContext& ctx) {
    TextScanner scanner(path, content, '\0');
    const std::int64_t columns = scanner.whole(), rows = scanner.whole(), slices = scanner.whole();
    scanner.skipLine();
    const std::int64_t variables = scanner.whole();
    if (variables < 1 || variables > 1000)
        scanner.fail("the second line must be the number of variables, 1 to 1000");
    scanner.skipLine();
    for (std::int64_t i = 0; i < variables; ++i) scanner.skipLine();
    if (!productFits({columns, rows, slices, variables, 2}, content.size() - scanner.position() + 2))
        throw Error(ErrorCode::BadData, path + ": truncated; its header claims " + std::to_string(columns) +
                                            " x " + std::to_string(rows) + " x " + std::to_string(slices) +
                                            " cells");
    Raster raster = makeRaster(path, columns, rows, slices, 1, ctx);
    raster.stack = slices > 1;
    for (float& value : raster.values) {
        value = float(scanner.real());
        for (std::int64_t i = 1; i < variables; ++i) scanner.real();
    }
    return raster;
}

namespace {

std::map<std::string, std::string> inrFields(const std::string& header) {
    std::map<std::string, std::string> fields;
    std::size_t at = 0;
    while (at < header.size()) {
        const std::size_t end = std::min(header.find('\n', at), header.size()), equals = header.find('=', at);
        if (equals < end)
            fields[header.substr(at, equals - at)] = header.substr(equals + 1, end - equals - 1);
        at = end + 1;
    }
    return fields;
}

SampleType inrType(const std::string& path, const std::string& type, const std::string& bits) {
    const bool real = type == "float", isSigned = type.compare(0, 6, "signed") == 0;
    const std::string size = bits.substr(0, bits.find(' '));
    if (real && size == "32") return SampleType::F32;
    if (real && size == "64") return SampleType::F64;
    if (!real && size == "8") return isSigned ? SampleType::I8 : SampleType::U8;
    if (!real && size == "16") return isSigned ? SampleType::I16 : SampleType::U16;
    if (!real && size == "32") return isSigned ? SampleType::I32 : SampleType::U32;
    throw Error(ErrorCode::BadData,
                path + ": holds values of type " + type + " of " + bits + ", which is not supported");
}

}  // namespace

Raster readInr(const std::string& path, const std::string& content, const RasterReadOptions&,
               const RunContext& ctx) {
    const std::size_t end = content.find("##}\n");
    if (content.compare(0, 13, "#INRIMAGE-4#{") != 0 || end == std::string::npos)
        throw Error(ErrorCode::BadData, path + ": not an INRIMAGE file");
    auto fields = inrFields(content.substr(0, end));
    const auto side = [&](const char* name) {
        std::int64_t value = 0;
        if (!parseWhole(fields[name], value))
            throw Error(ErrorCode::BadData, path + ": its header has no usable " + name);
        return value;
    };
    std::int64_t variables = 1;
    if (fields.count("VDIM")) variables = side("VDIM");
    if (variables != 1) throw Error(ErrorCode::BadData, path + ": holds vectors; one value a voxel is read");
    const SampleType type = inrType(path, fields["TYPE"], fields["PIXSIZE"]);
    const std::int64_t columns = side("XDIM"), rows = side("YDIM"), slices = side("ZDIM");
    const std::size_t start = end + 4;
    if (!productFits({columns, rows, slices, std::int64_t(bytesOf(type))}, content.size() - start))
        throw Error(ErrorCode::BadData, path + ": truncated");
    Raster raster = makeRaster(path, columns, rows, slices, 1, ctx);
    raster.stack = true;
    const char* names[3] = {"VX", "VY", "VZ"};
    for (int axis = 0; axis < 3; ++axis) {
        float spacing = 0;
        if (!fields.count(names[axis]) || !parseAnyReal(fields[names[axis]], spacing)) continue;
        raster.spacing[axis] = double(spacing);
        raster.knownSpacing = true;
    }
    const bool swap = fields["CPU"] == "sun" || fields["CPU"] == "sgi";
    toFloats(content.data() + start, raster.values.size(), type, swap, raster.values.data());
    return raster;
}

}  // namespace vdbsynth
