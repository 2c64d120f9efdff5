#include "tools/vdb_synth/direction_option.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/readers/text_scanner.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {
namespace {

bool isRows(const std::string& extension) {
    return extension == "csv" || extension == "txt" || extension == "xyz";
}

std::vector<Stroke> strokesOfRows(const std::string& path) {
    std::string text = readWholeFile(path);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    TextScanner scanner(path, text);
    std::vector<Stroke> strokes;
    while (!scanner.atEnd()) {
        double values[6];
        for (double& value : values) value = double(scanner.real());
        strokes.push_back({{values[0], values[1], values[2]}, {values[3], values[4], values[5]}});
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
    for (const Stroke& stroke : source.strokes)
        if (!std::isfinite(dot(stroke.position, stroke.position)) || !(length(stroke.direction) > 0))
            throw Error(ErrorCode::BadData, text + ": a stroke without a position or a direction");
    if (source.strokes.empty()) throw Error(ErrorCode::BadData, text + ": holds no strokes");
    return source;
}

}  // namespace vdbsynth::cli
