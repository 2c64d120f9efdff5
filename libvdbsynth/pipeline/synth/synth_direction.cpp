// Exemplars rotated along a field of directions.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/pipeline/direction/place_directions.h"
#include "libvdbsynth/pipeline/synth/synth_steps.h"
#include "libvdbsynth/vdb/coord.h"

#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

// In the grid's voxels, of length 1; 0 stays.
Vec3d inVoxels(const openvdb::FloatGrid& grid, const Vec3d& direction) {
    const openvdb::math::Transform& transform = grid.transform();
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
    const Vec3d voxels = fromVec(transform.worldToIndex(origin + toVec(direction)));
    const double size = length(voxels);
    return size > 0 ? voxels * (1 / size) : voxels;
}

// The direction that the texture of an exemplar has. [world]
Vec3d ownDirection(const LevelSet& exemplar, const SynthOptions& options, const std::string& what,
                   const RunContext& ctx) {
    if (options.exemplarDirection) return options.exemplarDirection->axis;
    DirectionSource source;
    const auto recorded = exemplar.grid->getMetadata<openvdb::StringMetadata>(kDirectionKey);
    if (recorded && parseDirection(recorded->value(), source) && source.kind == DirectionSource::Kind::Axis) {
        message(ctx, MessageLevel::Note,
                "`exemplarDirection`: not given; " + what + " is taken to run along " + recorded->value() +
                    ", which it records");
        return source.axis;
    }
    message(ctx, MessageLevel::Note,
            "`exemplarDirection`: not given; " + what + " is taken to run along axis:x");
    return {1, 0, 0};
}

}  // namespace

bool rotatesOrScales(const SynthOptions& options) {
    return options.rotationMap || options.scaleMap || options.direction;
}

void rotateAlong(const SynthOptions& options, const LevelSets& exemplars, const ControlFrame& frame,
                 const IndexBox& domain, std::vector<WantedVariant>& wanted, const RunContext& ctx) {
    const openvdb::Vec3d middle =
        (toVec({double(domain.min.x), double(domain.min.y), double(domain.min.z)}) +
         toVec({double(domain.max.x), double(domain.max.y), double(domain.max.z)})) *
        0.5;
    std::vector<Vec3d> own;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        const std::string what = exemplars.size() > 1 ? "exemplar " + std::to_string(e + 1) : "the exemplar";
        own.push_back(inVoxels(*frame.like, ownDirection(*exemplars[e], options, what, ctx)));
    }
    std::vector<Vec3d> directions =
        directionsInSpace(*options.direction, variantPlaces(frame),
                          fromVec(frame.like->transform().indexToWorld(middle)), "direction", ctx);
    std::vector<Vec3d> from(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
        directions[i] = inVoxels(*frame.like, directions[i]);
        from[i] = own[std::size_t(wanted[i].exemplar)];
    }
    const std::vector<Vec3d> rotations = rotationsBetween(from, directions);
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i].rotation = rotations[i];
}

}  // namespace vdbsynth
