#include "libvdbsynth/pipeline/direction/direction.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/vdb/grid_reader.h"

#include <openvdb/openvdb.h>

#include <cmath>

namespace vdbsynth {
namespace {

using Kind = DirectionSource::Kind;

bool isFinite(const Vec3d& v) {
    return std::isfinite(dot(v, v));
}

GridReader readerOf(const openvdb::GridBase& grid, const std::string& field) {
    if (GridReader vectors = vectorReader(grid, GridSampling::Linear)) return vectors;
    if (GridReader gradient = gradientReader(grid)) return gradient;
    throw Error(ErrorCode::BadData, "`" + field + "`: grid " + grid.getName() + " holds " + grid.valueType() +
                                        "; vectors or a float scalar are needed");
}

bool parseVector(const std::string& text, Vec3d& vector) {
    std::size_t begin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = axis < 2 ? text.find(',', begin) : text.size();
        if (comma == std::string::npos || !parseReal(text.substr(begin, comma - begin), vector[axis]))
            return false;
        begin = comma + 1;
    }
    return isFinite(vector) && dot(vector, vector) > 0;
}

}  // namespace

bool parseDirection(const std::string& text, DirectionSource& source) {
    if (text == "radial" || text == "curvature") {
        source.kind = text == "radial" ? Kind::Radial : Kind::Automatic;
        return true;
    }
    if (parseVector(text, source.axis)) {
        source.kind = Kind::Axis;
        return true;
    }
    const std::size_t colon = text.find(':');
    const std::string head = text.substr(0, colon);
    if (colon == std::string::npos || (head != "axis" && head != "around")) return false;
    std::string tail = text.substr(colon + 1);
    const bool back = !tail.empty() && tail[0] == '-';
    if (back) tail.erase(0, 1);
    if (tail != "x" && tail != "y" && tail != "z") return false;
    source.kind = head == "axis" ? Kind::Axis : Kind::Around;
    source.axis = {0, 0, 0};
    source.axis[tail[0] - 'x'] = back ? -1 : 1;
    return true;
}

void requireDirection(const DirectionSource& source, const char* field) {
    requireOption(source.kind != Kind::Grid || source.grid, field, "Grid", "given with a `grid`");
    const bool axis = source.kind == Kind::Axis || source.kind == Kind::Around;
    requireOption(!axis || (isFinite(source.axis) && dot(source.axis, source.axis) > 0), field,
                  "Axis or Around", "given with an `axis` that is not 0");
    if (source.kind != Kind::Strokes) return;
    requireOption(!source.strokes.empty(), field, "Strokes", "given with `strokes`");
    for (const Stroke& stroke : source.strokes)
        requireOption(isFinite(stroke.position) && isFinite(stroke.direction), field, "Strokes",
                      "given with `strokes` of finite numbers");
}

std::function<Vec3d(const Vec3d& world)> directionReader(const DirectionSource& source, const Vec3d& middle,
                                                         const std::string& field) {
    if (source.kind == Kind::Around)
        return [axis = source.axis, middle](const Vec3d& p) { return cross(axis, p - middle); };
    if (source.kind == Kind::Radial) return [middle](const Vec3d& p) { return p - middle; };
    if (source.kind == Kind::Grid)
        return [grid = readerOf(*source.grid, field)](const Vec3d& p) { return grid(p).value; };
    return [axis = source.axis](const Vec3d&) { return axis; };
}

}  // namespace vdbsynth
