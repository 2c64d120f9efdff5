#include "libvdbsynth/distance/rebuild_band.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/distance/signed_distance.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vdbsynth {
namespace {

// @param longest, mostSide  [voxels] of a whole that is not parted, of a part
std::vector<IndexBox> partsOf(const IndexBox& box, int longest = 224, int mostSide = 176) {
    IndexBox whole;
    Index3 side;
    for (int axis = 0; axis < 3; ++axis) {
        whole.min[axis] = box.min[axis] & ~7;
        const int length = (box.max[axis] | 7) + 1 - whole.min[axis];
        const int parts = length <= longest ? 1 : (length + mostSide - 1) / mostSide;
        side[axis] = ((length + parts - 1) / parts + 7) & ~7;
        whole.max[axis] = whole.min[axis] + length - 1;
    }
    std::vector<IndexBox> parts;
    for (int x = whole.min.x; x <= whole.max.x; x += side.x)
        for (int y = whole.min.y; y <= whole.max.y; y += side.y)
            for (int z = whole.min.z; z <= whole.max.z; z += side.z)
                parts.push_back(
                    IndexBox{{x, y, z}, Index3{x, y, z} + side - Index3{1, 1, 1}}.intersection(whole));
    return parts;
}

// The field's values as distances [voxels] within its band, over a box.
BrickField inVoxels(const BrickField& field, const IndexBox& box, const RebuildOptions& options,
                    const RunContext& ctx) {
    const float scale = 1 / options.voxelSize, limit = options.band;
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = std::clamp(samples[i] * scale, -limit, limit);
    });
}

// Whole cubes of cells around a box, and the cubes around those, which their vertices need.
IndexBox samplesFor(const IndexBox& region) {
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = (region.min[axis] & ~7) - 8;
        box.max[axis] = (region.max[axis] | 7) + 8;
    }
    return box;
}

// The same bits whatever the part: faces that could be nearest to any of its voxels, and what they are found
// through, lie within the reach.
BrickField rebuiltPart(const FieldReader& read, const IndexBox& part, const RebuildOptions& options,
                       const RunContext& ctx) {
    const int rounds = int(std::ceil(options.halfWidth));
    const IndexBox reach = part.expanded(rounds + 3);
    const std::shared_ptr<const BrickField> field = read(samplesFor(reach));
    const Mesh mesh = zeroLevel(*field, reach, options.facing, ctx);
    if (mesh.faceCount() == 0)
        return BrickField(part, field->at(part.min) < 0 ? -options.halfWidth : options.halfWidth);
    const BrickField distance = meshDistance(mesh, part.expanded(rounds + 1), options.halfWidth, ctx);
    const BrickField own = inVoxels(*field, part.expanded(1), options, ctx);
    BrickField values =
        options.keepDistances
            ? keepingDistances({distance, part.min}, {own, part.min}, part.size(), options.band, ctx)
            : withSigns({distance, part.min}, {own, part.min}, part.size(), ctx);
    values.translate(part.min);
    return values;
}

// The box around the image of a box.
IndexBox imageOf(const Affine& map, const IndexBox& box) {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p = transformed(
            map, {double(corner & 1 ? box.max.x : box.min.x), double(corner & 2 ? box.max.y : box.min.y),
                  double(corner & 4 ? box.max.z : box.min.z)});
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    IndexBox image;
    for (int axis = 0; axis < 3; ++axis) {
        image.min[axis] = int(std::floor(low[axis]));
        image.max[axis] = int(std::ceil(high[axis]));
    }
    return image;
}

// The field at the result's voxels, in its own unit.
BrickField sampledAt(const BrickField& field, const Affine& toField, const IndexBox& box,
                     const RunContext& ctx) {
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        float constant = 0;
        if (field.constantIn(imageOf(toField, brick).expanded(1), constant)) {
            std::fill_n(samples, BrickField::kSamples, constant);
            return;
        }
        forEachVoxel(brick, [&](const Index3& p) {
            const Vec3d place = transformed(toField, {double(p.x), double(p.y), double(p.z)});
            *samples++ = sampleTrilinear(field, cast<float>(place));
        });
    });
}

// Where the result's voxels are no larger, the zero level is that of the samples at them: detail of a voxel
// of the field has sides that a mesh in its voxels does not agree with.
BrickField refinedPart(const FieldReader& read, const LatticeMap& map, const IndexBox& part,
                       const RebuildOptions& options, const RunContext& ctx) {
    const FieldReader finer = [&](const IndexBox& box) {
        const std::shared_ptr<const BrickField> field = read(imageOf(map.toField, box).expanded(1));
        return std::make_shared<const BrickField>(sampledAt(*field, map.toField, box, ctx));
    };
    return rebuiltPart(finer, part, options, ctx);
}

BrickField resampledPart(const FieldReader& read, const LatticeMap& map, const IndexBox& part,
                         const RebuildOptions& options, const RunContext& ctx) {
    const int rounds = int(std::ceil(options.halfWidth));
    const IndexBox reach = imageOf(map.toField, part.expanded(rounds + 3)).expanded(1);
    const std::shared_ptr<const BrickField> field = read(samplesFor(reach));
    const IndexBox needed = part.expanded(1);
    const BrickField own = inVoxels(sampledAt(*field, map.toField, needed, ctx), needed, options, ctx);
    Mesh mesh = zeroLevel(*field, reach, options.facing, ctx);
    if (mesh.faceCount() == 0)
        return BrickField(part, own.at(part.min) < 0 ? -options.halfWidth : options.halfWidth);
    for (Vec3f& p : mesh.points) p = cast<float>(transformed(map.fromField, cast<double>(p)));
    const BrickField distance = meshDistance(mesh, part.expanded(rounds + 1), options.halfWidth, ctx);
    BrickField values =
        options.keepDistances
            ? keepingDistances({distance, part.min}, {own, part.min}, part.size(), options.band, ctx)
            : withSigns({distance, part.min}, {own, part.min}, part.size(), ctx);
    values.translate(part.min);
    return values;
}

// Voxels of the field along one of the result's, at most.
double coarsening(const Affine& toField) {
    double most = 0;
    for (std::size_t column = 0; column < 12; column += 4)
        most = std::max(most, length(Vec3d{toField[column], toField[column + 1], toField[column + 2]}));
    return most;
}

}  // namespace

void resampleBand(const FieldReader& read, const LatticeMap& map, const IndexBox& box,
                  const RebuildOptions& options, const PartTaker& take, const RunContext& ctx) {
    constexpr double kFieldVoxels = 1024;  // along a part: bounds the memory of its field and mesh
    const double coarser = coarsening(map.toField);
    const bool finer = coarser < 1 + 1e-6;
    const int side = std::max(16, int(std::min(176.0, kFieldVoxels / std::max(1.0, coarser))));
    const std::vector<IndexBox> parts = partsOf(box, side, side);
    Stage stage(ctx, "resampling", parts.size());
    for (const IndexBox& part : parts) {
        take((finer ? refinedPart : resampledPart)(read, map, part, options, ctx));
        stage.advance();
    }
}

void rebuildBand(const FieldReader& read, const IndexBox& box, const RebuildOptions& given,
                 const PartTaker& take, const RunContext& ctx) {
    const std::vector<IndexBox> parts = partsOf(box);
    RebuildOptions options = given;
    if (parts.size() > 1) options.facing = Facing::Inward;
    Stage stage(ctx, "rebuilding the narrow band", parts.size());
    constexpr std::size_t kBatch = 8;  // parts between two looks at the clock
    for (std::size_t first = 0; first < parts.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, parts.size() - first);
        std::vector<BrickField> made(count);
        parallelFor(ctx, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                made[i] = rebuiltPart(read, parts[first + i], options, ctx);
        });
        for (const BrickField& part : made) take(part);
        stage.advance(count);
    }
    stage.advance();
}

BrickField rebuiltBand(const BrickField& field, const RebuildOptions& options, const RunContext& ctx) {
    const FieldReader whole = [&field](const IndexBox&) {
        return std::shared_ptr<const BrickField>(std::shared_ptr<void>(), &field);
    };
    std::vector<BrickField> parts;
    rebuildBand(
        whole, field.box().expanded(int(std::ceil(options.halfWidth)) + 1), options,
        [&](const BrickField& part) { parts.push_back(part); }, ctx);
    if (parts.size() == 1) return std::move(parts.front());
    IndexBox box = parts.front().box();
    for (const BrickField& part : parts)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], part.box().min[axis]);
            box.max[axis] = std::max(box.max[axis], part.box().max[axis]);
        }
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        const auto part = std::find_if(parts.begin(), parts.end(),
                                       [&](const BrickField& p) { return p.box().contains(brick.min); });
        part->readBox(brick.min, brick.size(), samples);
    });
}

}  // namespace vdbsynth
