#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace vdbsynth {

/// A named value at every vertex or point. Colours are "Cd" (red, green, blue, 0..1), their opacity is
/// "Alpha", texture coordinates are "uv"; all others keep the names they have in their file.
struct Attribute {
    std::string name;
    std::size_t width = 1;      ///< floats per vertex, 1 to 3
    std::vector<float> values;  ///< [vertices x width]
};
using Attributes = std::vector<Attribute>;

/// The attribute of that name, null if there is none.
const Attribute* findAttribute(const Attributes& attributes, const std::string& name);

/// One column of numbers as stored in a file.
struct AttributeColumn {
    std::string name;
    double white = 0;  ///< value of full colour in the column's type (255, 65535), 0 for real numbers
    std::vector<float> values;
};

/// Columns, all of one length, as attributes: red green blue (or r g b) are Cd, alpha is Alpha, s t (or u v,
/// texture_u texture_v) are uv, NAME_x NAME_y NAME_z one vector. Real-valued colours over 1 are assumed to
/// range to 255. Non-finite values become 0.
Attributes groupColumns(std::vector<AttributeColumn> columns);

/// Keeps the rows (vertices) that `kept` lists, in its order.
Attributes selectRows(const Attributes& attributes, const std::vector<std::size_t>& kept);

}  // namespace vdbsynth
