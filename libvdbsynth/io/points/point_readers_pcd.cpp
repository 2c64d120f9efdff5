// PCD, the point cloud library's format: a text header, then ascii, binary or LZF-compressed rows.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/points/point_readers.h"
#include "libvdbsynth/io/points/point_readers_steps.h"
#include "libvdbsynth/io/points/row_text.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <vector>

namespace vdbsynth {
namespace {

double numberAt(const char* bytes, const PcdField& field) {
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

// Location of a field's values: row by row or, compressed, field by field.
struct Layout {
    std::string_view bytes;
    bool byField = false;
};

Layout binaryLayout(const std::string& path, const std::string& content, const PcdHeader& header,
                    std::string& unpacked, const RunContext& ctx) {
    const std::optional<std::int64_t> size = checkedProduct({header.points, header.rowBytes});
    const std::string_view rest = std::string_view(content).substr(header.bytes);
    const auto truncated = [&](const char* what) {
        return Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(header.points) +
                                             " points of " + std::to_string(header.rowBytes) +
                                             " bytes, more than the file " + what + "; it has " +
                                             std::to_string(rest.size()) + " bytes behind its header");
    };
    if (!size) throw truncated("can hold");
    if (header.data == "binary") {
        if (std::uint64_t(*size) > rest.size()) throw truncated("holds");
        if (rest.size() - std::uint64_t(*size) >= std::uint64_t(header.rowBytes))
            message(ctx, MessageLevel::Warning,
                    path + ": " + countText(rest.size() - std::uint64_t(*size), "byte") + " behind its " +
                        countText(std::size_t(header.points), "point") + " left out");
        return {rest, false};
    }
    std::uint32_t sizes[2];
    if (rest.size() < sizeof sizes) throw truncated("holds");
    std::memcpy(sizes, rest.data(), sizeof sizes);
    if (sizes[1] != *size)
        throw Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(*size) +
                                            " bytes of points, its compressed data " +
                                            std::to_string(sizes[1]) + "; one of them is more than it holds");
    if (sizes[0] > rest.size() - sizeof sizes || *size / 300 > sizes[0]) throw truncated("holds compressed");
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

// The field of one of these names, as written or in another case; the number of fields if there is none.
std::size_t findField(const PcdHeader& header, std::initializer_list<const char*> names) {
    for (const char* name : names)
        for (std::size_t f = 0; f < header.fields.size(); ++f)
            if (header.fields[f].name == name && header.fields[f].count > 0) return f;
    return header.fields.size();
}

// Adds three fields to the row, if all are there.
bool takeThree(const PcdHeader& header, Row& row,
               std::initializer_list<std::initializer_list<const char*>> names) {
    std::vector<std::size_t> found;
    for (const auto& spellings : names) {
        found.push_back(findField(header, spellings));
        if (found.back() == header.fields.size()) return false;
    }
    row.fields.insert(row.fields.end(), found.begin(), found.end());
    return true;
}

// The value of full colour in a field's type.
double whiteOf(const PcdField& field) {
    return field.type != 'U' ? 0 : field.size == 1 ? 255 : field.size == 2 ? 65535 : 0;
}

Row rowOf(const std::string& path, const PcdHeader& header, const RunContext& ctx) {
    Row row;
    if (!takeThree(header, row, {{"x", "X"}, {"y", "Y"}, {"z", "Z"}}))
        throw Error(ErrorCode::BadData, path + ": its fields have no x, y and z");
    row.normals = takeThree(header, row,
                            {{"normal_x", "nx", "normalx", "normal_X", "NX"},
                             {"normal_y", "ny", "normaly", "normal_Y", "NY"},
                             {"normal_z", "nz", "normalz", "normal_Z", "NZ"}});
    std::size_t left = 0;
    for (std::size_t f = 0; f < header.fields.size(); ++f) {
        const PcdField& field = header.fields[f];
        if (std::find(row.fields.begin(), row.fields.end(), f) != row.fields.end()) continue;
        if (field.name == "_" || field.name.empty() || field.count == 0) continue;
        const bool packed = (field.name == "rgb" || field.name == "rgba") && field.size == 4;
        if (field.count != 1 || (packed && row.colour > 0)) {
            ++left;
            continue;
        }
        if (packed) {
            row.colour = row.fields.size();
            for (const char* name : {"red", "green", "blue"}) row.columns.push_back({name, 255, {}});
        } else {
            row.columns.push_back({field.name, whiteOf(field), {}});
        }
        row.fields.push_back(f);
    }
    if (left > 0)
        message(ctx, MessageLevel::Note,
                path + ": " + std::to_string(left) +
                    " fields of several values a point, or a second colour, left out");
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

// A number as text. Packed colours are whole numbers, or floats of the same bits.
double asciiNumber(const RowText& text, std::string_view word, const PcdField& field, bool colour) {
    double value = 0;
    std::int64_t whole = 0;
    const bool digits = word.find_first_not_of("0123456789") == std::string_view::npos;
    if ((field.type != 'F' || (colour && digits)) && parseWhole(word, whole)) return double(whole);
    if (!parseLenient(word, false, value)) text.fail(shownWord(word) + " is not a number");
    return colour ? bitsOf(float(value)) : value;
}

void readAscii(const std::string& path, const std::string& content, const PcdHeader& header, Row& row,
               PointContent& cloud, const RunContext& ctx) {
    RowText text(path, content, header.bytes);
    if (std::uint64_t(header.points) > (content.size() - header.bytes) / 2 + 1)
        throw Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(header.points) +
                                            " points, more than the file holds");
    std::vector<std::size_t> wordOf;  // of a row, for each slot
    std::size_t words = 0;
    for (const std::size_t field : row.fields) {
        wordOf.push_back(0);
        for (std::size_t f = 0; f < field; ++f) wordOf.back() += std::size_t(header.fields[f].count);
    }
    for (const PcdField& field : header.fields) words += std::size_t(field.count);
    std::vector<double> numbers(row.fields.size());
    std::vector<std::string_view> line;
    std::int64_t points = 0, more = 0, longRows = 0;
    while (text.next()) {
        if (points == header.points && ++more) continue;
        line.clear();
        text.words(line);
        if (line.size() < words)
            text.fail("a row of " + std::to_string(line.size()) + " numbers for " + std::to_string(words) +
                      (text.isCutOff() ? " fields; the file is truncated" : " fields"));
        longRows += line.size() > words;
        for (std::size_t slot = 0; slot < numbers.size(); ++slot)
            numbers[slot] = asciiNumber(text, line[wordOf[slot]], header.fields[row.fields[slot]],
                                        row.colour > 0 && slot == row.colour);
        appendPoint(row, numbers, cloud);
        ++points;
    }
    if (points < header.points)
        throw Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(header.points) +
                                            " points, more than the file holds: " + std::to_string(points) +
                                            "; the file is truncated");
    if (more > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + countText(std::size_t(more), "row") + " behind its " +
                    countText(std::size_t(points), "point") + " left out");
    if (longRows > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + std::to_string(longRows) +
                    " rows have more numbers than fields; those are "
                    "left out");
}

void readBinary(const PcdHeader& header, const Layout& layout, Row& row, PointContent& cloud) {
    std::vector<double> numbers(row.fields.size());
    for (std::int64_t p = 0; p < header.points; ++p) {
        for (std::size_t slot = 0; slot < row.fields.size(); ++slot) {
            const PcdField& field = header.fields[row.fields[slot]];
            const std::int64_t at = layout.byField
                                        ? field.offset * header.points + p * field.size * field.count
                                        : p * header.rowBytes + field.offset;
            PcdField plain = field;
            // A float that encodes a colour must stay bits: as a number it may be a signalling NaN.
            if (row.colour > 0 && slot == row.colour) plain.type = 'U';
            numbers[slot] = numberAt(layout.bytes.data() + at, plain);
        }
        appendPoint(row, numbers, cloud);
    }
}

}  // namespace

PointContent readPcd(const std::string& path, const std::string& content, const RunContext& ctx) {
    const PcdHeader header = readPcdHeader(path, content, ctx);
    Row row = rowOf(path, header, ctx);
    PointContent cloud;
    if (header.data == "ascii") {
        readAscii(path, content, header, row, cloud, ctx);
    } else if (header.data == "binary" || header.data == "binary_compressed") {
        std::string unpacked;
        readBinary(header, binaryLayout(path, content, header, unpacked, ctx), row, cloud);
    } else {
        throw Error(ErrorCode::BadData, path + ": DATA " + shownWord(header.data) +
                                            " is unknown; ascii, binary and binary_compressed are read");
    }
    cloud.attributes = groupColumns(std::move(row.columns));
    return cloud;
}

}  // namespace vdbsynth
