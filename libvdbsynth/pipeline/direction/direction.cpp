#include "libvdbsynth/pipeline/direction/direction.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/grid_reader.h"

#include "libvdbsynth/vdb/grid_kinds.h"

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

}  // namespace

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
