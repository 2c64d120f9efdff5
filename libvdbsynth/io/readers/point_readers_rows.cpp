// Rows of numbers: .xyz and .pwn.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/point_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

// The numbers of one line; commas and semicolons separate them too.
void readLine(TextScanner& scanner, std::vector<double>& numbers) {
    numbers.clear();
    scanner.atEnd();  // to the next non-empty line
    for (std::string_view word = scanner.wordOnLine(); !word.empty(); word = scanner.wordOnLine()) {
        double value = 0;
        if (!parseAnyReal(word, value))
            scanner.fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
        numbers.push_back(value);
    }
}

// A count, that many points, that many normals.
PointContent readCounted(TextScanner& scanner, const std::string& content, double claimed) {
    if (!(claimed >= 1) || claimed != std::floor(claimed) || claimed > double(content.size()) / 6 + 1)
        scanner.fail("claims more points than the file can hold, or none");
    PointContent cloud;
    const std::size_t count = std::size_t(claimed);
    const auto vector = [&scanner] {
        Vec3d v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = scanner.real();
        return v;
    };
    for (std::size_t i = 0; i < count; ++i) cloud.points.push_back(vector());
    for (std::size_t i = 0; i < count && !scanner.atEnd(); ++i)
        cloud.normals.push_back(cast<float>(vector()));
    return cloud;
}

}  // namespace

namespace {

// The meaning of three columns of all rows.
enum class Triple { Normals, Colours, Other };

Triple kindOf(const std::vector<double>& rows, std::size_t columns, std::size_t first) {
    bool unit = true, colour = true;
    for (std::size_t at = first; at + 2 < rows.size() && (unit || colour); at += columns) {
        const Vec3d v{rows[at], rows[at + 1], rows[at + 2]};
        unit = unit && std::abs(length(v) - 1) < 0.02;
        for (int axis = 0; axis < 3; ++axis) colour = colour && v[axis] >= 0 && v[axis] <= 255;
    }
    return unit ? Triple::Normals : colour ? Triple::Colours : Triple::Other;
}

}  // namespace

PointContent readRows(const std::string& path, const std::string& content, const RunContext&) {
    std::string text = content;
    for (char& c : text)
        if (c == ',' || c == ';') c = ' ';
    TextScanner scanner(path, text);
    std::vector<double> numbers, rows;
    std::size_t columns = 0;
    while (!scanner.atEnd()) {
        readLine(scanner, numbers);
        if (columns == 0) {
            if (numbers.size() == 1) return readCounted(scanner, text, numbers[0]);
            columns = numbers.size();
            if (columns < 3)
                scanner.fail("a point needs three coordinates, this row has " + std::to_string(columns));
        }
        if (numbers.size() != columns)
            scanner.fail("a row of " + std::to_string(numbers.size()) + " numbers where the first has " +
                         std::to_string(columns));
        rows.insert(rows.end(), numbers.begin(), numbers.end());
    }
    PointContent cloud;
    const std::size_t count = columns > 0 ? rows.size() / columns : 0;
    const auto vector = [&](std::size_t row, std::size_t first) {
        const double* at = &rows[row * columns + first];
        return Vec3d{at[0], at[1], at[2]};
    };
    for (std::size_t i = 0; i < count; ++i) cloud.points.push_back(vector(i, 0));
    for (std::size_t first = 3; first + 2 < columns && first <= 6; first += 3) {
        const Triple kind = kindOf(rows, columns, first);
        if (kind == Triple::Normals && cloud.normals.empty())
            for (std::size_t i = 0; i < count; ++i) cloud.normals.push_back(cast<float>(vector(i, first)));
        if (kind != Triple::Colours || !cloud.attributes.empty()) continue;
        std::vector<AttributeColumn> colour{{"red", 0, {}}, {"green", 0, {}}, {"blue", 0, {}}};
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c) colour[std::size_t(c)].values.push_back(float(vector(i, first)[c]));
        cloud.attributes = groupColumns(std::move(colour));
    }
    return cloud;
}

}  // namespace vdbsynth
