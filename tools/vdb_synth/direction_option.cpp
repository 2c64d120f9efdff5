#include "tools/vdb_synth/direction_option.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/points/row_text.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth::cli {
namespace {

bool isRows(const std::string& extension) {
    return extension == "csv" || extension == "txt" || extension == "xyz";
}

constexpr std::array<const char*, 6> kColumns{"x", "y", "z", "dx", "dy", "dz"};

// Where each number of a stroke is in a row, by the names of a header.
std::array<std::size_t, 6> columnsOf(const RowText& rows) {
    std::vector<std::string> names = rows.names();
    for (std::string& name : names)
        std::transform(name.begin(), name.end(), name.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    std::array<std::size_t, 6> place{};
    for (std::size_t c = 0; c < 6; ++c) {
        const auto found = std::find(names.begin(), names.end(), kColumns[c]);
        if (found == names.end())
            rows.fail(std::string("neither six numbers nor a header with the columns x y z dx dy dz: no ") +
                      kColumns[c]);
        place[c] = std::size_t(found - names.begin());
    }
    return place;
}

std::vector<Stroke> strokesOfRows(const std::string& path) {
    const std::string text = readWholeFile(path);
    RowText rows(path, text);
    std::array<std::size_t, 6> place{0, 1, 2, 3, 4, 5};
    std::size_t width = 6;
    bool first = true;
    std::vector<Stroke> strokes;
    std::vector<double> values;
    std::vector<RowWord> words;
    while (rows.next()) {
        if (rows.isComment()) continue;
        if (first && !rows.beginsWithNumber()) {
            place = columnsOf(rows);
            width = rows.names().size();
            first = false;
            continue;
        }
        first = false;
        values.clear();
        words.clear();
        rows.numbers(values, words);
        if (values.size() != width)
            rows.fail(std::to_string(values.size()) + " numbers; a stroke is a row of " +
                      std::to_string(width));
        std::array<double, 6> v{};
        for (std::size_t c = 0; c < 6; ++c) {
            v[c] = values[place[c]];
            if (!std::isfinite(v[c])) rows.fail(std::string("column ") + kColumns[c] + " is no number");
        }
        strokes.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
    }
    return strokes;
}

std::vector<Stroke> strokesOfJson(const std::string& path) {
    std::vector<Stroke> strokes;
    try {
        const nlohmann::json json = nlohmann::json::parse(readWholeFile(path));
        for (const nlohmann::json& entry : json) {
            const auto triple = [&](const char* name) {
                const auto v = entry.at(name).get<std::array<double, 3>>();
                return Vec3d{v[0], v[1], v[2]};
            };
            strokes.push_back({triple("position"), triple("direction")});
        }
    } catch (const nlohmann::json::exception& error) {
        throw Error(
            ErrorCode::BadData,
            path + ": not a list of {\"position\": [x,y,z], \"direction\": [x,y,z]}: " + error.what());
    }
    return strokes;
}

std::vector<Stroke> strokesOfPoints(const std::string& path, const RunContext& ctx) {
    const PointCloud cloud = readPoints(path, ctx).cloud;
    if (cloud.normals.empty())
        throw Error(ErrorCode::BadData, path + ": its points have no normals, which give the directions");
    std::vector<Stroke> strokes;
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
        strokes.push_back({cloud.origin + cast<double>(cloud.points[i]), cast<double>(cloud.normals[i])});
    return strokes;
}

}  // namespace

DirectionSource directionOf(Run& run, const std::string& name) {
    DirectionSource source;
    if (!run.arguments.has(name)) return source;
    const std::string text = run.arguments.text(name);
    if (parseDirection(text, source)) return source;
    if (namesGrid(text)) {
        source.kind = DirectionSource::Kind::Grid;
        source.grid = run.loadGrid(name);
        return source;
    }
    source.kind = DirectionSource::Kind::Strokes;
    const std::string extension = extensionOf(text);
    source.strokes = extension == "json" ? strokesOfJson(text)
                     : isRows(extension) ? strokesOfRows(text)
                                         : strokesOfPoints(text, run.context);
    run.noteInput(text);
    for (std::size_t i = 0; i < source.strokes.size(); ++i) {
        const Stroke& stroke = source.strokes[i];
        if (!std::isfinite(dot(stroke.position, stroke.position)) || !(length(stroke.direction) > 0))
            throw Error(ErrorCode::BadData,
                        text + ": stroke " + std::to_string(i + 1) + " has no position or no direction");
    }
    if (source.strokes.empty()) throw Error(ErrorCode::BadData, text + ": holds no strokes");
    return source;
}

}  // namespace vdbsynth::cli
