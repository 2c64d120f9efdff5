#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/points/point_readers.h"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth {

/// Points as rows of numbers, as text files and NumPy arrays hold them.
struct PointTable {
    std::size_t columns = 0;
    std::vector<double> values;      ///< [rows x columns]
    std::vector<std::string> names;  ///< as in the file, one per column or fewer; empty if it has none
    std::size_t rows() const { return columns > 0 ? values.size() / columns : 0; }
};

/// The columns by meaning, each a number from 0.
struct ColumnRoles {
    using Triple = std::array<std::size_t, 3>;
    Triple place{0, 1, 2};
    std::vector<Triple> normal, colour;                       ///< one of each, or none
    std::vector<std::pair<std::size_t, std::string>> others;  ///< kept as attributes of these names
    std::vector<std::size_t> left;                            ///< left out
};

/// True if names, of any case and spelling (X, "x", //X, x_coord, Easting, Points:0), include x, y and z.
bool namePlaces(const std::vector<std::string>& names);

/// Meaning of the columns by their names, which namePlaces. A column without a name is left out.
ColumnRoles rolesByName(const std::vector<std::string>& names, std::size_t columns);

/// Meaning of columns without names, by what all their numbers are: three unit vectors' components, within
/// 2 %, are normals, three from 0 to 255 colours; one more before them, or behind them, is an intensity.
/// Rows with numbers that are missing do not count.
ColumnRoles rolesByRange(const PointTable& table);

/// The table as points. Guesses and columns left out are a note. @throw Error BadData (under three columns)
PointContent contentOf(const std::string& path, const PointTable& table, const RunContext& ctx);

}  // namespace vdbsynth
