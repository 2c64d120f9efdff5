// PCD 0.7, the point cloud library's format: a text header, then ascii, binary or LZF-compressed rows.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/point_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

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

// Location of a field's values: row by row or, compressed, field by field.
struct Layout {
    std::string_view bytes;
    bool byField = false;
};

Layout binaryLayout(const std::string& path, const std::string& content, const Header& header,
                    std::string& unpacked) {
    const std::optional<std::int64_t> size = checkedProduct({header.points, header.rowBytes});
    const std::string_view rest = std::string_view(content).substr(header.bytes);
    const auto truncated = [&](const char* what) {
        return Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(header.points) +
                                             " points, more than the file " + what);
    };
    if (!size) throw truncated("can hold");
    if (header.data == "binary") {
        if (std::uint64_t(*size) > rest.size()) throw truncated("holds");
        return {rest, false};
    }
    std::uint32_t sizes[2];
    if (rest.size() < sizeof sizes) throw truncated("holds");
    std::memcpy(sizes, rest.data(), sizeof sizes);
    if (sizes[1] != *size || sizes[0] > rest.size() - sizeof sizes || *size / 300 > sizes[0])
        throw truncated("holds compressed");
    unpacked = unpackLzf(path, rest.substr(sizeof sizes, sizes[0]), std::size_t(*size));
    return {unpacked, true};
}

// The requested numbers of a row, in the order x y z, normal, then one column for each other field of one
// value; a packed colour has three columns.
struct Row {
    std::vector<std::size_t> fields;  // the field of each slot
    std::vector<AttributeColumn> columns;
    std::size_t colour = 0;  // slot of the packed colour, 0 if there is none
    bool normals = false;
};

Row rowOf(const std::string& path, const Header& header) {
    static const char* const names[6] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
    Row row;
    std::vector<char> taken(header.fields.size(), 0);
    const auto find = [&](const char* name) {
        for (std::size_t f = 0; f < header.fields.size(); ++f)
            if (!taken[f] && header.fields[f].name == name && header.fields[f].count > 0) return f;
        return header.fields.size();
    };
    for (std::size_t k = 0; k < 6; ++k) {
        const std::size_t f = find(names[k]);
        if (f == header.fields.size() && k < 3)
            throw Error(ErrorCode::BadData, path + ": its fields have no x, y and z");
        if (f == header.fields.size()) break;
        taken[f] = 1;
        row.fields.push_back(f);
    }
    row.normals = row.fields.size() == 6;
    row.fields.resize(row.normals ? 6 : 3);
    for (std::size_t f = 0; f < header.fields.size(); ++f) {
        const Field& field = header.fields[f];
        if (taken[f] || field.count != 1 || field.name == "_" || field.name.empty()) continue;
        const bool packed = (field.name == "rgb" || field.name == "rgba") && field.size == 4;
        if (packed && row.colour > 0) continue;
        if (packed) {
            row.colour = row.fields.size();
            for (const char* name : {"red", "green", "blue"}) row.columns.push_back({name, 255, {}});
        } else {
            row.columns.push_back({field.name, 0, {}});
        }
        row.fields.push_back(f);
    }
    return row;
}

// A colour in the bits of a number, 0x00RRGGBB.
void appendColour(double value, AttributeColumn* columns) {
    const bool fits = value >= -2147483648.0 && value < 4294967296.0;
    const std::uint32_t bits = fits ? std::uint32_t(std::int64_t(value)) : 0;
    for (int c = 0; c < 3; ++c) columns[c].values.push_back(float(bits >> (16 - 8 * c) & 255));
}

// The bits of a number written as text, for colours stored as floats.
double bitsOf(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, 4);
    return double(bits);
}

// Reads the numbers of one point.
void appendPoint(Row& row, const std::vector<double>& numbers, PointContent& cloud) {
    const auto vector = [&](std::size_t at) { return Vec3d{numbers[at], numbers[at + 1], numbers[at + 2]}; };
    cloud.points.push_back(vector(0));
    if (row.normals) cloud.normals.push_back(cast<float>(vector(3)));
    std::size_t column = 0;
    for (std::size_t slot = row.normals ? 6 : 3; slot < row.fields.size(); ++slot) {
        if (slot == row.colour) {
            appendColour(numbers[slot], &row.columns[column]);
            column += 3;
        } else {
            row.columns[column++].values.push_back(float(numbers[slot]));
        }
    }
}

void readAscii(const std::string& path, const std::string& content, const Header& header, Row& row,
               PointContent& cloud) {
    TextScanner scanner(path, content, '\0', header.bytes);
    if (std::uint64_t(header.points) > (content.size() - header.bytes) / 2 + 1)
        scanner.fail("the header claims more points than the file holds");
    std::vector<int> slotOf(header.fields.size(), -1);
    for (std::size_t slot = 0; slot < row.fields.size(); ++slot) slotOf[row.fields[slot]] = int(slot);
    std::vector<double> numbers(row.fields.size());
    for (std::int64_t p = 0; p < header.points; ++p) {
        for (std::size_t f = 0; f < header.fields.size(); ++f)
            for (std::int64_t c = 0; c < header.fields[f].count; ++c) {
                const std::string_view word = scanner.word();
                if (word.empty()) scanner.fail("the file is truncated");
                if (slotOf[f] < 0 || c > 0) continue;
                double value = 0;
                std::int64_t whole = 0;
                const bool isWhole = header.fields[f].type != 'F' && parseWhole(word, whole);
                if (!isWhole && !parseAnyReal(word, value))
                    scanner.fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
                const bool colour = row.colour > 0 && std::size_t(slotOf[f]) == row.colour;
                numbers[std::size_t(slotOf[f])] = isWhole  ? double(whole)
                                                  : colour ? bitsOf(float(value))
                                                           : value;
            }
        appendPoint(row, numbers, cloud);
    }
}

void readBinary(const Header& header, const Layout& layout, Row& row, PointContent& cloud) {
    std::vector<double> numbers(row.fields.size());
    for (std::int64_t p = 0; p < header.points; ++p) {
        for (std::size_t slot = 0; slot < row.fields.size(); ++slot) {
            const Field& field = header.fields[row.fields[slot]];
            const std::int64_t at = layout.byField
                                        ? field.offset * header.points + p * field.size * field.count
                                        : p * header.rowBytes + field.offset;
            Field plain = field;
            // A float that encodes a colour must stay bits: as a number it may be a signalling NaN.
            if (row.colour > 0 && slot == row.colour) plain.type = 'U';
            numbers[slot] = numberAt(layout.bytes.data() + at, plain);
        }
        appendPoint(row, numbers, cloud);
    }
}

}  // namespace

PointContent readPcd(const std::string& path, const std::string& content, const RunContext&) {
    const Header header = readHeader(path, content);
    Row row = rowOf(path, header);
    PointContent cloud;
    if (header.data == "ascii") {
        readAscii(path, content, header, row, cloud);
    } else if (header.data == "binary" || header.data == "binary_compressed") {
        std::string unpacked;
        readBinary(header, binaryLayout(path, content, header, unpacked), row, cloud);
    } else {
        throw Error(ErrorCode::BadData, path + ": DATA \"" + header.data.substr(0, 40) +
                                            "\" is unknown; ascii, binary and binary_compressed are read");
    }
    cloud.attributes = groupColumns(std::move(row.columns));
    return cloud;
}

}  // namespace vdbsynth
