#include "libvdbsynth/geometry/attribute.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace vdbsynth {
namespace {

using Columns = std::vector<AttributeColumn>;

// Index of the column of that name, or the number of columns if there is none.
std::size_t indexOf(const Columns& columns, const std::string& name) {
    const auto at = std::find_if(columns.begin(), columns.end(),
                                 [&](const AttributeColumn& c) { return c.name == name; });
    return std::size_t(at - columns.begin());
}

// Moves the named columns into one attribute, if all exist.
bool take(Columns& columns, std::initializer_list<std::string> names, const std::string& as,
          Attributes& attributes, double& white) {
    std::vector<std::size_t> indices;
    for (const std::string& name : names) {
        indices.push_back(indexOf(columns, name));
        if (indices.back() == columns.size()) return false;
    }
    Attribute attribute{as, names.size(), {}};
    const std::size_t rows = columns[indices[0]].values.size();
    attribute.values.resize(rows * attribute.width);
    for (std::size_t c = 0; c < indices.size(); ++c)
        for (std::size_t row = 0; row < rows; ++row)
            attribute.values[row * attribute.width + c] = columns[indices[c]].values[row];
    white = columns[indices[0]].white;
    std::sort(indices.rbegin(), indices.rend());
    for (std::size_t index : indices) columns.erase(columns.begin() + std::ptrdiff_t(index));
    attributes.push_back(std::move(attribute));
    return true;
}

void takeColour(Columns& columns, std::initializer_list<std::string> names, const std::string& as,
                Attributes& attributes) {
    double white = 0;
    if (findAttribute(attributes, as) || !take(columns, names, as, attributes, white)) return;
    std::vector<float>& values = attributes.back().values;
    if (white == 0 && std::any_of(values.begin(), values.end(), [](float v) { return v > 1.001f; }))
        white = 255;
    if (white > 0)
        for (float& value : values) value = float(double(value) / white);
}

}  // namespace

const Attribute* findAttribute(const Attributes& attributes, const std::string& name) {
    for (const Attribute& attribute : attributes)
        if (attribute.name == name) return &attribute;
    return nullptr;
}

Attributes groupColumns(Columns columns) {
    for (AttributeColumn& column : columns)
        for (float& value : column.values)
            if (!std::isfinite(value)) value = 0;
    Attributes attributes;
    double ignored = 0;
    takeColour(columns, {"red", "green", "blue"}, "Cd", attributes);
    takeColour(columns, {"r", "g", "b"}, "Cd", attributes);
    takeColour(columns, {"Cd_x", "Cd_y", "Cd_z"}, "Cd", attributes);
    takeColour(columns, {"alpha"}, "Alpha", attributes);
    for (const auto& names : {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v")})
        if (!findAttribute(attributes, "uv"))
            take(columns, {names.first, names.second}, "uv", attributes, ignored);
    for (std::size_t i = 0; i < columns.size();) {
        const std::string name = columns[i].name;
        const std::string stem = name.size() > 2 && name.compare(name.size() - 2, 2, "_x") == 0
                                     ? name.substr(0, name.size() - 2)
                                     : "";
        if (!stem.empty() &&
            take(columns, {stem + "_x", stem + "_y", stem + "_z"}, stem, attributes, ignored))
            continue;
        ++i;
    }
    for (AttributeColumn& column : columns) attributes.push_back({column.name, 1, std::move(column.values)});
    return attributes;
}

Attributes selectRows(const Attributes& attributes, const std::vector<std::size_t>& kept) {
    Attributes selected;
    for (const Attribute& attribute : attributes) {
        selected.push_back({attribute.name, attribute.width, {}});
        std::vector<float>& values = selected.back().values;
        values.reserve(kept.size() * attribute.width);
        for (std::size_t row : kept)
            values.insert(values.end(), attribute.values.begin() + std::ptrdiff_t(row * attribute.width),
                          attribute.values.begin() + std::ptrdiff_t((row + 1) * attribute.width));
    }
    return selected;
}

}  // namespace vdbsynth
