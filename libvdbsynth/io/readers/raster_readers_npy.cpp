// NumPy's .npy, versions 1 to 3.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <map>

namespace vdbsynth {
namespace {

struct Header {
    SampleType type = SampleType::U8;
    bool swap = false, columnsFirst = false;
    std::vector<std::int64_t> shape;
};

// The text after a key of the header's dictionary.
std::string valueOf(const std::string& path, const std::string& text, const std::string& key) {
    const std::size_t at = text.find("'" + key + "'");
    const std::size_t colon = at == std::string::npos ? at : text.find(':', at);
    if (colon == std::string::npos) throw Error(ErrorCode::BadData, path + ": its header has no " + key);
    const std::size_t begin = text.find_first_not_of(' ', colon + 1);
    return begin == std::string::npos ? "" : text.substr(begin);
}

SampleType typeOf(const std::string& path, const std::string& code) {
    static const std::map<std::string, SampleType> types{
        {"b1", SampleType::U8},  {"u1", SampleType::U8},  {"i1", SampleType::I8},  {"u2", SampleType::U16},
        {"i2", SampleType::I16}, {"u4", SampleType::U32}, {"i4", SampleType::I32}, {"u8", SampleType::U64},
        {"i8", SampleType::I64}, {"f2", SampleType::F16}, {"f4", SampleType::F32}, {"f8", SampleType::F64}};
    const auto found = types.find(code);
    if (found == types.end())
        throw Error(ErrorCode::BadData,
                    path + ": holds values of type '" + code + "'; only real numbers are supported");
    return found->second;
}

Header parseHeader(const std::string& path, const std::string& text) {
    Header header;
    const std::string descr = valueOf(path, text, "descr");
    if (descr.size() < 5 || (descr[0] != '\'' && descr[0] != '"'))
        throw Error(ErrorCode::BadData, path + ": holds records; only arrays of plain numbers are supported");
    const std::size_t end = descr.find(descr[0], 1);
    const std::string code = descr.substr(1, end == std::string::npos ? 0 : end - 1);
    header.swap = !code.empty() && code[0] == '>';
    header.type = typeOf(path, code.empty() ? code : code.substr(1));
    header.columnsFirst = valueOf(path, text, "fortran_order").compare(0, 4, "True") == 0;
    const std::string shape = valueOf(path, text, "shape");
    std::size_t at = 1;
    while (at < shape.size() && shape[at] != ')') {
        if (shape[at] < '0' || shape[at] > '9') {
            ++at;
            continue;
        }
        std::int64_t side = 0;
        for (; at < shape.size() && shape[at] >= '0' && shape[at] <= '9'; ++at)
            side = std::min<std::int64_t>(side * 10 + (shape[at] - '0'), 1ll << 40);
        header.shape.push_back(side);
    }
    return header;
}

}  // namespace

Raster readNpy(const std::string& path, const std::string& content, const RasterReadOptions&,
               const RunContext& ctx) {
    if (content.compare(0, 6, "\x93NUMPY") != 0 || content.size() < 12)
        throw Error(ErrorCode::BadData, path + ": not an npy file");
    const bool longHeader = content[6] > 1;
    std::uint32_t length = 0;
    std::memcpy(&length, content.data() + 8, longHeader ? 4 : 2);
    const std::size_t start = (longHeader ? 12 : 10) + std::size_t(length);
    if (start > content.size()) throw Error(ErrorCode::BadData, path + ": truncated in its header");
    const Header header = parseHeader(path, content.substr(longHeader ? 12 : 10, length));
    std::vector<std::int64_t> sides = header.shape;  // slowest first
    const std::size_t dimensions = sides.size();
    if (dimensions < 2 || dimensions > 3)
        throw Error(ErrorCode::BadData, path + ": is an array of " + std::to_string(dimensions) +
                                            " dimensions; two (heights) or three (a volume) are read");
    if (dimensions == 2) sides.insert(sides.begin(), 1);
    if (!productFits({sides[0], sides[1], sides[2], std::int64_t(bytesOf(header.type))},
                     content.size() - start))
        throw Error(ErrorCode::BadData, path + ": truncated; its header claims " + std::to_string(sides[0]) +
                                            " x " + std::to_string(sides[1]) + " x " +
                                            std::to_string(sides[2]) + " numbers");
    Raster raster = makeRaster(path, sides[2], sides[1], sides[0], 1, ctx);
    raster.rowsFromTop = dimensions == 2;
    raster.stack = dimensions == 3;
    if (!header.columnsFirst) {
        toFloats(content.data() + start, raster.values.size(), header.type, header.swap,
                 raster.values.data());
        return raster;
    }
    std::vector<float> stored(raster.values.size());
    toFloats(content.data() + start, stored.size(), header.type, header.swap, stored.data());
    std::size_t from = 0;
    forEachVoxel(IndexBox::fromSize(raster.size),
                 [&](const Index3& p) { raster.values[raster.index(p.x, p.y, p.z)] = stored[from++]; });
    return raster;
}

}  // namespace vdbsynth
