// Points from a table whose columns have a meaning, and what is said about it.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/points/point_columns.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

std::string numberOf(std::size_t column) {
    return std::to_string(column + 1);
}

std::string spanOf(const ColumnRoles::Triple& triple) {
    return numberOf(triple[0]) + " to " + numberOf(triple[2]);
}

// "column 4", "columns 4 and 5", "columns 4, 5, 6 and 6 more"
std::string listOf(const std::vector<std::size_t>& columns) {
    std::string list = columns.size() == 1 ? "column " : "columns ";
    constexpr std::size_t kShown = 6;
    for (std::size_t i = 0; i < std::min(columns.size(), kShown); ++i) {
        const bool last = i + 1 == columns.size();
        list += (i == 0 ? "" : last ? " and " : ", ") + numberOf(columns[i]);
    }
    if (columns.size() > kShown) list += " and " + std::to_string(columns.size() - kShown) + " more";
    return list;
}

void sayGuess(const std::string& path, const ColumnRoles& roles, const RunContext& ctx) {
    std::string said;
    const auto add = [&](const std::string& what) { said += (said.empty() ? "" : ", ") + what; };
    for (const auto& [column, name] : roles.others) add("column " + numberOf(column) + " as " + name);
    for (const auto& normal : roles.normal) add("columns " + spanOf(normal) + " as normals");
    for (const auto& colour : roles.colour) add("columns " + spanOf(colour) + " as red, green, blue");
    if (!said.empty()) said = "reads " + said + " by the range of their numbers";
    if (!roles.left.empty())
        said += (said.empty() ? "" : "; ") + listOf(roles.left) + " left out, for what " +
                (roles.left.size() == 1 ? "it means" : "they mean") + " is unknown";
    if (!said.empty())
        message(ctx, MessageLevel::Note,
                path + ": " + said + "; a first line such as \"x y z r g b intensity\" names columns");
}

double whiteOf(const PointTable& table, const ColumnRoles::Triple& colour, bool& fits) {
    double low = 0, high = 0;
    for (std::size_t at = 0; at < table.values.size(); at += table.columns)
        for (const std::size_t column : colour) {
            const double value = table.values[at + column];
            if (!std::isfinite(value)) continue;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    fits = low >= 0 && high <= 65535;
    return high > 255 ? 65535 : 0;
}

std::vector<float> floatsOf(const PointTable& table, std::size_t column) {
    std::vector<float> values;
    values.reserve(table.rows());
    for (std::size_t at = column; at < table.values.size(); at += table.columns)
        values.push_back(float(table.values[at]));
    return values;
}

void addColours(const std::string& path, const PointTable& table, const ColumnRoles::Triple& colour,
                std::vector<AttributeColumn>& columns, const RunContext& ctx) {
    bool fits = true;
    const double white = whiteOf(table, colour, fits);
    if (!fits) {
        message(ctx, MessageLevel::Warning,
                path + ": its colours left out, for they are not all from 0 to 255 or 65535");
        return;
    }
    if (white == 65535)
        message(ctx, MessageLevel::Note, path + ": colours over 255 read as of 16 bits, 65535 is white");
    static const char* const names[3] = {"red", "green", "blue"};
    for (std::size_t c = 0; c < 3; ++c) columns.push_back({names[c], white, floatsOf(table, colour[c])});
}

}  // namespace

PointContent contentOf(const std::string& path, const PointTable& table, const RunContext& ctx) {
    PointContent cloud;
    if (table.rows() == 0) return cloud;
    if (table.columns < 3)
        throw Error(ErrorCode::BadData, path + ": a point needs three coordinates, its rows have " +
                                            std::to_string(table.columns));
    const bool named = namePlaces(table.names);
    const ColumnRoles roles = named ? rolesByName(table.names, table.columns) : rolesByRange(table);
    if (!named) sayGuess(path, roles, ctx);
    if (named && !roles.left.empty())
        message(ctx, MessageLevel::Note, path + ": " + listOf(roles.left) + " without a name left out");
    const auto vectors = [&](const ColumnRoles::Triple& triple, auto&& add) {
        for (std::size_t at = 0; at < table.values.size(); at += table.columns)
            add(Vec3d{table.values[at + triple[0]], table.values[at + triple[1]],
                      table.values[at + triple[2]]});
    };
    cloud.points.reserve(table.rows());
    vectors(roles.place, [&](const Vec3d& v) { cloud.points.push_back(v); });
    if (!roles.normal.empty()) {
        cloud.normals.reserve(table.rows());
        vectors(roles.normal[0], [&](const Vec3d& v) { cloud.normals.push_back(cast<float>(v)); });
    }
    std::vector<AttributeColumn> columns;
    if (!roles.colour.empty()) addColours(path, table, roles.colour[0], columns, ctx);
    for (const auto& [column, name] : roles.others) columns.push_back({name, 0, floatsOf(table, column)});
    cloud.attributes = groupColumns(std::move(columns));
    return cloud;
}

}  // namespace vdbsynth
