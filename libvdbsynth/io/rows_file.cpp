// Rows of numbers: .xyz and .pwn.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/point_readers.h"
#include "libvdbsynth/io/text_scanner.h"

#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

// The numbers of one line; commas and semicolons part them too.
void readLine(TextScanner& scanner, std::vector<float>& numbers) {
    numbers.clear();
    scanner.atEnd();  // to the next line that has something
    for (std::string_view word = scanner.wordOnLine(); !word.empty(); word = scanner.wordOnLine()) {
        float value = 0;
        if (!parseReal(word, value))
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

PointCloud readRows(const std::string& path, const std::string& content) {
    std::string text = content;
    for (char& c : text)
        if (c == ',' || c == ';') c = ' ';
    TextScanner scanner(path, text);
    PointCloud cloud;
    std::vector<float> numbers;
    std::size_t columns = 0;
    bool normals = true;
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
        cloud.points.push_back({numbers[0], numbers[1], numbers[2]});
        if (columns < 6 || !normals) continue;
        const Vec3f normal{numbers[3], numbers[4], numbers[5]};
        normals = std::abs(length(normal) - 1) < 0.02f;
        cloud.normals.push_back(normal);
    }
    if (!normals) cloud.normals.clear();
    return cloud;
}

}  // namespace vdbsynth
