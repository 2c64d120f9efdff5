// Accessors of glTF: numbers of any type in buffers, with every place checked before it is read.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace vdbsynth {
namespace {

// glTF's types of numbers; the last but one and the last are of extensions.
enum class Component : std::uint64_t {
    Byte = 5120,
    UnsignedByte = 5121,
    Short = 5122,
    UnsignedShort = 5123,
    Int = 5124,
    UnsignedInt = 5125,
    Float = 5126,
    Double = 5130
};

std::size_t sizeOf(Component type) {
    switch (type) {
        case Component::Byte:
        case Component::UnsignedByte:
            return 1;
        case Component::Short:
        case Component::UnsignedShort:
            return 2;
        case Component::Int:
        case Component::UnsignedInt:
        case Component::Float:
            return 4;
        case Component::Double:
            return 8;
    }
    return 0;
}

template <typename T>
double asNumber(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return double(value);
}

double numberAt(const char* bytes, Component type) {
    switch (type) {
        case Component::Byte:
            return asNumber<std::int8_t>(bytes);
        case Component::UnsignedByte:
            return asNumber<std::uint8_t>(bytes);
        case Component::Short:
            return asNumber<std::int16_t>(bytes);
        case Component::UnsignedShort:
            return asNumber<std::uint16_t>(bytes);
        case Component::Int:
            return asNumber<std::int32_t>(bytes);
        case Component::UnsignedInt:
            return asNumber<std::uint32_t>(bytes);
        case Component::Float:
            return asNumber<float>(bytes);
        case Component::Double:
            return asNumber<double>(bytes);
    }
    return 0;
}

// Divisor of normalised integers, 0 for real numbers.
double whiteOf(Component type) {
    switch (type) {
        case Component::Byte:
            return std::numeric_limits<std::int8_t>::max();
        case Component::UnsignedByte:
            return std::numeric_limits<std::uint8_t>::max();
        case Component::Short:
            return std::numeric_limits<std::int16_t>::max();
        case Component::UnsignedShort:
            return std::numeric_limits<std::uint16_t>::max();
        case Component::Int:
            return std::numeric_limits<std::int32_t>::max();
        case Component::UnsignedInt:
            return std::numeric_limits<std::uint32_t>::max();
        default:
            return 0;
    }
}

Component componentOf(const GltfFile& file, const GltfJson& object) {
    const Component type = Component(file.whole(object, "componentType"));
    if (sizeOf(type) == 0) file.refuse("an accessor's component type is not one of glTF's");
    return type;
}

std::size_t widthOf(const GltfFile& file, const GltfJson& accessor) {
    static const std::map<std::string, std::size_t> widths{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const GltfJson* type = gltfMember(accessor, "type");
    const auto found = type && type->is_string() ? widths.find(type->get<std::string>()) : widths.end();
    if (found == widths.end())
        file.refuse("an accessor's type is not a scalar, a vector or a matrix of 4 x 4");
    return found->second;
}

// The bytes of a buffer view, as many as there are; compressed data has no bytes but those of a fallback.
std::string_view viewBytes(const GltfFile& file, const GltfJson& view) {
    const std::string compression = gltfCompression(view);
    std::string_view bytes;
    try {
        bytes = file.buffer(file.index(view, "buffer"));
    } catch (const Error&) {
        if (compression.empty()) throw;
        refuseGltfCompression(file, compression);
    }
    const std::uint64_t offset = file.whole(view, "byteOffset"), length = file.whole(view, "byteLength");
    if (!compression.empty() && (offset > bytes.size() || length > bytes.size() - offset))
        refuseGltfCompression(file, compression);
    return offset < bytes.size() ? bytes.substr(offset, length) : std::string_view();
}

// `count` elements of a view, each `width` numbers.
std::vector<double> readView(const GltfFile& file, const GltfJson& object, Component type,
                             std::uint64_t count, std::size_t width) {
    const GltfJson& view = file.item("bufferViews", file.index(object, "bufferView"), "a buffer view");
    const std::string_view bytes = viewBytes(file, view);
    const std::uint64_t offset = file.whole(object, "byteOffset"), number = sizeOf(type),
                        element = number * width, given = file.whole(view, "byteStride"),
                        stride = given > 0 ? given : element;
    const bool inside = count == 0 || (offset <= bytes.size() && element <= bytes.size() - offset &&
                                       count - 1 <= (bytes.size() - offset - element) / stride);
    if (!inside) file.refuse("an accessor reaches beyond its buffer; the file is truncated");
    // A stride below the element's size would make many numbers of few bytes.
    if (count > bytes.size())
        file.refuse("an accessor has more elements than its buffers bytes; the file is truncated");
    std::vector<double> numbers;
    numbers.reserve(std::size_t(count) * width);
    for (std::uint64_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < width; ++c)
            numbers.push_back(numberAt(bytes.data() + offset + i * stride + c * number, type));
    return numbers;
}

// Places and new values of a sparse accessor.
struct Replaced {
    std::vector<double> rows, numbers;
};

Replaced readSparse(const GltfFile& file, const GltfJson& sparse, Component type, std::size_t width) {
    const GltfJson *rows = gltfMember(sparse, "indices"), *numbers = gltfMember(sparse, "values");
    if (!rows || !numbers) file.refuse("a sparse accessor has no indices or no values");
    const std::uint64_t count = file.whole(sparse, "count");
    return {readView(file, *rows, componentOf(file, *rows), count, 1),
            readView(file, *numbers, type, count, width)};
}

void replace(const GltfFile& file, const Replaced& replaced, GltfValues& values) {
    for (std::size_t i = 0; i < replaced.rows.size(); ++i) {
        if (!(replaced.rows[i] >= 0) || replaced.rows[i] >= double(values.count))
            file.refuse("a sparse accessor replaces an element that does not exist");
        std::copy_n(replaced.numbers.begin() + std::ptrdiff_t(i * values.width), values.width,
                    values.numbers.begin() + std::ptrdiff_t(std::size_t(replaced.rows[i]) * values.width));
    }
}

}  // namespace

GltfValues gltfValues(const GltfFile& file, std::int64_t index) {
    const GltfJson& accessor = file.item("accessors", index, "an accessor");
    const Component type = componentOf(file, accessor);
    GltfValues values;
    values.width = widthOf(file, accessor);
    const std::uint64_t count = file.whole(accessor, "count");
    Replaced replaced;
    const GltfJson* sparse = gltfMember(accessor, "sparse");
    if (sparse) replaced = readSparse(file, *sparse, type, values.width);
    if (file.index(accessor, "bufferView") >= 0) {
        values.numbers = readView(file, accessor, type, count, values.width);
    } else {
        if (count > file.bytes())
            file.refuse("an accessor has more elements than its buffers bytes; the file is truncated");
        values.numbers.assign(std::size_t(count) * values.width, 0.0);
    }
    values.count = std::size_t(count);
    replace(file, replaced, values);
    const GltfJson* normalized = gltfMember(accessor, "normalized");
    const double white = normalized && *normalized == true ? whiteOf(type) : 0;
    if (white > 0)
        for (double& number : values.numbers) number = std::max(-1.0, number / white);
    return values;
}

}  // namespace vdbsynth
