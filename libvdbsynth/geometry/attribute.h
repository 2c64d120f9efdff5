#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace vdbsynth {

/// A named value at every vertex or point. Colours are "Cd" (red, green, blue, 0..1), their opacity is
/// "Alpha", texture coordinates are "uv"; all else keeps the name it has in its file.
struct Attribute {
    std::string name;
    std::size_t width = 1;      ///< floats a vertex, 1 to 3
    std::vector<float> values;  ///< [vertices x width]
};
using Attributes = std::vector<Attribute>;

/// The attribute of that name, null if there is none.
const Attribute* findAttribute(const Attributes& attributes, const std::string& name);

/// One column of numbers as a file has it.
struct AttributeColumn {
    std::string name;
    double white = 0;  ///< what full colour is in the column's type (255, 65535), 0 for real numbers
    std::vector<float> values;
};

/// Columns, all of one length, as attributes: red green blue (or r g b) are Cd, alpha is Alpha, s t (or u v,
/// texture_u texture_v) are uv, NAME_x NAME_y NAME_z one vector. Colours in real numbers over 1 are taken to
/// run to 255. What is not finite becomes 0.
Attributes groupColumns(std::vector<AttributeColumn> columns);

/// Keeps the rows (vertices) that `kept` lists, in its order.
Attributes selectRows(const Attributes& attributes, const std::vector<std::size_t>& kept);

}  // namespace vdbsynth
