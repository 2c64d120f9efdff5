// Directions of a texture from the user's input, as directions at a target's sites.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/pipeline/texture/texture_steps.h"
#include "libvdbsynth/points/surface_sites.h"
#include "libvdbsynth/surface/curvature_direction.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using Kind = DirectionSource::Kind;

constexpr std::size_t kStrokeSites = 8;  // nearest sites that a stroke applies to
constexpr std::size_t kCurvatureNeighbours = 8;

Vec3d middleOf(const TextureShape& shape) {
    Vec3d low = cast<double>(shape.site.front()), high = low;
    for (const Vec3f& p : shape.site)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], double(p[axis]));
            high[axis] = std::max(high[axis], double(p[axis]));
        }
    return shape.origin + (low + high) * 0.5;
}

std::vector<Vec3f> strokeDirections(const TextureShape& shape, const std::vector<Stroke>& strokes) {
    std::vector<Vec3f> given(shape.site.size(), Vec3f{0, 0, 0});
    const PointNeighbours neighbours(shape.site);
    std::uint32_t nearest[kStrokeSites];
    float squared[kStrokeSites];
    for (const Stroke& stroke : strokes) {
        const Vec3f at = cast<float>(stroke.position - shape.origin);
        const Vec3f direction = cast<float>(normalized(stroke.direction));
        const std::size_t found = neighbours.nearest(at, kStrokeSites, nearest, squared);
        for (std::size_t k = 0; k < found; ++k)
            if (dot(shape.normal[nearest[k]], shape.normal[nearest[0]]) > 0)
                given[nearest[k]] = given[nearest[k]] + direction;
    }
    return given;
}

}  // namespace

std::vector<Vec3f> siteDirections(const TextureShape& shape, const DirectionSource& source,
                                  const RunContext& ctx) {
    if (source.kind == Kind::Automatic)
        return curvatureDirections(sitesOfPoints(shape.site, shape.normal, kCurvatureNeighbours, ctx), ctx);
    if (source.kind == Kind::Strokes) return strokeDirections(shape, source.strokes);
    const auto reader = directionReader(source, middleOf(shape), "direction");
    std::vector<Vec3f> given(shape.site.size(), Vec3f{0, 0, 0});
    Stage stage(ctx, "directions", given.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
        const Vec3d direction = reader(shape.origin + cast<double>(shape.site[i]));
        const double size = length(direction);
        if (std::isfinite(size) && size > 0) given[i] = cast<float>(direction * (1 / size));
        stage.advance();
    }
    return given;
}

}  // namespace vdbsynth
