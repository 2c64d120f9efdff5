// PCD 0.7, the point cloud library's format: a text header, then ascii, binary or LZF-compressed rows.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/point_readers.h"
#include "libvdbsynth/io/text_scanner.h"

#include <array>
#include <cstring>
#include <limits>
#include <vector>

namespace vdbsynth {
namespace {

struct Field {
    std::string name;
    std::int64_t size = 4, count = 1, offset = 0;
    char type = 'F';
};

struct Header {
    std::vector<Field> fields;
    std::int64_t points = -1, rowBytes = 0;
    std::string data;
    std::size_t bytes = 0;
};

void readFieldLine(TextScanner& scanner, const std::string& key, std::vector<Field>& fields) {
    std::size_t i = 0;
    for (std::string_view word = scanner.wordOnLine(); !word.empty(); word = scanner.wordOnLine(), ++i) {
        if (key == "FIELDS") {
            fields.emplace_back();
            fields.back().name = std::string(word);
            continue;
        }
        if (i >= fields.size()) scanner.fail(key + " names more fields than FIELDS");
        std::int64_t number = 0;
        if (key == "TYPE")
            fields[i].type = word[0];
        else if (!parseWhole(word, number) || number < 0 || number > 65536)
            scanner.fail(key + " is not a list of small whole numbers");
        else
            (key == "SIZE" ? fields[i].size : fields[i].count) = number;
    }
}

Header readHeader(const std::string& path, const std::string& content) {
    TextScanner scanner(path, content);
    Header header;
    std::int64_t width = -1, height = 1;
    while (!scanner.atEnd()) {
        const std::string key(scanner.wordOnLine());
        if (key == "FIELDS" || key == "SIZE" || key == "TYPE" || key == "COUNT")
            readFieldLine(scanner, key, header.fields);
        else if (key == "WIDTH")
            width = scanner.whole();
        else if (key == "HEIGHT")
            height = scanner.whole();
        else if (key == "POINTS")
            header.points = scanner.whole();
        else if (key == "DATA")
            header.data = std::string(scanner.wordOnLine());
        else if (key != "VERSION" && key != "VIEWPOINT")
            scanner.fail("\"" + key.substr(0, 40) + "\" is not a line of a PCD header");
        scanner.skipLine();
        if (key != "DATA") continue;
        header.bytes = scanner.position();
        if (header.points < 0 && width >= 0 && height >= 0 && height < (1 << 30) && width < (1 << 30))
            header.points = width * height;
        for (Field& field : header.fields) {
            if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8)
                scanner.fail("a field of " + std::to_string(field.size) + " bytes");
            field.offset = header.rowBytes;
            header.rowBytes += field.size * field.count;
        }
        if (header.points < 0 || header.rowBytes <= 0) scanner.fail("the header has no points or no fields");
        return header;
    }
    scanner.fail("the header has no DATA; the file is truncated");
}

double numberAt(const char* bytes, const Field& field) {
    const auto as = [bytes](auto value) {
        std::memcpy(&value, bytes, sizeof value);
        return double(value);
    };
    if (field.type == 'F') return field.size == 8 ? as(double()) : field.size == 4 ? as(float()) : 0;
    if (field.type == 'U')
        return field.size == 1   ? as(std::uint8_t())
               : field.size == 2 ? as(std::uint16_t())
               : field.size == 4 ? as(std::uint32_t())
                                 : as(std::uint64_t());
    return field.size == 1   ? as(std::int8_t())
           : field.size == 2 ? as(std::int16_t())
           : field.size == 4 ? as(std::int32_t())
                             : as(std::int64_t());
}

// LZF: a control byte under 32 is followed by that many and one literal bytes; else its upper three bits are
// the length and the rest, with the next byte, the distance of bytes to repeat.
std::string unpackLzf(const std::string& path, std::string_view packed, std::size_t size) {
    std::string out;
    out.reserve(size);
    std::size_t at = 0;
    const auto next = [&] {
        if (at >= packed.size()) throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
        return std::size_t(static_cast<unsigned char>(packed[at++]));
    };
    while (at < packed.size()) {
        const std::size_t control = next();
        if (control < 32) {
            const std::size_t count = control + 1;
            if (count > packed.size() - at)
                throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
            out.append(packed.substr(at, count));
            at += count;
        } else {
            std::size_t count = (control >> 5) + 2;
            if (count == 9) count += next();
            const std::size_t distance = ((control & 31) << 8) + next() + 1;
            if (distance > out.size())
                throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
            for (std::size_t i = 0; i < count; ++i) out += out[out.size() - distance];
        }
        if (out.size() > size) throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
    }
    if (out.size() != size) throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
    return out;
}

// Where the values of a field lie: rows one after another, or, compressed, one field after another.
struct Layout {
    std::string_view bytes;
    bool byField = false;
};

Layout binaryLayout(const std::string& path, const std::string& content, const Header& header,
                    std::string& unpacked) {
    const std::uint64_t size = std::uint64_t(header.points) * std::uint64_t(header.rowBytes);
    const std::string_view rest = std::string_view(content).substr(header.bytes);
    const auto truncated = [&](const char* what) {
        return Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(header.points) +
                                             " points, more than the file " + what);
    };
    if (header.data == "binary") {
        if (size > rest.size()) throw truncated("holds");
        return {rest, false};
    }
    std::uint32_t sizes[2];
    if (rest.size() < sizeof sizes) throw truncated("holds");
    std::memcpy(sizes, rest.data(), sizeof sizes);
    if (sizes[1] != size || sizes[0] > rest.size() - sizeof sizes || size / 300 > sizes[0])
        throw truncated("holds compressed");
    unpacked = unpackLzf(path, rest.substr(sizeof sizes, sizes[0]), std::size_t(size));
    return {unpacked, true};
}

void readAscii(const std::string& path, const std::string& content, const Header& header,
               const std::array<int, 6>& wanted, std::vector<std::array<float, 6>>& rows) {
    TextScanner scanner(path, content, '\0', header.bytes);
    if (std::uint64_t(header.points) > (content.size() - header.bytes) / 2 + 1)
        scanner.fail("the header claims more points than the file holds");
    for (std::int64_t p = 0; p < header.points; ++p) {
        std::array<float, 6> row{};
        for (std::size_t f = 0; f < header.fields.size(); ++f)
            for (std::int64_t c = 0; c < header.fields[f].count; ++c) {
                const std::string_view word = scanner.word();
                if (word.empty()) scanner.fail("the file is truncated");
                for (std::size_t k = 0; k < 6; ++k)
                    if (wanted[k] == int(f) && c == 0 && !parseReal(word, row[k]))
                        scanner.fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
            }
        rows.push_back(row);
    }
}

}  // namespace

PointCloud readPcd(const std::string& path, const std::string& content) {
    const Header header = readHeader(path, content);
    static const char* const names[6] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
    std::array<int, 6> wanted;
    wanted.fill(-1);
    for (std::size_t f = 0; f < header.fields.size(); ++f)
        for (std::size_t k = 0; k < 6; ++k)
            if (header.fields[f].name == names[k] && header.fields[f].count > 0) wanted[k] = int(f);
    if (wanted[0] < 0 || wanted[1] < 0 || wanted[2] < 0)
        throw Error(ErrorCode::BadData, path + ": its fields have no x, y and z");
    const bool normals = wanted[3] >= 0 && wanted[4] >= 0 && wanted[5] >= 0;
    std::vector<std::array<float, 6>> rows;
    if (header.data == "ascii") {
        readAscii(path, content, header, wanted, rows);
    } else if (header.data == "binary" || header.data == "binary_compressed") {
        std::string unpacked;
        const Layout layout = binaryLayout(path, content, header, unpacked);
        for (std::int64_t p = 0; p < header.points; ++p) {
            std::array<float, 6> row{};
            for (std::size_t k = 0; k < 6; ++k) {
                if (wanted[k] < 0) continue;
                const Field& field = header.fields[std::size_t(wanted[k])];
                const std::int64_t at = layout.byField
                                            ? field.offset * header.points + p * field.size * field.count
                                            : p * header.rowBytes + field.offset;
                row[k] = float(numberAt(layout.bytes.data() + at, field));
            }
            rows.push_back(row);
        }
    } else {
        throw Error(ErrorCode::BadData, path + ": DATA \"" + header.data.substr(0, 40) +
                                            "\" is unknown; ascii, binary and binary_compressed are read");
    }
    PointCloud cloud;
    for (const std::array<float, 6>& row : rows) {
        cloud.points.push_back({row[0], row[1], row[2]});
        if (normals) cloud.normals.push_back({row[3], row[4], row[5]});
    }
    return cloud;
}

}  // namespace vdbsynth
