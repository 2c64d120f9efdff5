// Rows of numbers: .xyz and .pwn.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/point_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

// The numbers of one line; commas and semicolons separate them too.
void readLine(TextScanner& scanner, std::vector<float>& numbers) {
    numbers.clear();
    scanner.atEnd();  // to the next non-empty line
    for (std::string_view word = scanner.wordOnLine(); !word.empty(); word = scanner.wordOnLine()) {
        float value = 0;
        if (!parseAnyReal(word, value))
            scanner.fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
        numbers.push_back(value);
    }
}

// A count, that many points, that many normals.
PointCloud readCounted(TextScanner& scanner, const std::string& content, float claimed) {
    if (!(claimed >= 1) || claimed != std::floor(claimed) || double(claimed) > double(content.size()) / 6 + 1)
        scanner.fail("claims more points than the file can hold, or none");
    PointCloud cloud;
    const std::size_t count = std::size_t(claimed);
    for (std::vector<Vec3f>* list : {&cloud.points, &cloud.normals})
        for (std::size_t i = 0; i < count && !(list == &cloud.normals && scanner.atEnd()); ++i) {
            Vec3f v;
            for (int axis = 0; axis < 3; ++axis) v[axis] = scanner.real();
            list->push_back(v);
        }
    return cloud;
}

}  // namespace

namespace {

// The meaning of three columns of all rows.
enum class Triple { Normals, Colours, Other };

Triple kindOf(const std::vector<float>& rows, std::size_t columns, std::size_t first) {
    bool unit = true, colour = true;
    for (std::size_t at = first; at + 2 < rows.size() && (unit || colour); at += columns) {
        const Vec3f v{rows[at], rows[at + 1], rows[at + 2]};
        unit = unit && std::abs(length(v) - 1) < 0.02f;
        for (int axis = 0; axis < 3; ++axis) colour = colour && v[axis] >= 0 && v[axis] <= 255;
    }
    return unit ? Triple::Normals : colour ? Triple::Colours : Triple::Other;
}

}  // namespace

PointCloud readRows(const std::string& path, const std::string& content) {
    std::string text = content;
    for (char& c : text)
        if (c == ',' || c == ';') c = ' ';
    TextScanner scanner(path, text);
    std::vector<float> numbers, rows;
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
    PointCloud cloud;
    const std::size_t count = columns > 0 ? rows.size() / columns : 0;
    const auto vector = [&](std::size_t row, std::size_t first) {
        const float* at = &rows[row * columns + first];
        return Vec3f{at[0], at[1], at[2]};
    };
    for (std::size_t i = 0; i < count; ++i) cloud.points.push_back(vector(i, 0));
    for (std::size_t first = 3; first + 2 < columns && first <= 6; first += 3) {
        const Triple kind = kindOf(rows, columns, first);
        if (kind == Triple::Normals && cloud.normals.empty())
            for (std::size_t i = 0; i < count; ++i) cloud.normals.push_back(vector(i, first));
        if (kind != Triple::Colours || !cloud.attributes.empty()) continue;
        std::vector<AttributeColumn> colour{{"red", 0, {}}, {"green", 0, {}}, {"blue", 0, {}}};
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c) colour[std::size_t(c)].values.push_back(vector(i, first)[c]);
        cloud.attributes = groupColumns(std::move(colour));
    }
    return cloud;
}

}  // namespace vdbsynth
