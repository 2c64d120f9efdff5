// NumPy's .npy, versions 1 to 3.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace vdbsynth {
namespace {

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
        throw Error(ErrorCode::BadData, path + ": holds values of type '" + printableText(code, 20) +
                                            "'; only arrays of real numbers are supported");
    return found->second;
}

NpyHeader parseHeader(const std::string& path, const std::string& text) {
    NpyHeader header;
    const std::string descr = valueOf(path, text, "descr");
    if (descr.size() < 5 || (descr[0] != '\'' && descr[0] != '"'))
        throw Error(
            ErrorCode::BadData,
            path +
                ": holds records (a structured array); save one of their fields as an array of its own, or "
                "points with fields x, y, z as one array of three columns, for example with "
                "numpy.lib.recfunctions.structured_to_unstructured");
    const std::size_t end = descr.find(descr[0], 1);
    const std::string code = descr.substr(1, end == std::string::npos ? 0 : end - 1);
    header.swap = !code.empty() && code[0] == '>';
    header.type = typeOf(path, code.empty() ? code : code.substr(1));
    header.truths = code.size() > 1 && code.compare(1, 2, "b1") == 0;
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

// What the indices of the array stand for.
struct Layout {
    std::int64_t sides[3] = {1, 1, 1};    // slices, rows, columns
    std::int64_t strides[3] = {0, 0, 0};  // [values] from one to the next
    std::int64_t parts = 1, partStride = 0;
    bool image = false, colours = false;
};

struct Index {
    std::int64_t side, stride;
};

std::vector<Index> indicesOf(const NpyHeader& header) {
    std::vector<Index> indices;
    for (const std::int64_t side : header.shape) indices.push_back({side, 1});
    const std::size_t count = indices.size();
    for (std::size_t i = 1; i < count; ++i) {
        const std::size_t at = header.columnsFirst ? i : count - 1 - i,
                          before = header.columnsFirst ? at - 1 : at + 1;
        indices[at].stride = indices[before].stride * indices[before].side;
    }
    return indices;
}

// Frameworks add indices of length one; of four that are left, the first or a short last one counts
// channels.
Layout layoutOf(const std::string& path, const NpyHeader& header, const RunContext& ctx) {
    std::vector<Index> indices = indicesOf(header);
    const std::size_t dimensions = indices.size();
    for (std::size_t i = 0; i < indices.size() && indices.size() > 3;)
        if (indices[i].side == 1)
            indices.erase(indices.begin() + std::ptrdiff_t(i));
        else
            ++i;
    if (indices.size() < 2 || indices.size() > 4)
        throw Error(ErrorCode::BadData, path + ": is an array of " + std::to_string(dimensions) +
                                            " dimensions; two (heights), three (a volume) or four (volumes "
                                            "or channels) are read");
    Layout layout;
    if (indices.size() == 4) {
        const bool last = indices[3].side <= 4 && indices[0].side > indices[3].side;
        const auto part = last ? indices.end() - 1 : indices.begin();
        layout.parts = part->side;
        layout.partStride = part->stride;
        indices.erase(part);
        message(ctx, MessageLevel::Note,
                path + ": is an array of four dimensions, of which the " + (last ? "last" : "first") +
                    " is taken for channels");
    }
    const bool bytes = (header.type == SampleType::U8 && !header.truths) || header.type == SampleType::U16;
    layout.colours = layout.parts == 1 && indices.size() == 3 && bytes &&
                     (indices[2].side == 3 || indices[2].side == 4) && indices[0].side >= 8 &&
                     indices[1].side >= 8;
    if (layout.colours) {
        message(ctx, MessageLevel::Note,
                path + ": read as a picture of " + std::to_string(indices[0].side) + " rows and " +
                    std::to_string(indices[1].side) + " columns, whose last dimension holds colours");
        layout.partStride = indices[2].stride;
        indices.pop_back();
    }
    layout.image = indices.size() == 2;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        layout.sides[3 - indices.size() + i] = indices[i].side;
        layout.strides[3 - indices.size() + i] = indices[i].stride;
    }
    return layout;
}

void readSamples(const char* bytes, const NpyHeader& header, const Layout& layout, std::size_t part,
                 Raster& raster) {
    const std::size_t size = bytesOf(header.type), channels = std::size_t(raster.channels);
    const bool rows = channels == 1 && layout.strides[2] == 1;
    float* out = raster.values.data();
    for (std::int64_t z = 0; z < layout.sides[0]; ++z)
        for (std::int64_t y = 0; y < layout.sides[1]; ++y) {
            const char* row = bytes + std::size_t(z * layout.strides[0] + y * layout.strides[1] +
                                                  std::int64_t(part) * layout.partStride) *
                                          size;
            for (std::int64_t x = 0; x < (rows ? 1 : layout.sides[2]); ++x)
                for (std::size_t c = 0; c < channels; ++c) {
                    const std::size_t count = rows ? std::size_t(layout.sides[2]) : 1;
                    toFloats(
                        row + std::size_t(x * layout.strides[2] + std::int64_t(c) * layout.partStride) * size,
                        count, header.type, header.swap, out);
                    out += count;
                }
        }
}

std::string shapeText(const NpyHeader& header) {
    std::string text;
    for (const std::int64_t side : header.shape) text += (text.empty() ? "" : " x ") + std::to_string(side);
    return text;
}

// The file holds as many numbers as its header claims.
void requireWhole(const std::string& path, const NpyHeader& header, std::size_t bytes) {
    constexpr std::size_t kMostDimensions = 64;  // NumPy's
    if (header.shape.size() > kMostDimensions)
        throw Error(ErrorCode::BadData, path + ": its header claims over 64 dimensions");
    std::uint64_t left = bytes / bytesOf(header.type);
    bool none = false;
    for (const std::int64_t side : header.shape) {
        none = none || side == 0;
        if (side > 0) left /= std::uint64_t(side);
    }
    if (left == 0 && !none)
        throw Error(ErrorCode::BadData,
                    path + ": truncated; its header claims " + shapeText(header) + " numbers");
    if (none)
        throw Error(ErrorCode::BadData, path + ": its shape is " + shapeText(header) + ", which is empty");
}

}  // namespace

NpyHeader readNpyHeader(const std::string& path, const std::string& content) {
    if (content.compare(0, 6, "\x93NUMPY") != 0 || content.size() < 12)
        throw Error(ErrorCode::BadData, path + ": not an npy file");
    const bool longHeader = content[6] > 1;
    std::uint32_t length = 0;
    std::memcpy(&length, content.data() + 8, longHeader ? 4 : 2);
    const std::size_t start = (longHeader ? 12 : 10) + std::size_t(length);
    if (start > content.size()) throw Error(ErrorCode::BadData, path + ": truncated in its header");
    NpyHeader header = parseHeader(path, content.substr(longHeader ? 12 : 10, length));
    header.bytes = start;
    return header;
}

Raster readNpy(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx) {
    const NpyHeader header = readNpyHeader(path, content);
    const std::size_t start = header.bytes;
    requireWhole(path, header, content.size() - start);
    const Layout layout = layoutOf(path, header, ctx);
    constexpr std::int64_t kMostParts = 100000;
    if (layout.parts > kMostParts)
        throw Error(ErrorCode::BadData, path + ": has over " + std::to_string(kMostParts) + " channels");
    std::vector<std::string> names;
    for (std::int64_t i = 1; layout.parts > 1 && i <= layout.parts; ++i)
        names.push_back("channel" + std::to_string(i));
    const std::size_t part = names.empty() ? 0 : chosenArray(path, names, 0, options, ctx);
    Raster raster =
        makeRaster(path, layout.sides[2], layout.sides[1], layout.sides[0], layout.colours ? 3 : 1, ctx);
    raster.rowsFromTop = layout.image;
    raster.stack = !layout.image;
    raster.arrays = names;
    if (layout.colours) raster.white = whiteOf(header.type);
    readSamples(content.data() + start, header, layout, part, raster);
    return raster;
}

}  // namespace vdbsynth
