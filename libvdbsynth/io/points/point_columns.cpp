#include "libvdbsynth/io/points/point_columns.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>

namespace vdbsynth {
namespace {

// Lower case, without comment signs, units in brackets and marks between words: "//X", "X (m)" and "Normal:0"
// become "x", "x", "normal0".
std::string plainName(const std::string& name) {
    std::string plain;
    for (const char c : name) {
        if (c == '(' || c == '[') break;
        const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (letter) plain += c;
        if (c >= 'A' && c <= 'Z') plain += char(c - 'A' + 'a');
    }
    return plain;
}

using Spellings = std::initializer_list<std::array<const char*, 3>>;

const Spellings kPlaces{{"x", "y", "z"},
                        {"xcoord", "ycoord", "zcoord"},
                        {"xcoordinate", "ycoordinate", "zcoordinate"},
                        {"coordx", "coordy", "coordz"},
                        {"posx", "posy", "posz"},
                        {"positionx", "positiony", "positionz"},
                        {"pointx", "pointy", "pointz"},
                        {"px", "py", "pz"},
                        {"xm", "ym", "zm"},
                        {"points0", "points1", "points2"},
                        {"pointsx", "pointsy", "pointsz"},
                        {"easting", "northing", "elevation"},
                        {"easting", "northing", "height"},
                        {"easting", "northing", "altitude"},
                        {"easting", "northing", "z"},
                        {"x", "y", "elevation"},
                        {"x", "y", "height"}};
const Spellings kNormals{{"nx", "ny", "nz"},
                         {"normalx", "normaly", "normalz"},
                         {"normal0", "normal1", "normal2"},
                         {"normals0", "normals1", "normals2"},
                         {"normalsx", "normalsy", "normalsz"}};
const Spellings kColours{{"r", "g", "b"},
                         {"red", "green", "blue"},
                         {"rf", "gf", "bf"},
                         {"colorr", "colorg", "colorb"},
                         {"colourr", "colourg", "colourb"},
                         {"rgb0", "rgb1", "rgb2"}};

// The columns that one of these spellings names; false if there are none.
bool findTriple(const std::vector<std::string>& plain, Spellings spellings, ColumnRoles::Triple& triple) {
    for (const auto& spelling : spellings) {
        std::size_t found = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = std::find(plain.begin(), plain.end(), spelling[k]);
            triple[k] = std::size_t(at - plain.begin());
            found += at != plain.end();
        }
        if (found == 3) return true;
    }
    return false;
}

std::vector<std::string> plainNames(const std::vector<std::string>& names, std::size_t columns) {
    std::vector<std::string> plain;
    for (std::size_t i = 0; i < std::min(names.size(), columns); ++i) plain.push_back(plainName(names[i]));
    return plain;
}

// A column's name as the name of an attribute: what messages and other programs can carry.
std::string attributeName(const std::string& name, std::set<std::string>& used) {
    const std::string plain = plainName(name);
    std::string kept;
    for (const char c : name.substr(0, 60)) {
        const bool fits = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (fits || c == '_' || c == '-' || c == '.' || c == ':')
            kept += c;
        else if (!kept.empty() && kept.back() != '_')
            kept += '_';
    }
    while (kept.size() > 1 && kept.back() == '_') kept.pop_back();
    if (plain == "intensity" || plain == "scalarintensity" || plain == "i") kept = "intensity";
    if (plain == "alpha" || plain == "a") kept = "alpha";
    const std::string stem = kept;
    for (int again = 2; !used.insert(kept).second; ++again) kept = stem + "_" + std::to_string(again);
    return kept;
}

enum class Kind { Normals, Colours, Other };

Kind kindOf(const PointTable& table, std::size_t first) {
    bool unit = true, colour = true, any = false;
    if (first + 3 > table.columns) return Kind::Other;
    for (std::size_t at = first; at + 2 < table.values.size() && (unit || colour); at += table.columns) {
        const Vec3d v{table.values[at], table.values[at + 1], table.values[at + 2]};
        if (std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z)) continue;
        any = true;
        // Zero: a point of unknown normal. All zeros are black.
        const bool zero = v.x == 0 && v.y == 0 && v.z == 0;
        unit = unit && (zero || std::abs(length(v) - 1) < 0.02);
        for (int axis = 0; axis < 3; ++axis) colour = colour && v[axis] >= 0 && v[axis] <= 255;
    }
    return !any ? Kind::Other : unit ? Kind::Normals : colour ? Kind::Colours : Kind::Other;
}

bool allWhole(const PointTable& table, std::size_t column) {
    for (std::size_t at = column; at < table.values.size(); at += table.columns)
        if (std::isfinite(table.values[at]) && table.values[at] != std::floor(table.values[at])) return false;
    return true;
}

bool allZero(const PointTable& table, std::size_t first) {
    for (std::size_t at = first; at + 2 < table.values.size(); at += table.columns)
        if (table.values[at] != 0 || table.values[at + 1] != 0 || table.values[at + 2] != 0) return false;
    return true;
}

void addTriple(const PointTable& table, std::size_t first, ColumnRoles& roles) {
    const Kind kind = kindOf(table, first);
    const bool black = kind == Kind::Normals && allZero(table, first);
    const ColumnRoles::Triple triple{first, first + 1, first + 2};
    if (kind == Kind::Normals && !black && roles.normal.empty())
        roles.normal.push_back(triple);
    else if ((kind == Kind::Colours || black) && roles.colour.empty())
        roles.colour.push_back(triple);
    else
        for (const std::size_t column : triple) roles.left.push_back(column);
}

}  // namespace

bool namePlaces(const std::vector<std::string>& names) {
    ColumnRoles::Triple triple;
    return findTriple(plainNames(names, names.size()), kPlaces, triple);
}

ColumnRoles rolesByName(const std::vector<std::string>& names, std::size_t columns) {
    ColumnRoles roles;
    std::vector<std::string> plain = plainNames(names, columns);
    ColumnRoles::Triple triple;
    if (findTriple(plain, kPlaces, triple)) roles.place = triple;
    if (findTriple(plain, kNormals, triple)) roles.normal.push_back(triple);
    if (findTriple(plain, kColours, triple)) roles.colour.push_back(triple);
    std::vector<char> taken(columns, 0);
    for (const auto& triples : {std::vector<ColumnRoles::Triple>{roles.place}, roles.normal, roles.colour})
        for (const ColumnRoles::Triple& t : triples)
            for (const std::size_t column : t)
                if (column < columns) taken[column] = 1;
    std::set<std::string> used;
    for (std::size_t i = 0; i < columns; ++i) {
        if (taken[i]) continue;
        if (i < plain.size() && !plain[i].empty())
            roles.others.emplace_back(i, attributeName(names[i], used));
        else
            roles.left.push_back(i);
    }
    return roles;
}

namespace {

// One column before the triples: they then begin at the fifth.
bool beginsWithExtra(const PointTable& table) {
    const std::size_t more = table.columns - 3;
    const Kind third = kindOf(table, 3), fourth = kindOf(table, 4);
    if (more == 1) return true;
    if (more < 4 || more % 3 == 0 || third == Kind::Normals) return false;
    if (more % 3 == 2) return third == Kind::Other && fourth != Kind::Other;
    // Both could be colours. They are whole numbers where an intensity may be none.
    const bool real = !allWhole(table, table.columns - 1) && allWhole(table, 3);
    return third == Kind::Other || (fourth != Kind::Other && !(fourth == Kind::Colours && real));
}

}  // namespace

ColumnRoles rolesByRange(const PointTable& table) {
    ColumnRoles roles;
    if (table.columns <= 3) return roles;
    const std::size_t more = table.columns - 3;
    const bool before = beginsWithExtra(table), behind = !before && more % 3 == 1 && more <= 7;
    if (before || behind) roles.others.emplace_back(before ? 3 : table.columns - 1, "intensity");
    const std::size_t first = before ? 4 : 3, end = table.columns - (behind ? 1 : 0);
    std::size_t column = first;
    for (; column + 3 <= end && column < first + 6; column += 3) addTriple(table, column, roles);
    for (; column < end; ++column) roles.left.push_back(column);
    return roles;
}

}  // namespace vdbsynth
