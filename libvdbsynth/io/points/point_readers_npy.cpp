// Points as a NumPy array of rows or columns of coordinates.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/points/point_columns.h"
#include "libvdbsynth/io/readers/raster_readers.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Fewer points a number of each are taken for a small picture.
constexpr std::int64_t kLeastRatio = 10;
constexpr std::int64_t kMostColumns = 9;

bool isReal(SampleType type) {
    return type == SampleType::F16 || type == SampleType::F32 || type == SampleType::F64;
}

template <typename T>
void widen(const char* bytes, bool swap, std::vector<double>& values) {
    for (double& value : values) {
        char raw[sizeof(T)];
        std::memcpy(raw, bytes, sizeof(T));
        if (swap) std::reverse(raw, raw + sizeof(T));
        T number;
        std::memcpy(&number, raw, sizeof(T));
        value = double(number);
        bytes += sizeof(T);
    }
}

// Types that floats cannot hold are widened one by one.
std::vector<double> numbersOf(const char* bytes, std::size_t count, const NpyHeader& header) {
    std::vector<double> values(count);
    switch (header.type) {
        case SampleType::F64:
            widen<double>(bytes, header.swap, values);
            return values;
        case SampleType::I64:
            widen<std::int64_t>(bytes, header.swap, values);
            return values;
        case SampleType::U64:
            widen<std::uint64_t>(bytes, header.swap, values);
            return values;
        case SampleType::I32:
            widen<std::int32_t>(bytes, header.swap, values);
            return values;
        case SampleType::U32:
            widen<std::uint32_t>(bytes, header.swap, values);
            return values;
        default:
            break;
    }
    std::vector<float> floats(count);
    toFloats(bytes, count, header.type, header.swap, floats.data());
    std::copy(floats.begin(), floats.end(), values.begin());
    return values;
}

}  // namespace

bool npyHoldsPoints(const std::string& path, const std::string& content) {
    const NpyHeader header = readNpyHeader(path, content);
    if (header.shape.size() != 2) return false;
    const auto [columns, rows] = std::minmax(header.shape[0], header.shape[1]);
    if (columns < 3 || columns > kMostColumns || rows < kLeastRatio * columns) return false;
    return isReal(header.type) || (columns == 3 && bytesOf(header.type) > 1);
}

PointContent readNpyPoints(const std::string& path, const std::string& content, const RunContext& ctx) {
    if (!npyHoldsPoints(path, content))
        throw Error(ErrorCode::BadData, path + ": is no array of N x 3 coordinates");
    const NpyHeader header = readNpyHeader(path, content);
    const std::int64_t first = header.shape[0], second = header.shape[1];
    const std::size_t held = content.size() - header.bytes;
    if (!productFits({first, second, std::int64_t(bytesOf(header.type))}, held))
        throw Error(ErrorCode::BadData, path + ": truncated; its header claims " + std::to_string(first) +
                                            " x " + std::to_string(second) + " numbers of " +
                                            std::to_string(bytesOf(header.type)) + " bytes, " +
                                            std::to_string(held) + " bytes are there");
    requireMemory(ctx, double(first) * double(second) * sizeof(double) * 2, path, "split it first");
    const std::size_t rows = std::size_t(std::max(first, second)),
                      columns = std::size_t(std::min(first, second));
    std::vector<double> numbers = numbersOf(content.data() + header.bytes, rows * columns, header);
    PointTable table;
    table.columns = columns;
    // A row's numbers are together unless exactly one of both turns them: the shape or the order in memory.
    if ((first < second) == header.columnsFirst) {
        table.values = std::move(numbers);
    } else {
        table.values.resize(numbers.size());
        for (std::size_t row = 0; row < rows; ++row)
            for (std::size_t column = 0; column < columns; ++column)
                table.values[row * columns + column] = numbers[column * rows + row];
    }
    message(ctx, MessageLevel::Note,
            path + ": its " + std::to_string(first) + " x " + std::to_string(second) + " numbers read as " +
                std::to_string(rows) + " points, not as an image of " + std::to_string(columns) +
                " pixels' width");
    return contentOf(path, table, ctx);
}

}  // namespace vdbsynth
