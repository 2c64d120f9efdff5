// Directions of a texture from the user's input, as directions on a surface's shell.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/surface/curvature_direction.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kStrokeReach = 1.5f;  // [voxels] around a stroke's position that it applies to

// Each stroke applies to the shell around the nearest surface point.
void addStrokes(const SurfaceShell& shell, const FieldPlace& place, const std::vector<Stroke>& strokes,
                std::vector<Vec3f>& given) {
    const PointNeighbours neighbours(shell.point);
    const openvdb::math::Transform& transform = place.like->transform();
    for (const Stroke& stroke : strokes) {
        const Vec3d index = fromVec(transform.worldToIndex(toVec(stroke.position)));
        const Vec3f at = cast<float>((index - place.corner) * (1 / place.step));
        std::uint32_t nearest = 0;
        float squared = 0;
        neighbours.nearest(at, 1, &nearest, &squared);
        const Vec3f direction = cast<float>(normalized(place.fromWorldDirection(stroke.direction)));
        const Index3 middle = shell.table[nearest];
        const int reach = int(std::ceil(kStrokeReach));
        forEachVoxel(IndexBox{middle, middle}.expanded(reach), [&](const Index3& p) {
            const std::int32_t i = shell.table.find(p);
            if (i >= 0 && length(shell.point[std::size_t(i)] - shell.point[nearest]) <= kStrokeReach)
                given[std::size_t(i)] = given[std::size_t(i)] + direction;
        });
    }
}

Vec3d middleOfPoints(const SurfaceShell& shell, const FieldPlace& place) {
    Vec3d low = cast<double>(shell.point.front()), high = low;
    for (const Vec3f& p : shell.point)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], double(p[axis]));
            high[axis] = std::max(high[axis], double(p[axis]));
        }
    return place.toWorld((low + high) * 0.5);
}

std::vector<Vec3f> givenDirections(const SurfaceShell& shell, const FieldPlace& place,
                                   const DirectionSource& source, const std::string& field,
                                   const RunContext& ctx) {
    using Kind = DirectionSource::Kind;
    if (source.kind == Kind::Automatic) return curvatureDirections(shell, ctx);
    std::vector<Vec3f> given(shell.size());
    if (source.kind == Kind::Strokes) {
        addStrokes(shell, place, source.strokes, given);
        return given;
    }
    const auto reader = directionReader(source, middleOfPoints(shell, place), field);
    for (std::size_t i = 0; i < shell.size(); ++i) {
        const Vec3d direction = place.fromWorldDirection(reader(place.toWorld(cast<double>(shell.point[i]))));
        if (std::isfinite(dot(direction, direction))) given[i] = cast<float>(direction);
    }
    return given;
}

}  // namespace

Vec3d FieldPlace::toWorld(const Vec3d& voxel) const {
    return fromVec(like->transform().indexToWorld(toVec(corner + voxel * step)));
}

Vec3d FieldPlace::fromWorldDirection(const Vec3d& direction) const {
    const openvdb::math::Transform& transform = like->transform();
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
    return fromVec(transform.worldToIndex(origin + toVec(direction))) * (1 / step);
}

FrameField framesOf(std::shared_ptr<const BrickField> distance, const FieldPlace& place,
                    const DirectionSource& source, const std::string& what, const std::string& field,
                    const RunContext& ctx) {
    Stage stage(ctx, "directions over " + what, 3);
    SurfaceShell shell = surfaceShell(*distance, ctx);
    stage.advance();
    DirectionField directions;
    try {
        directions = directionField(shell, givenDirections(shell, place, source, field, ctx), ctx);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::Unusable) throw;
        const bool automatic = source.kind == DirectionSource::Kind::Automatic;
        throw Error(ErrorCode::Unusable,
                    what + ": " +
                        (automatic ? "its curvature gives no direction; set `" + field +
                                         "`, for example along an axis"
                                   : "`" + field +
                                         "` gives no direction on its surface: it is along the normal "
                                         "everywhere, or nowhere near the model"));
    }
    stage.advance();
    SweepDistance sweep = sweepDistance(shell, directions.tangent, ctx);
    stage.advance();
    return FrameField(std::move(distance), std::move(shell), std::move(directions), std::move(sweep));
}

}  // namespace vdbsynth
