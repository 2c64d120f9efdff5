#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

// Small files of images and volumes, byte by byte, for tests.
namespace vdbsynth::test {

template <typename T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
std::string raw(const std::vector<T>& values) {
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// A pgm of 8 or 16 bits.
inline std::string pgm(int width, int height, int white, const std::string& pixels) {
    return "P5\n# made by a test\n" + std::to_string(width) + " " + std::to_string(height) + "\n" +
           std::to_string(white) + "\n" + pixels;
}

/// An uncompressed TIFF of one strip a page. @param format  1 unsigned, 2 signed, 3 float
inline std::string tiff(int width, int height, int bits, int format, const std::vector<std::string>& pages,
                        const std::string& noData = "", const std::vector<double>& pixelScale = {}) {
    std::string bytes = "II*";
    bytes += '\0';
    append<std::uint32_t>(bytes, 0);
    std::size_t link = 4;
    for (const std::string& pixels : pages) {
        const std::uint32_t data = std::uint32_t(bytes.size());
        bytes += pixels;
        const std::uint32_t text = std::uint32_t(bytes.size());
        bytes += noData + std::string(8, '\0');
        const std::uint32_t scale = std::uint32_t(bytes.size());
        for (double value : pixelScale) append(bytes, value);
        struct Entry {
            std::uint16_t tag, type;
            std::uint32_t count, value;
        };
        std::vector<Entry> entries{{256, 4, 1, std::uint32_t(width)},
                                   {257, 4, 1, std::uint32_t(height)},
                                   {258, 3, 1, std::uint32_t(bits)},
                                   {259, 3, 1, 1},
                                   {262, 3, 1, 1},
                                   {273, 4, 1, data},
                                   {277, 3, 1, 1},
                                   {278, 4, 1, std::uint32_t(height)},
                                   {279, 4, 1, std::uint32_t(pixels.size())},
                                   {339, 3, 1, std::uint32_t(format)}};
        if (!pixelScale.empty()) entries.push_back({33550, 12, std::uint32_t(pixelScale.size()), scale});
        if (!noData.empty()) entries.push_back({42113, 2, std::uint32_t(noData.size() + 5), text});
        if (bytes.size() % 2) bytes += '\0';
        const std::uint32_t directory = std::uint32_t(bytes.size());
        std::memcpy(&bytes[link], &directory, 4);
        append(bytes, std::uint16_t(entries.size()));
        for (const Entry& e : entries) {
            append(bytes, e.tag);
            append(bytes, e.type);
            append(bytes, e.count);
            append(bytes, e.value);
        }
        link = bytes.size();
        append<std::uint32_t>(bytes, 0);
    }
    return bytes;
}

inline std::string npy(const std::string& type, const std::string& shape, const std::string& data,
                       bool fortran = false) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
                         ", 'shape': " + shape + ", }";
    header.resize(118, ' ');
    std::string bytes = "\x93NUMPY";
    bytes += '\1';
    bytes += '\0';
    append(bytes, std::uint16_t(header.size()));
    return bytes + header + data;
}

/// A NIfTI-1 volume of bytes with an sform.
inline std::string nifti(int x, int y, int z, const std::string& voxels, const std::vector<float>& srow) {
    std::string bytes(352, '\0');
    const auto put = [&](std::size_t at, auto value) { std::memcpy(&bytes[at], &value, sizeof value); };
    put(0, std::int32_t(348));
    const std::int16_t dims[4] = {3, std::int16_t(x), std::int16_t(y), std::int16_t(z)};
    for (std::size_t i = 0; i < 4; ++i) put(40 + 2 * i, dims[i]);
    put(70, std::int16_t(2));
    for (std::size_t i = 0; i < 4; ++i) put(76 + 4 * i, 1.f);
    put(108, 352.f);
    bytes[123] = 2;
    put(254, std::int16_t(1));
    for (std::size_t i = 0; i < 12; ++i) put(280 + 4 * i, srow[i]);
    bytes.replace(344, 3, "n+1");
    return bytes + voxels;
}

inline std::string vti(const std::string& extent, const std::string& attributes, const std::string& array,
                       const std::string& data) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
           "byte_order=\"LittleEndian\" " +
           attributes + ">\n<ImageData WholeExtent=\"" + extent +
           "\" Origin=\"1 2 3\" Spacing=\"0.5 0.5 2\"><Piece Extent=\"" + extent +
           "\"><PointData Scalars=\"v\"><DataArray Name=\"v\" " + array + ">" + data +
           "</DataArray></PointData></Piece></ImageData>\n</VTKFile>\n";
}

}  // namespace vdbsynth::test
